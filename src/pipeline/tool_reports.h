// What the tools met.
#pragma once

#include <cstddef>

#include "grasping.h"
#include "world.h"

namespace robot_tissue {

// But for the way of a tool that a force drives.
ToolReport describeTool(const World& world, const Grasping& grasping, std::size_t tool);

}  // namespace robot_tissue
