// Where on a triangle the signed distance to a shape is least, by cutting planes (Kelley 1960).
// Each value of a convex function with its slope gives a plane that is nowhere above it. The least
// point of the highest of these planes is where the function is asked next; its height there is a
// bound: the function is nowhere less on the triangle.
#pragma once

#include <array>
#include <cstddef>

#include "collision_shape.h"
#include "signed_distance.h"
#include "triangle_bvh.h"
#include "tuning.h"

namespace robot_tissue {

double longestEdge(const Corners& corners);

// The highest of some planes over a triangle; a plane is given by its values at the corners.
class HighestPlane {
 public:
  static constexpr std::size_t kMost = tuning::kMostPlanes;

  // At most kMost of them.
  void add(const Vec3& corner_values);
  std::size_t size() const { return count_; }
  double least() const { return least_; }
  const Vec3& leastWeights() const { return weights_; }

 private:
  void tryOnEdge(int a, int b, double weight);
  void tryPoint(const Vec3& weights);

  std::array<Vec3, kMost> planes_;
  std::size_t count_ = 0;
  double least_ = 0.0;
  Vec3 weights_ = Vec3::Zero();
};

struct TriangleMinimum {
  Vec3 weights = Vec3::Zero();
  SignedDistance distance;
};

// Accuracy of a least value (m): 0.5 % of the longest edge or 2 % of the shape's thickness, which
// is less; 1e-5 m at least.
double accuracyFor(const CollisionShape& shape, const Corners& corners);

// For a convex shape and corners in its frame. In: the distances of the corners. Returns the least
// of the distances it asked for, the corners' among them: within `accuracy` (m) of the least, or
// one that is not less than `limit` (m), when there is none less.
TriangleMinimum convexMinimum(const CollisionShape& shape, const Corners& corners,
                              const std::array<SignedDistance, 3>& at_corners, double accuracy,
                              double limit);

// A local least distance near `seed` (weights), for a shape that is convex only in parts (own):
// planes are believed in a triangle around the best point so far, which grows with what is gained
// and shrinks where a plane turns out wrong.
TriangleMinimum localMinimum(const CollisionShape& shape, const Corners& corners,
                             const TriangleMinimum& seed, double accuracy);

// How far at most a shape's surface is from a point (m) that is this way from one with this
// distance, with something for rounding.
double boundAfter(double distance, double way);

}  // namespace robot_tissue
