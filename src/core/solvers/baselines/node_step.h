// One node's step to its balance, guarded.
#pragma once

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A node's block without directions that are soft or negative, which cells pressed flat may have.
Eigen::Matrix3d firm(const Eigen::Matrix3d& block);

// The step, no longer than the length.
Vec3 capped(const Vec3& step, double length);

}  // namespace robot_tissue
