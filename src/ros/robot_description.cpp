#include "robot_tissue/ros/robot_description.h"

#include <XmlRpcValue.h>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

std::optional<std::string> robotDescription(const ros::NodeHandle& private_node,
                                            const std::string& parameter) {
  std::string path;
  XmlRpc::XmlRpcValue value;
  if (!private_node.searchParam(parameter, path) || !private_node.getParam(path, value)) return {};
  if (value.getType() == XmlRpc::XmlRpcValue::TypeString) return std::string(value);
  throw InputError("parameter '" + path +
                   "' (~robot_description_param) is no text; allowed: a URDF");
}

}  // namespace robot_tissue
