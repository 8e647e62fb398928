// Plain types that every layer shares. SI units throughout (REP 103).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace robot_tissue {

using Vec3 = Eigen::Vector3d;
using Pose = Eigen::Isometry3d;

// Index of a node, spring or vertex as containers want it.
constexpr std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A mask of axes has bit 1 << axis.
constexpr std::uint8_t kAllAxes = 7;

// The matrix M with M w = v x w.
inline Eigen::Matrix3d crossMatrix(const Vec3& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

// A node's share of a point.
struct NodeWeight {
  int node = 0;
  double weight = 0.0;
};

// A place on a triangulated surface; it stays with the triangle as that deforms.
struct SurfacePoint {
  int triangle = 0;                 // index into the surface's triangles
  Vec3 barycentric = Vec3::Zero();  // weights of its corners, sum to 1
};

// Closed and axis-aligned (m); empty, with min() above max(), until it is given corners.
using Box = Eigen::AlignedBox3d;

// The box with that much more (m) on every side.
inline Box grownBy(double margin, const Box& box) {
  return {Vec3(box.min().array() - margin), Vec3(box.max().array() + margin)};
}

// Bad input. what() is one line that names the key or argument, its value and what is allowed.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace robot_tissue
