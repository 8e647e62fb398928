// How threads of sutures are drawn.
#pragma once

#include <vector>

#include "robot_tissue/core/tissue.h"

namespace robot_tissue {

// Ends of the lines, two each (m, tissue frame), of all threads that have not broken: an arch over
// the skin from one end of the thread to the other. A straight line would lie half in it.
std::vector<Vec3> threadLines(const Tissue& tissue);

}  // namespace robot_tissue
