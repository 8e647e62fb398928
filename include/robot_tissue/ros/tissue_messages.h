// What is told of the tissue and its tools after an update, as messages; headers without stamp and
// frame. Of the node, and of `replay`.
#pragma once

#include <geometry_msgs/Wrench.h>
#include <robot_tissue/ContactArray.h>
#include <robot_tissue/TissueState.h>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/ros/node_status.h"

namespace robot_tissue {

// Without the times of publishing and the pose's age.
TissueState stateMessage(const Pipeline& pipeline, const NodeStatus& status);
ContactArray contactArray(const Pipeline& pipeline);
// Of the tissue on the tool, in the tool's frame.
geometry_msgs::Wrench wrenchOn(const ToolReport& report);

}  // namespace robot_tissue
