// Points deep inside a shape.
#pragma once

#include <vector>

#include "collision_shape.h"

namespace robot_tissue {

// Where no point of a shape's surface is in a closed surface, all of a part that hangs together is
// where one of its points is: a point deep inside each part (shape's frame, m), the middle of a
// primitive. None for a plane.
std::vector<Vec3> innerPoints(const CollisionShape& shape);

}  // namespace robot_tissue
