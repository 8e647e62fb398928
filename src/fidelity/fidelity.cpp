#include "fidelity.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>

#include "fidelity_arguments.h"
#include "probe.h"
#include "report_text.h"
#include "resolution_sweep.h"
#include "robot_tissue/scene/scene_parser.h"
#include "robot_tissue/scene/value_text.h"
#include "simulate.h"
#include "write_scene.h"

namespace robot_tissue {
namespace {

namespace fs = std::filesystem;

std::string folderOf(const std::string& file) { return fs::absolute(file).parent_path().string(); }

std::string readText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

[[noreturn]] void refuseFile(const std::string& option, const std::string& path) {
  throw InputError(option + " = " + onOneLine(path) + ": must be a file that can be written");
}

// Before minutes are spent on what cannot be kept.
void requireWritable(const std::string& option, const std::string& path) {
  if (path.empty()) return;
  std::error_code ignored;
  const bool was_there = fs::exists(path, ignored);
  if (was_there && !fs::is_regular_file(path, ignored)) refuseFile(option, path);
  if (!std::ofstream(path, std::ios::app)) refuseFile(option, path);
  if (!was_there) fs::remove(path, ignored);
}

void writeFile(const std::string& option, const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  if (!file) refuseFile(option, path);
}

Scene readScene(const FidelityArguments& arguments, std::ostream& err) {
  const Scene scene = loadScene(arguments.scene);
  if (scene.tissue.model != "elastic") {
    throw InputError(onOneLine(arguments.scene) + ": tissue.model = " + scene.tissue.model +
                     ": has no unique equilibrium, so no error: must be elastic");
  }
  for (const std::string& remark : scene.remarks) {
    if (!arguments.quiet) err << "fidelity: " << remark << '\n';
  }
  if (!scene.steps.empty()) return scene;
  const Scene pressed = probed(scene);
  if (!arguments.quiet) err << "fidelity: " << probeText(pressed) << '\n';
  return pressed;
}

OnRung progressOn(std::ostream& err) {
  const std::string clear_line = "\r\x1b[K";
  return [&err, clear_line](std::size_t done, std::size_t all, const Rung& rung, int update,
                            int updates) {
    err << clear_line << progressText(done, all, rung, update, updates) << std::flush;
  };
}

int tell(const FidelityArguments& arguments, const Assessment& assessment, std::ostream& out) {
  const Choice choice = choose(assessment.rows, arguments.error, arguments.rate);
  out << tableText(assessment) << '\n'
      << limitText(assessment) << choiceText(assessment, choice, arguments.error, arguments.rate);
  if (!arguments.csv.empty()) writeFile("--csv", arguments.csv, tableCsv(assessment));
  if (assessment.lattices < 2 || !choice.best) return kExitNoneMeetsBoth;
  if (!arguments.write.empty()) {
    const std::string text = withRung(readText(arguments.scene), assessment.rows[*choice.best].rung,
                                      folderOf(arguments.scene), folderOf(arguments.write));
    writeFile("--write", arguments.write, text);
    loadScene(arguments.write);
    out << "written to " << arguments.write << '\n';
  }
  return kExitOk;
}

int run(const FidelityArguments& arguments, std::ostream& out, std::ostream& err, bool terminal) {
  const Scene scene = readScene(arguments, err);
  requireWritable("--write", arguments.write);
  requireWritable("--csv", arguments.csv);
  SweepOptions options;
  options.method = arguments.method;
  options.way_an_update = arguments.way_an_update;
  options.seconds = arguments.seconds;
  const bool progress = terminal && !arguments.quiet;
  const std::vector<Trial> trials =
      resolutionSweep(scene, options, progress ? progressOn(err) : OnRung());
  if (progress) err << "\r\x1b[K" << std::flush;
  try {
    return tell(arguments, assessed(trials), out);
  } catch (const InputError& error) {
    throw InputError(onOneLine(arguments.scene) + ": " + error.what());
  }
}

}  // namespace

int fidelity(const std::vector<std::string>& words, std::ostream& out, std::ostream& err,
             bool terminal) {
  return exitCodeOf("fidelity", err, [&] {
    const FidelityArguments arguments = parseFidelityArguments(words);
    if (!arguments.help) return run(arguments, out, err, terminal);
    out << fidelityHelp();
    return kExitOk;
  });
}

}  // namespace robot_tissue
