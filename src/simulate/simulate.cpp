#include "simulate.h"

#include <algorithm>
#include <filesystem>
#include <ostream>

#include "arguments.h"
#include "output_folder.h"
#include "result_text.h"
#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/scene_files.h"
#include "robot_tissue/scene/value_text.h"
#include "run_scene.h"

namespace robot_tissue {
namespace {

void print(const Arguments& arguments, std::ostream& out) {
  if (arguments.help) {
    out << helpText();
    return;
  }
  if (arguments.list_methods) {
    for (const std::string& name : methodNames()) out << name << '\n';
  }
  if (arguments.list_models) {
    for (const std::string& name : modelNames()) out << name << '\n';
  }
}

void printOut(const Arguments& arguments, std::ostream& out) {
  print(arguments, out);
  if (!out.flush()) throw InputError("stdout: cannot be written, must be what takes the answer");
}

// The line of a terminal that each row is shown on, in place of the one before. It ends with the
// run, however that ends.
class ProgressLine {
 public:
  ProgressLine(std::ostream& err, std::size_t steps) : err_(err), steps_(steps) {}
  ~ProgressLine() {
    if (is_begun_) err_ << std::endl;
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const IncrementRow& row, int increments) {
    const char* clear_line = "\r\x1b[K";
    err_ << clear_line << "steps[" << row.step << "] of " << steps_ << ", increment "
         << row.increment << " of " << increments << ": " << toString(row.report.status) << ", "
         << numberText(row.report.wall_ms) << " ms" << std::flush;
    is_begun_ = true;
  }

 private:
  std::ostream& err_;
  std::size_t steps_;
  bool is_begun_ = false;
};

void tellNotOk(const RunResult& result, std::ostream& err) {
  if (!result.cut_off.empty()) {
    err << "simulate: --max-seconds is over at " << result.cut_off
        << ", what follows was not run\n";
    return;
  }
  const auto not_ok = [](const IncrementRow& row) { return row.report.status != SolveStatus::kOk; };
  const auto& rows = result.increments;
  const auto first = std::find_if(rows.begin(), rows.end(), not_ok);
  if (first == rows.end()) return;
  err << "simulate: " << std::count_if(rows.begin(), rows.end(), not_ok) << " of " << rows.size()
      << " increments not OK, the first is steps[" << first->step << "] increment "
      << first->increment << ": " << toString(first->report.status) << '\n';
}

bool sutures(const Scene& scene) {
  return std::any_of(scene.steps.begin(), scene.steps.end(),
                     [](const Step& step) { return std::holds_alternative<SutureStep>(step); });
}

std::vector<std::string> filesOf(const Scene& scene) {
  std::vector<std::string> files = {"nodes.csv", "patches.csv", "increments.csv", "tools.csv",
                                    "surface.stl"};
  if (partsTissue(scene)) files.push_back("pieces.csv");
  if (sutures(scene)) files.emplace_back("sutures.csv");
  for (const Step& step : scene.steps) {
    const auto* save = std::get_if<SaveStep>(&step);
    if (save != nullptr && std::find(files.begin(), files.end(), save->file) == files.end()) {
      files.push_back(save->file);
    }
  }
  return files;
}

// Results have fixed names, and states those of the scene: one may be that of the scene's file.
void requireNoInput(const Scene& scene, const Arguments& arguments) {
  const std::vector<std::string> inputs = inputFiles(scene, arguments.scene);
  for (const std::string& file : filesOf(scene)) {
    const std::string input =
        inputAt((std::filesystem::path(arguments.out) / file).string(), inputs);
    if (input.empty()) continue;
    throw InputError("--out = " + onOneLine(arguments.out) + ": " + file +
                     " would be written over " + onOneLine(input) +
                     ", which the scene is read from: must be another folder");
  }
}

// Where the scene asks for them; those of an earlier run are taken away. States of steps that the
// run was cut off before are not there, and stay as they were.
void write(const Scene& scene, const RunResult& result, OutputFolder& folder) {
  folder.write("nodes.csv", nodesCsv(result));
  folder.write("patches.csv", patchesCsv(result));
  folder.write("increments.csv", incrementsCsv(result));
  folder.write("tools.csv", toolsCsv(result));
  const auto writeIf = [&folder](bool any, const std::string& file, const auto& content) {
    if (any) return folder.write(file, content());
    folder.drop(file);
  };
  writeIf(sutures(scene), "sutures.csv", [&] { return suturesCsv(result); });
  folder.write("surface.stl", surfaceStl(result));
  writeIf(partsTissue(scene), "pieces.csv", [&] { return piecesCsv(result); });
  for (const auto& [file, state] : result.saved) folder.writeState(file, state);
  folder.commit();
}

RunResult runNamed(const Scene& scene, const Arguments& arguments, std::ostream& err, bool terminal,
                   const Deadline& deadline) {
  try {
    if (!terminal || arguments.quiet) return runScene(scene, {}, {}, deadline, arguments.out);
    ProgressLine line(err, scene.steps.size());
    const OnRow on_row = [&line](const IncrementRow& row, int increments) {
      line.show(row, increments);
    };
    return runScene(scene, on_row, {}, deadline, arguments.out);
  } catch (const InputError& error) {
    throw InputError(onOneLine(arguments.scene) + ": " + error.what());
  }
}

int run(const Arguments& arguments, std::ostream& err, bool terminal) {
  const Deadline deadline = arguments.max_seconds ? Deadline(*arguments.max_seconds) : Deadline();
  const Scene scene = loadScene(arguments.scene, arguments.overrides);
  requireNoInput(scene, arguments);
  OutputFolder folder(arguments.out, filesOf(scene));
  const RunResult result = runNamed(scene, arguments, err, terminal, deadline);
  write(scene, result, folder);
  if (!arguments.quiet) {  // a refusal is told alone
    for (const std::string& remark : scene.remarks) err << "simulate: " << remark << '\n';
    for (const std::string& remark : result.remarks) err << "simulate: " << remark << '\n';
    tellNotOk(result, err);
  }
  return result.allOk() ? kExitOk : kExitNotAllOk;
}

}  // namespace

int exitCodeOf(const std::string& program, std::ostream& err, const std::function<int()>& run) {
  try {
    return run();
  } catch (const InputError& error) {
    err << program << ": " << error.what() << '\n';
    return kExitBadInput;
  } catch (const std::filesystem::filesystem_error& error) {  // as in a folder that was deleted
    err << program << ": " << onOneLine(error.what())
        << ": must be files and folders that are there\n";
    return kExitBadInput;
  } catch (const std::exception& error) {
    err << program << ": " << error.what() << '\n';
    return kExitFailure;
  }
}

int simulate(const std::vector<std::string>& words, std::ostream& out, std::ostream& err,
             bool terminal) {
  return exitCodeOf("simulate", err, [&] {
    const Arguments arguments = parseArguments(words);
    if (!arguments.onlyPrints()) return run(arguments, err, terminal);
    printOut(arguments, out);
    return kExitOk;
  });
}

}  // namespace robot_tissue
