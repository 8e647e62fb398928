// A shape as what it presses on sees it (own).
#pragma once

#include <memory>

#include "collision_shape.h"
#include "robot_tissue/core/indenter.h"

namespace robot_tissue {

// Padding included; of a plane none. A cylinder is a prism with as large an end.
std::shared_ptr<const Indenter> indenterOf(const CollisionShape& shape);

}  // namespace robot_tissue
