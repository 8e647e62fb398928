#include "robot_tissue/ros/node_parameters.h"

#include <XmlRpcValue.h>
#include <ros/names.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <locale>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "robot_tissue/ros/node_ranges.h"
#include "robot_tissue/scene/entry.h"
#include "robot_tissue/scene/key_table.h"
#include "robot_tissue/scene/value_text.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// The fewest digits that are read back as the same number: 0.1, not 0.10000000000000001.
std::string shortestText(double value) {
  for (int digits = 15;; ++digits) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << std::setprecision(digits) << value;
    if (digits == 17 || parseNumber(text.str()) == value) return text.str();
  }
}

// rosparam reads YAML 1.1, where an exponent needs a point and a sign, and a point that comes first
// has no sign before it: it makes words of 1e-6, 3.0e9 and -.05, which are as good as numbers.
bool isNumberOfRosparam(const std::string& text) {
  if (!parseNumber(text)) return false;
  if (text.find_first_of("+-") == 0 && text.find('.') == 1) return false;
  const std::size_t exponent = text.find_first_of("eE");
  if (exponent == std::string::npos) return true;
  const bool has_sign = text[exponent + 1] == '+' || text[exponent + 1] == '-';
  return has_sign && text.find('.') < exponent;
}

// A text that the server would not have as one unless its writer meant it, is in quotes as in a
// file: a word, no number and no truth.
YAML::Node wordOf(const std::string& text) {
  YAML::Node node(text);
  if (isNumberOfRosparam(text) || text == "true" || text == "false") node.SetTag("!");
  return node;
}

YAML::Node toYaml(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (auto& [key, entry] : value) map[key] = toYaml(entry);
      return map;
    }
    case XmlRpc::XmlRpcValue::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) list.push_back(toYaml(value[i]));
      return list;
    }
    case XmlRpc::XmlRpcValue::TypeString:
      return wordOf(value);
    case XmlRpc::XmlRpcValue::TypeDouble:
      return YAML::Node(shortestText(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(std::to_string(static_cast<int>(value)));
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value) ? "true" : "false");
    default:  // nothing that a scene has: a date, bytes
      return YAML::Node(YAML::NodeType::Null);
  }
}

