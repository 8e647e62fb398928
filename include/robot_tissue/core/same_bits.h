// Whether places are the same to the last bit, so that what was found of them need not be found
// anew.
#pragma once

#include <cstring>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

inline bool areSame(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  if (a.size() != b.size()) return false;
  return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0;
}

inline bool areSame(const Pose& a, const Pose& b) {
  return std::memcmp(a.data(), b.data(), sizeof(Pose::MatrixType)) == 0;  // NOLINT: bits are meant
}

}  // namespace robot_tissue
