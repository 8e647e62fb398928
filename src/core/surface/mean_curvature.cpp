#include "surface/mean_curvature.h"

#include <Eigen/Dense>

namespace robot_tissue {
namespace {

constexpr std::size_t kFewest = 6;  // vertices: as many as numbers are looked for, and two

}  // namespace

double meanCurvature(const std::vector<Vec3>& places, const std::vector<int>& vertices,
                     const Vec3& place, const Vec3& outwards, double reach) {
  if (vertices.size() < kFewest) return 0.0;
  const Vec3 along = outwards.unitOrthogonal(), across = outwards.cross(along);
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const int vertex : vertices) {
    const Vec3 way = (places[at(vertex)] - place) / reach;
    const double height = way.dot(outwards);
    const double half_square = 0.5 * (way.squaredNorm() - height * height);
    const Eigen::Vector4d row(1.0, way.dot(along), way.dot(across), -half_square);
    squares += row * row.transpose();
    right += height * row;
  }
  const Eigen::ColPivHouseholderQR<Eigen::Matrix4d> solver(squares);
  return solver.isInvertible() ? solver.solve(right)[3] / reach : 0.0;
}

}  // namespace robot_tissue
