// Where two triangles of a sheet meet (discrete shells: Grinspun, Hirani, Desbrun, Schroeder 2003).
// With theta the angle between their normals, e the edge at rest, and A1, A2 the areas there,
//
//   E = D / 2 (theta - theta_rest)^2 |e|^2 / (A1 + A2)
//
// is D / 2 kappa^2 of a sheet that bends along one direction: (A1 + A2) / |e| is the mean of both
// heights, over which the angle is a curvature.
#pragma once

#include <Eigen/Core>
#include <array>

#include "membrane/stretched_triangle.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class Hinge {
 public:
  // The edge's ends, then the corner opposite to it of the triangle that runs along it from first
  // to second, then that of the other one.
  using Corners = std::array<Vec3, 4>;
  using Hessian = Eigen::Matrix<double, 12, 12>;  // rows and columns 3 * corner + axis

  // `bending`: D (N m).
  Hinge(double bending, const Corners& rest);

  static double angle(const Corners& places);  // rad, > 0 where the sheet is seen as a ridge

  double stiffness() const { return stiffness_; }  // of the angle (N m)
  double restAngle() const { return rest_angle_; }
  double energy(const Corners& places) const;     // J
  Corners gradient(const Corners& places) const;  // of the energy (N)
  // kConvex leaves out what the angle's own second derivative adds.
  Hessian hessian(const Corners& places, Curvature curvature) const;

 private:
  double fromRest(double angle) const;  // between -pi and pi

  double stiffness_;  // N m
  double rest_angle_;
};

}  // namespace robot_tissue
