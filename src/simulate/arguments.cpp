#include "arguments.h"

#include <algorithm>
#include <set>

#include "robot_tissue/scene/map_reader.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

const std::vector<std::string> kValueOptions = {"--out", "--method", "--tolerance", "--threads"};
const std::vector<std::string> kSwitches = {"--list-methods", "--list-models", "--quiet", "--help"};

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

[[noreturn]] void refuseOption(const std::string& option) {
  std::vector<std::string> all = kValueOptions;
  all.insert(all.end(), kSwitches.begin(), kSwitches.end());
  const std::string nearest = nearestWord(option, all);
  throw InputError(onOneLine(option) + ": unknown option" +
                   (nearest.empty() ? "" : ", did you mean " + nearest + "?") +
                   ", must be one of " + joined(all));
}

void setSwitch(Arguments& parsed, const std::string& name) {
  if (name == "--list-methods") parsed.list_methods = true;
  if (name == "--list-models") parsed.list_models = true;
  if (name == "--quiet") parsed.quiet = true;
  if (name == "--help") parsed.help = true;
}

void setValue(Arguments& parsed, const std::string& name, const std::string& value) {
  if (value.empty()) throw InputError(name + ": must be followed by a value");
  if (name == "--out") parsed.out = value;
  if (name == "--method") parsed.overrides.method = value;
  if (name == "--tolerance") parsed.overrides.tolerance = value;
  if (name == "--threads") parsed.overrides.threads = value;
}

void requireSceneAndOut(const Arguments& parsed) {
  const std::string usage = ", must be simulate SCENE.yaml --out DIR (see --help)";
  if (parsed.scene.empty()) throw InputError("SCENE.yaml is missing" + usage);
  if (parsed.out.empty()) throw InputError("--out is missing" + usage);
}

}  // namespace

Arguments parseArguments(const std::vector<std::string>& arguments) {
  Arguments parsed;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument.empty() || argument.front() != '-') {
      if (argument.empty() || !parsed.scene.empty()) {
        throw InputError("\"" + onOneLine(argument) + "\": must be one SCENE.yaml only");
      }
      parsed.scene = argument;
      continue;
    }
    const std::size_t equals = argument.find('=');
    const std::string name = argument == "-h" ? "--help" : argument.substr(0, equals);
    const bool takes_value = contains(kValueOptions, name);
    if (!takes_value && !contains(kSwitches, name)) refuseOption(name);
    if (!seen.insert(name).second) throw InputError(name + ": stands twice, must stand once");
    if (!takes_value) {
      if (equals != std::string::npos) throw InputError(name + ": must stand without a value");
      setSwitch(parsed, name);
    } else if (equals != std::string::npos) {
      setValue(parsed, name, argument.substr(equals + 1));
    } else {
      setValue(parsed, name, i + 1 < arguments.size() ? arguments[++i] : "");
    }
  }
  if (!parsed.onlyPrints()) requireSceneAndOut(parsed);
  return parsed;
}

std::string helpText() {
  return R"(simulate SCENE.yaml --out DIR [options]
Runs the steps of a scene and writes what the tissue did to DIR; needs no ROS master.

  --out DIR         folder for nodes.csv, patches.csv, increments.csv, tools.csv and surface.stl
  --method NAME     solver method, instead of the scene's solver.method
  --tolerance X     relative, 0 < X < 1, instead of the scene's solver.tolerance
  --threads N       1 to 256, instead of the scene's solver.threads
  --list-methods    prints the solver methods
  --list-models     prints the tissue models
  --quiet           no progress and no remarks on stderr
  --help            prints this

Exit code: 0 all increments OK; 2 bad arguments or scene, nothing written; 3 some increment not OK,
everything still written; 1 an unforeseen failure, nothing written.
)";
}

}  // namespace robot_tissue
