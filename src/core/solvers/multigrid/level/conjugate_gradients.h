// Conjugate gradients, cut short (Hestenes and Stiefel 1952; Nocedal and Wright 2006, 5.1).
#pragma once

#include <cstddef>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

inline double productOf(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double product = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) product += a[i].dot(b[i]);
  return product;
}

inline void addTo(std::vector<Vec3>& to, double share, const std::vector<Vec3>& other) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += share * other[i];
}

// When they end: at this share of what r . C^-1 r was at first, or after so many steps.
struct CutShort {
  double share = 0.0;
  int most = 0;
};

// About B^-1 f. times(p) = B p and divided(r) = C^-1 r, both symmetric and positive, C near B.
// However soon it ends, the motion x found has f . x = x . B x: it leads downhill, not too far.
template <typename Times, typename Divided>
std::vector<Vec3> conjugateGradients(std::vector<Vec3> force, const CutShort& end, Times times,
                                     Divided divided) {
  std::vector<Vec3> found(force.size(), Vec3::Zero()), direction(force.size(), Vec3::Zero());
  double first = 0.0, before = 0.0;
  for (int step = 0; step < end.most; ++step) {
    const std::vector<Vec3> motion = divided(force);
    const double work = productOf(force, motion);
    if (step == 0) first = work;
    if (!(work > end.share * first)) break;
    const double keep = step == 0 ? 0.0 : work / before;
    for (std::size_t i = 0; i < direction.size(); ++i) {
      direction[i] = motion[i] + keep * direction[i];
    }
    const std::vector<Vec3> product = times(direction);
    const double length = work / productOf(direction, product);
    addTo(found, length, direction);
    addTo(force, -length, product);
    before = work;
  }
  return found;
}

}  // namespace robot_tissue
