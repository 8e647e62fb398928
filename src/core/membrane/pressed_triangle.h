// A triangle of a closed surface that a pressure p pushes along its normal: -p times its share of
// the enclosed volume V = sum x_0 . (x_1 x x_2) / 6. Energy, forces and their derivative are those
// of the pressure where all triangles of the closed surface are summed up, not for one alone.
#pragma once

#include <Eigen/Core>
#include <array>

#include "membrane/stretched_triangle.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class PressedTriangle {
 public:
  using Corners = std::array<Vec3, 3>;
  using Hessian = Eigen::Matrix<double, 9, 9>;  // rows and columns 3 * corner + axis

  // Pa; < 0: against the normal. `origin`: that volumes are counted from, near the surface (m).
  PressedTriangle(double pressure, const Vec3& origin) : pressure_(pressure), origin_(origin) {}

  double energy(const Corners& places) const;     // J
  Corners gradient(const Corners& places) const;  // of the energy (N)
  // kConvex: zero; a pressure's own makes no shape more stable.
  Hessian hessian(const Corners& places, Curvature curvature) const;

 private:
  double pressure_;
  Vec3 origin_;
};

}  // namespace robot_tissue
