// Tissue that tears where a shape stretches it too far.
#pragma once

#include "world.h"

namespace robot_tissue {

// As Tissue::tear, not on a trial; what is torn is told in the report.
void tearStretched(World& world);

}  // namespace robot_tissue
