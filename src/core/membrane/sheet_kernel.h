// Forces of stretched triangles and hinges, many at a time: what StretchedTriangle and Hinge
// answer, in the lanes of vector instructions (own). Each element has lanes of its own, so results
// are the same however long the processor's vectors are, but for rounding of products.
#pragma once

#include <array>
#include <vector>

#include "membrane/hinge.h"
#include "membrane/stretched_triangle.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Elements with this many corners and numbers, which kernels read lane by lane.
template <std::size_t kCornerCount, std::size_t kNumberCount>
struct SheetElements {
  static constexpr std::size_t kElementCorners = kCornerCount;
  std::vector<std::array<int, kCornerCount>> vertices;
  std::vector<std::array<double, kNumberCount>> numbers;
};

class SheetKernel {
 public:
  // Numbers: mu t A, s, and the slopes of the weights of the second and third corner.
  using Triangles = SheetElements<3, 6>;
  using Hinges = SheetElements<4, 2>;  // stiffness (N m), angle at rest

  void add(const StretchedTriangle& law, const std::array<int, 3>& vertices);
  void add(const Hinge& law, const std::array<int, 4>& vertices);

  // Places of vertices (m); adds to the forces on them (N).
  void addForces(const std::vector<Vec3>& places, std::vector<Vec3>& forces) const;

 private:
  Triangles triangles_;
  Hinges hinges_;
};

}  // namespace robot_tissue
