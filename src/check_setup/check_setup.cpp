#include "check_setup.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <ostream>

#include "robot_checks.h"
#include "robot_tissue/contact/contact_finder.h"
#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/ros/robot_description.h"
#include "robot_tissue/scene/command_line.h"
#include "robot_tissue/scene/scene_parser.h"
#include "robot_tissue/scene/value_text.h"
#include "scene_checks.h"
#include "trial_press.h"

namespace robot_tissue {
namespace {

constexpr double kMostSeconds = 60.0;  // of the trial press

const char* const kUsage =
    "usage: check_setup SCENE.yaml [--urdf FILE]\n"
    "Looks at the scene, at the robot of FILE or of the running master (the parameter that\n"
    "robot_description_param of the scene names, /tf), and presses each tool, or else a sphere,\n"
    "1 mm in. A line each, with its remedy.\n"
    "Exit code 0: fine; 1: warnings; 2: it cannot run, or wrong arguments.\n";

struct Arguments {
  std::string scene;
  std::optional<std::string> urdf;  // a file; none: what runs
  bool help = false;
};

Arguments parse(const std::vector<std::string>& words) {
  const CommandLine line = readCommandLine(words, {{"--urdf"}, {"--help"}});
  const Arguments parsed{line.file(0), line.value("--urdf"), line.has("--help")};
  if (parsed.help || !parsed.scene.empty()) return parsed;
  throw InputError("SCENE.yaml is missing, must be check_setup SCENE.yaml [--urdf FILE]");
}

const char* wordOf(Finding::Level level) {
  switch (level) {
    case Finding::Level::kNote:
      return "note";
    case Finding::Level::kWarning:
      return "warning";
    case Finding::Level::kError:
      return "error";
  }
  return "";
}

class Teller {
 public:
  explicit Teller(std::ostream& out) : out_(out) {}

  void tell(const Findings& findings) {
    for (const Finding& finding : findings) {
      out_ << wordOf(finding.level) << ": " << onOneLine(finding.text);
      if (!finding.remedy.empty()) out_ << "; remedy: " << finding.remedy;
      out_ << std::endl;
      worst_ = std::max(worst_, finding.level);
    }
  }
  int exitCode() const {
    if (worst_ == Finding::Level::kError) return kCannotRun;
    return worst_ == Finding::Level::kWarning ? kHasWarnings : kFine;
  }

 private:
  std::ostream& out_;
  Finding::Level worst_ = Finding::Level::kNote;
};

Robot robotOf(const Arguments& arguments, const NodeParameters& parameters,
              const LookAtRobot& look) {
  if (!arguments.urdf) return look(parameters);
  return {urdfOfFile(*arguments.urdf), {}};
}

// Those that can be told of a robot whose faults were told before.
std::vector<ToolGeometry> knownTools(const Scene& scene, const std::optional<std::string>& urdf) {
  try {
    std::vector<ToolGeometry> tools =
        (urdf ? loadTools(*urdf, scene.tools) : toolsOf(scene.tools)).tools;
    const ContactFinder all_can_be_loaded(tools);
    return tools;
  } catch (const InputError&) {
    return {};
  }
}

void check(const Arguments& arguments, const LookAtRobot& look, Teller& teller) {
  const YAML::Node text = loadSceneText(arguments.scene);
  SceneSource source;  // of the runner: it may be a scene for that
  source.name = arguments.scene;
  source.folder = std::filesystem::absolute(arguments.scene).parent_path().string();
  teller.tell(checkUnits(text, source.folder));
  const NodeParameters parameters = parseNodeParameters(text, source);
  const Scene& scene = parameters.scene;
  teller.tell(checkWalls(scene.tissue));
  teller.tell(checkForNode(scene));
  const Robot robot = robotOf(arguments, parameters, look);
  teller.tell(robot.findings);
  teller.tell(checkTools(scene, robot.urdf.value_or("")));
  teller.tell(checkPress(scene, knownTools(scene, robot.urdf), kMostSeconds));
}

}  // namespace

int checkSetup(const std::vector<std::string>& words, const LookAtRobot& look, std::ostream& out,
               std::ostream& err) {
  Teller teller(out);
  try {
    const Arguments arguments = parse(words);
    if (arguments.help) {
      out << kUsage;
    } else {
      check(arguments, look, teller);
    }
  } catch (const std::exception& error) {
    err << "check_setup: " << error.what() << '\n';
    return kCannotRun;
  }
  return teller.exitCode();
}

}  // namespace robot_tissue
