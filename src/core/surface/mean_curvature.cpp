#include "surface/mean_curvature.h"

#include <Eigen/Dense>

namespace robot_tissue {
namespace {

constexpr int kFewest = 6;  // vertices: as many as numbers are looked for, and two

}  // namespace

double meanCurvature(const std::vector<Vec3>& vertices, const Vec3& place, const Vec3& outwards,
                     double reach) {
  const Vec3 along = outwards.unitOrthogonal(), across = outwards.cross(along);
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  int count = 0;
  for (const Vec3& vertex : vertices) {
    const Vec3 way = (vertex - place) / reach;
    if (!(way.squaredNorm() <= 1.0)) continue;
    const double height = way.dot(outwards);
    const double half_square = 0.5 * (way.squaredNorm() - height * height);
    const Eigen::Vector4d row(1.0, way.dot(along), way.dot(across), -half_square);
    squares += row * row.transpose();
    right += height * row;
    ++count;
  }
  if (count < kFewest) return 0.0;
  const Eigen::ColPivHouseholderQR<Eigen::Matrix4d> solver(squares);
  return solver.isInvertible() ? solver.solve(right)[3] / reach : 0.0;
}

}  // namespace robot_tissue
