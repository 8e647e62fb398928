#pragma once

#include <limits>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Infinite where one is empty.
inline double distance(const Box& a, const Box& b) {
  if ((a.min().array() > a.max().array()).any() || (b.min().array() > b.max().array()).any()) {
    return std::numeric_limits<double>::infinity();
  }
  const Vec3 apart = (a.min() - b.max()).cwiseMax(b.min() - a.max()).cwiseMax(Vec3::Zero());
  return apart.norm();
}

}  // namespace robot_tissue
