#include "replay_options.h"

#include <algorithm>
#include <iterator>

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

std::optional<std::string>* valueOf(const std::string& option, ReplayOptions& options) {
  if (option == "--urdf") return &options.urdf;
  if (option == "--rate") return &options.rate;
  return option == "--threads" ? &options.threads : nullptr;
}

bool* switchOf(const std::string& option, ReplayOptions& options) {
  if (option == "--surface") return &options.surface;
  if (option == "--nodes") return &options.nodes;
  return option == "--help" || option == "-h" ? &options.help : nullptr;
}

}  // namespace

ReplayOptions parseReplayOptions(const std::vector<std::string>& arguments) {
  ReplayOptions options;
  std::vector<std::string> files;
  for (auto word = arguments.begin(); word != arguments.end(); ++word) {
    if (bool* is_on = switchOf(*word, options)) {
      *is_on = true;
    } else if (auto* value = valueOf(*word, options)) {
      if (std::next(word) == arguments.end() || std::next(word)->rfind("--", 0) == 0) {
        throw InputError(*word + ": has no value; allowed: a value after it (see --help)");
      }
      *value = *++word;
    } else if (word->rfind("--", 0) == 0) {
      throw InputError(shortText(*word) +
                       ": is not known; allowed: --urdf, --rate, --threads, --surface, --nodes, "
                       "--help");
    } else {
      files.push_back(*word);
    }
  }
  if (options.help) return options;
  if (files.size() != 3) {
    throw InputError(std::to_string(files.size()) +
                     " files; allowed: three, SCENE.yaml IN.bag OUT.bag (see --help)");
  }
  options.scene = files[0];
  options.in = files[1];
  options.out = files[2];
  return options;
}

std::string replayHelp() {
  return R"(replay SCENE.yaml IN.bag OUT.bag [options]
The tissue follows the transforms of IN.bag as the node does; what the node tells, and a hash of the
tissue's state an update, is written to OUT.bag: the same bytes on every run. Needs no ROS master.

  --urdf FILE     the robot's description; without it /robot_description of the bag (std_msgs/String),
                  without that the scene's shapes
  --rate HZ       updates a second at most, instead of the scene's rate (100)
  --threads N     1 to 256, instead of the scene's solver.threads
  --surface       the surface, too, whenever it changed
  --nodes         the nodes, too
  --help          prints this

Exit code: 0 when OUT.bag is whole, 2 otherwise, with one line that says why; OUT.bag is as before.
)";
}

}  // namespace robot_tissue
