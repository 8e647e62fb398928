#include "replay_options.h"

#include "robot_tissue/core/types.h"
#include "robot_tissue/ros/node_ranges.h"
#include "robot_tissue/scene/command_line.h"
#include "robot_tissue/scene/entry.h"

namespace robot_tissue {
ReplayOptions parseReplayOptions(const std::vector<std::string>& words) {
  const CommandLine line = readCommandLine(words, {{"--urdf", "--rate", "--threads"},
                                                   {"--surface", "--nodes", "--help"},
                                                   {"SCENE.yaml", "IN.bag", "OUT.bag"}});
  ReplayOptions options;
  options.scene = line.file(0);
  options.in = line.file(1);
  options.out = line.file(2);
  options.urdf = line.value("--urdf");
  options.threads = line.value("--threads");
  options.surface = line.has("--surface");
  options.nodes = line.has("--nodes");
  options.help = line.has("--help");
  if (options.help) return options;
  if (options.out.empty()) {
    throw InputError(std::to_string(line.files.size()) +
                     " files, must be three, SCENE.yaml IN.bag OUT.bag (see --help)");
  }
  const auto rate = line.value("--rate");
  if (rate) options.rate = Entry(YAML::Node(*rate), "--rate", "").number(ranges::rate());
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
