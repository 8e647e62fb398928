#include "replay.h"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <ostream>

#include "bag_follower.h"
#include "input_bag.h"
#include "replay_options.h"
#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/ros/robot_description.h"
#include "robot_tissue/scene/entry.h"
#include "robot_tissue/scene/scene_files.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

NodeParameters parametersOf(const ReplayOptions& options) {
  const YAML::Node root = loadSceneText(options.scene);
  SceneSource source;
  source.name = options.scene;
  source.user = SceneUser::kNode;
  source.folder = std::filesystem::absolute(options.scene).parent_path().string();
  source.overrides.threads = options.threads;
  NodeParameters parameters = parseNodeParameters(root, source);
  parameters.rate_hz = options.rate.value_or(parameters.rate_hz);
  parameters.scene.solver.max_ms = 0.0;  // it would be of the wall's clock
  if (parameters.scene.tools.empty()) {
    throw InputError(onOneLine(options.scene) + ": tools: none; allowed: at least one");
  }
  return parameters;
}

std::optional<std::string> urdfOf(const ReplayOptions& options, const InputBag& in) {
  return options.urdf ? urdfOfFile(*options.urdf) : in.robotDescription();
}

LoadedTools toolsFor(const NodeParameters& parameters, const std::optional<std::string>& urdf) {
  const std::vector<ToolConfig>& configs = parameters.scene.tools;
  if (urdf) return loadTools(*urdf, configs);
  if (const std::optional<std::string> link = linkThatNeedsUrdf(configs)) {
    throw InputError("tools: link '" + onOneLine(*link) +
                     "' has no shapes and there is no URDF; allowed: --urdf FILE, or shapes in "
                     "the scene");
  }
  return toolsOf(configs);
}

void requireNoInput(const ReplayOptions& options, const Scene& scene) {
  if (!inputAt(options.out, {options.in}).empty()) {
    throw InputError(onOneLine(options.out) + ": is IN.bag itself; allowed: another file");
  }
  std::vector<std::string> inputs = inputFiles(scene, options.scene);
  if (options.urdf) inputs.push_back(*options.urdf);
  const std::string input = inputAt(options.out, inputs);
  if (input.empty()) return;
  throw InputError(onOneLine(options.out) + ": is " + onOneLine(input) +
                   ", which is read; allowed: another file");
}

void follow(const ReplayOptions& options, std::ostream& out, std::ostream& err,
            const std::function<bool()>& is_stopped) {
  ros::Time::init();  // it is told what time it is (BagFollower)
  const NodeParameters parameters = parametersOf(options);
  const InputBag in(options.in);
  requireNoInput(options, parameters.scene);
  const LoadedTools loaded = toolsFor(parameters, urdfOf(options, in));
  OutputBag bag(options.out);
  const auto end_if_stopped = [&] {
    if (is_stopped()) throw InputError("stopped by a signal; nothing is written");
  };
  BagFollower follower(parameters, loaded.tools, {options.surface, options.nodes}, bag,
                       end_if_stopped);
  for (const auto* lines :
       {&parameters.scene.remarks, &loaded.warnings, &follower.toolWarnings()}) {
    for (const std::string& line : *lines) err << "replay: " << line << '\n';
  }
  in.forTransforms([&](const tf2_msgs::TFMessage& message, TransformIntake::Kind kind,
                       const ros::Time& received) {
    end_if_stopped();
    follower.take(message, kind, received);
  });
  if (follower.posesFollowed() == 0) {
    const std::string& why = follower.status().message;
    throw InputError(onOneLine(options.in) + ": has no pose of the tools" +
                     (why.empty() ? "" : " (" + onOneLine(why) + ")") +
                     "; allowed: transforms of all tools' links to '" +
                     parameters.scene.tissue.frame_id + "'");
  }
  bag.commit();
  out << follower.posesFollowed() << " poses followed; state hash " << std::hex << std::setw(16)
      << std::setfill('0') << follower.stateHash() << std::dec << '\n';
}

}  // namespace

int replay(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
           const std::function<bool()>& is_stopped) {
  try {
    const ReplayOptions options = parseReplayOptions(arguments);
    if (options.help) {
      out << replayHelp();
      return 0;
    }
    follow(options, out, err, is_stopped);
  } catch (const std::exception& error) {
    err << "replay: " << error.what() << '\n';
    return 2;
  }
  return 0;
}

}  // namespace robot_tissue
