#include "robot_tissue/ros/robot_description.h"

#include <XmlRpcValue.h>

#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/core/types.h"
#include "robot_tissue/mesh/regular_file.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kLargestUrdf = 100000000;  // bytes

}  // namespace

std::optional<std::string> robotDescription(const ros::NodeHandle& private_node,
                                            const std::string& parameter) {
  std::string path;
  XmlRpc::XmlRpcValue value;
  if (!private_node.searchParam(parameter, path) || !private_node.getParam(path, value)) return {};
  if (value.getType() == XmlRpc::XmlRpcValue::TypeString) return std::string(value);
  throw InputError("parameter '" + path +
                   "' (~robot_description_param) is no text; allowed: a URDF");
}

std::string urdfOfFile(const std::string& path) {
  const std::string option = "--urdf = " + onOneLine(path) + ": ";
  std::string urdf;
  try {
    urdf = readRegularFile(path, kLargestUrdf);
  } catch (const InputError& error) {
    throw InputError(option + error.what() + "; allowed: a URDF file that can be read");
  }
  try {
    requireUrdf(urdf);
  } catch (const InputError& error) {
    throw InputError(option + error.what());
  }
  return urdf;
}

}  // namespace robot_tissue