// The node's own folder is not the user's: only an absolute path says where a scene is.
std::string readSceneFolder(const Entry& entry) {
  if (!entry.given()) return "";
  const std::string allowed = "the absolute path of the scene's file";
  const std::filesystem::path file = entry.word(allowed);
  if (!file.is_absolute()) entry.fail("must be " + allowed);
  return file.parent_path().string();
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// Two nodes do not share one: names have no point, so each gives another folder.
std::string defaultStateDir(const std::string& node_name) {
  const std::string ros_home = variable("ROS_HOME");
  std::string folder = node_name.substr(node_name.find_first_not_of('/'));
  std::replace(folder.begin(), folder.end(), '/', '.');
  return (ros_home.empty() ? variable("HOME") + "/.ros" : ros_home) + "/robot_tissue/" + folder;
}

std::string readStateDir(const Entry& entry) {
  const std::string allowed = "the absolute path of a folder";
  const std::filesystem::path folder = entry.word(allowed);
  if (!folder.is_absolute()) entry.fail("must be " + allowed);
  return folder.string();
}

// Of own_robot.launch, whose static transform does nothing for a tissue in another frame. Empty: it
// publishes none. After the scene was read.
void comparePlacedFrame(const Entry& entry, NodeParameters& parameters) {
  if (!entry.given() || entry.isWord(parameters.scene.tissue.frame_id)) return;
  const std::string frame = "'" + parameters.scene.tissue.frame_id + "'";
  if (entry.isWord("")) {
    return parameters.scene.remarks.push_back(
        "`place` of own_robot.launch has no effect, as tissue_frame is its parent: the tissue "
        "stands in the frame " +
        frame + " itself (tissue.frame_id)");
  }
  const std::string placed = entry.word("the name of a frame");
  parameters.scene.remarks.push_back(
      "`place` of own_robot.launch has no effect: it places the frame '" + placed +
      "', but the tissue stands in " + frame + "; set tissue.frame_id: " + placed +
      " in the scene (or, where no robot has that frame, tissue_frame:=" +
      parameters.scene.tissue.frame_id + ")");
}

// Under what is none, the node would wait for ever.
std::string readParameterName(const Entry& entry) {
  const std::string allowed =
      "the name of a parameter that holds a URDF: letters, digits, _ and single /, no private one";
  const std::string name = entry.word(allowed);
  std::string error;
  const bool is_truth = !isText(entry.node()) && (name == "true" || name == "false");
  const bool has_gap = name.find("//") != std::string::npos || name.back() == '/';
  if (is_truth || has_gap || name.front() == '~' || !ros::names::validate(name, error)) {
    entry.fail("must be " + allowed);
  }
  return name;
}

double readWrenchRate(const Entry& entry) {
  const double rate = entry.number(ranges::wrenchRate());
  if (rate == 0.0 || rate >= ranges::kLeastWrenchRate) return rate;
  entry.fail("must be 0, for one an update, or " + numberText(ranges::kLeastWrenchRate) +
             " Hz at least");
}

ColorBy readColor(const Entry& entry) {
  if (!entry.given()) return ColorBy::kNone;
  const std::optional<ColorBy> color = colorByName(entry.word(joined(colorNames())));
  if (!color) entry.fail("must be one of " + joined(colorNames()));
  return *color;
}

// The node's own parameters, beside those of the scene.
const KeyTable<NodeParameters> kOwnKeys = {
    {"rate",
     [](const Entry& entry, NodeParameters& parameters) {
       parameters.rate_hz = entry.numberOr(parameters.rate_hz, ranges::rate());
     }},
    {"marker_rate",
     [](const Entry& entry, NodeParameters& parameters) {
       parameters.marker_rate_hz = entry.numberOr(parameters.marker_rate_hz, ranges::rate());
     }},
    {"wrench_rate",
     [](const Entry& entry, NodeParameters& parameters) {
       if (entry.given()) parameters.wrench_rate_hz = readWrenchRate(entry);
     }},
    {"tf_timeout",
     [](const Entry& entry, NodeParameters& parameters) {
       parameters.tf_timeout_s = entry.numberOr(parameters.tf_timeout_s, ranges::poseTimeout());
     }},
    {"force_scale",
     [](const Entry& entry, NodeParameters& parameters) {
       parameters.force_scale = entry.numberOr(parameters.force_scale, ranges::forceScale());
     }},
    {"color",
     [](const Entry& entry, NodeParameters& parameters) { parameters.color = readColor(entry); }},
    {"robot_description_param",
     [](const Entry& entry, NodeParameters& parameters) {
       if (!entry.given()) return;
       parameters.robot_description_param = readParameterName(entry);
     }},
    {"state_dir",
     [](const Entry& entry, NodeParameters& parameters) {
       if (entry.given()) parameters.state_dir = readStateDir(entry);
     }},
    {"scene_file"},  // the scene is read against it
    {"placed_frame", comparePlacedFrame},
    // Read by diagnostic_updater, which takes anything.
    {"diagnostic_period",
     [](const Entry& entry, NodeParameters&) { entry.numberOr(1.0, ranges::diagnosticPeriod()); }},
};

}  // namespace

double updateBudget(const NodeParameters& parameters) {
  const double budget_ms = parameters.scene.solver.max_ms;
  return budget_ms > 0.0 ? 1e-3 * budget_ms : tuning::kLongestUpdate;
}

int mostIterations(const NodeParameters& parameters) {
  const SolverConfig& solver = parameters.scene.solver;
  return solver.max_iterations.value_or(solver.method == "layered" ? tuning::kMostIterations : 0);
}

NodeParameters parseNodeParameters(const YAML::Node& root, SceneSource source) {
  source.other_keys = namesOf(kOwnKeys);
  NodeParameters parameters;
  parameters.scene = parseScene(root, source);
  for (const Key<NodeParameters>& key : kOwnKeys) {
    if (key.read != nullptr) key.read(Entry(root[key.name], key.name, source.name), parameters);
  }
  return parameters;
}

NodeParameters readNodeParameters(const ros::NodeHandle& private_node) {
  XmlRpc::XmlRpcValue all;
  YAML::Node root(YAML::NodeType::Map);
  if (private_node.getParam(private_node.getNamespace(), all) &&
      all.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    root = toYaml(all);
  }
  SceneSource source;
  source.name = private_node.getNamespace();
  source.user = SceneUser::kNode;
  source.folder = readSceneFolder(Entry(root["scene_file"], "scene_file", source.name));
  NodeParameters parameters = parseNodeParameters(root, source);
  if (parameters.state_dir.empty()) parameters.state_dir = defaultStateDir(source.name);
  return parameters;
}

}  // namespace robot_tissue
