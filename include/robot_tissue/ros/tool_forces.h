// Where tools are, and what they do to the tissue, in the tissue's frame.
#pragma once

#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

// Of the tool's first link, which the tool's wrench is in; once the pipeline has a pose.
const Pose& poseOf(const Pipeline& pipeline, std::size_t tool);
// The force of a tool on the tissue (N): the tool's wrench, turned. Zero before the tool has a
// pose.
Vec3 forceOnTissue(const Pipeline& pipeline, std::size_t tool);

}  // namespace robot_tissue
