// What the tools press with, as a pressure on the surface.
#pragma once

#include <vector>

#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

// Per vertex of the deformed surface (Pa, >= 0): the normal forces of the tools' touches, shared
// among the corners of the triangle that each is on, over a third of the area of the triangles
// around. Times these thirds they add up to the tools' normal forces. What a grasper holds and
// pulls at counts as zero.
std::vector<double> touchPressures(const Pipeline& pipeline);

}  // namespace robot_tissue
