// The robot's URDF, on the parameter server or in a file.
#pragma once

#include <ros/node_handle.h>

#include <optional>
#include <string>

namespace robot_tissue {

// The parameter is looked for upwards from the node's namespace. Empty: not set yet. Throws
// InputError where it is something else than a text.
std::optional<std::string> robotDescription(const ros::NodeHandle& private_node,
                                            const std::string& parameter);

// Of the file that a command line names by --urdf. Throws InputError where it is no URDF.
std::string urdfOfFile(const std::string& path);

}  // namespace robot_tissue
