#include "robot_tissue/ros/node_parameters.h"

#include <XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <iomanip>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

#include "robot_tissue/scene/entry.h"
#include "robot_tissue/scene/scene_parser.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kLowestRate = 0.01;           // Hz
constexpr double kHighestRate = 10000.0;       // Hz
constexpr double kHighestWrenchRate = 1000.0;  // Hz
constexpr double kShortestTimeout = 1e-3;      // s
constexpr double kLongestTimeout = 1e6;        // s
constexpr double kLeastForceScale = 1e-9;      // m/N
constexpr double kMostForceScale = 1e9;        // m/N

const std::vector<std::string> kOwnKeys = {
    "rate",       "marker_rate",      "wrench_rate",
    "tf_timeout", "force_scale",      "robot_description_param",
    "scene_file", "diagnostic_period"};  // read by diagnostic_updater

// The fewest digits that are read back as the same number: 0.1, not 0.10000000000000001.
std::string shortestText(double value) {
  for (int digits = 15;; ++digits) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << std::setprecision(digits) << value;
    if (digits == 17 || std::stod(text.str()) == value) return text.str();
  }
}

// rosparam reads YAML 1.1, where an exponent needs a point and a sign: it makes words of 1e-6 and
// 3.0e9, which are as good as numbers.
bool isNumberOfRosparam(const std::string& text) {
  if (!parseNumber(text)) return false;
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

}  // namespace

NodeParameters readNodeParameters(const ros::NodeHandle& private_node) {
  XmlRpc::XmlRpcValue all;
  YAML::Node root(YAML::NodeType::Map);
  if (private_node.getParam(private_node.getNamespace(), all) &&
      all.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    root = toYaml(all);
  }
  const std::string name = private_node.getNamespace();
  const auto own = [&](const char* key) { return Entry(root[key], key, name); };
  SceneSource source;
  source.name = name;
  source.user = SceneUser::kNode;
  source.folder = readSceneFolder(own("scene_file"));
  source.other_keys = kOwnKeys;

  NodeParameters parameters;
  const Range rate{kLowestRate, kHighestRate, "Hz"};
  parameters.rate_hz = own("rate").numberOr(parameters.rate_hz, rate);
  parameters.marker_rate_hz = own("marker_rate").numberOr(parameters.marker_rate_hz, rate);
  parameters.wrench_rate_hz =
      own("wrench_rate").numberOr(parameters.wrench_rate_hz, {0.0, kHighestWrenchRate, "Hz"});
  parameters.tf_timeout_s =
      own("tf_timeout").numberOr(parameters.tf_timeout_s, {kShortestTimeout, kLongestTimeout, "s"});
  parameters.force_scale =
      own("force_scale")
          .numberOr(parameters.force_scale, {kLeastForceScale, kMostForceScale, "m/N"});
  if (own("robot_description_param").given()) {
    parameters.robot_description_param =
        own("robot_description_param").word("the name of a parameter that holds a URDF");
  }
  parameters.scene = parseScene(root, source);
  return parameters;
}

}  // namespace robot_tissue
