// What the tools met.
#pragma once

#include <cstddef>

#include "grasping.h"
#include "touch_finder.h"
#include "world.h"

namespace robot_tissue {

// Of each tool the deepest point in the tissue (m), also of one that touches nothing that gives
// way.
std::vector<double> deepestPoints(const World& world, TouchFinder& touch_finder);

// The report of a tool, but for max_penetration (deepestPoints), offset (ForceDrive) and what its
// edge meets (Blades), which the caller puts in.
ToolReport describeTool(const World& world, const Grasping& grasping, std::size_t tool);

// A wrench stronger than the tool's max_force (N; 0: none) is told as that; once all of it is
// there.
void limitWrench(double max_force, ToolReport& report);

// Of a node that the tool holds, from the tool into the tissue, of any length; zero where every way
// is as good.
Vec3 wayOutOfTool(const World& world, int node, const StickingContacts::Attachment& seat);

}  // namespace robot_tissue
