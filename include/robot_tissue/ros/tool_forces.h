// The force of a tool on the tissue, tissue frame (N): the tool's wrench, turned. Zero before the
// tool has a pose.
#pragma once

#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

Vec3 forceOnTissue(const Pipeline& pipeline, std::size_t tool);

}  // namespace robot_tissue
