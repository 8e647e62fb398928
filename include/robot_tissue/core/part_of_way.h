// A shape on its way from another one: the same bits wherever it is asked for.
#pragma once

#include <cstddef>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Displacements (m), one a node: takes `to` back to that share (1) of its way from `from`.
inline void takeBack(const std::vector<Vec3>& from, double share, std::vector<Vec3>& to) {
  for (std::size_t node = 0; node < from.size(); ++node) {
    to[node] = from[node] + share * (to[node] - from[node]);
  }
}

}  // namespace robot_tissue
