// The tree over the tissue's surface as it is now.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "robot_tissue/core/surface.h"
#include "triangle_bvh.h"

namespace robot_tissue {

// FCL's tree over a surface: made from its rest shape, so that it depends on nothing before, and
// refitted to the deformed one.
class SurfaceTree {
 public:
  const TriangleBvh& of(const TissueSurface& surface, const std::vector<Vec3>& vertices);
  bool exists() const { return tree_.has_value(); }
  const TriangleBvh& last() const { return *tree_; }
  // Counts how often another surface was taken, or the same moved: what was found at another count
  // is of another shape.
  std::uint64_t moves() const { return moves_; }
  std::uint64_t trees() const { return trees_; }  // counts other surfaces alone

 private:
  bool isOf(const TissueSurface& surface) const;

  std::uint64_t revision_ = 0;
  std::optional<TriangleBvh> tree_;
  std::uint64_t moves_ = 0;
  std::uint64_t trees_ = 0;
};

}  // namespace robot_tissue
