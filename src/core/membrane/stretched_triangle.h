// A triangle of a sheet, of constant strain, in plane stress. With the columns of F what the rest
// triangle's unit vectors become, C = F^T F, and per area at rest,
//
//   W = mu t / 2 [tr C - 2 + (det C^-s - 1) / s],   s = nu / (1 - nu)
//
// is what a compressible neo-Hookean solid (Blatz and Ko 1962), mu / 2 [tr C3 - 3 + (J^(-2 b) - 1)
// / b] with b = nu / (1 - 2 nu), has when no stress acts across the sheet; nu = 1/2 is the
// incompressible one, -ln det C stands for the last term where nu = 0. It has no finite energy
// where the area vanishes.
#pragma once

#include <Eigen/Core>
#include <array>

#include "membrane/sheet_law.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Second derivatives exactly, or without what could make them negative (kConvex).
enum class Curvature { kExact, kConvex };

class StretchedTriangle {
 public:
  using Corners = std::array<Vec3, 3>;
  using Hessian = Eigen::Matrix<double, 9, 9>;  // rows and columns 3 * corner + axis

  StretchedTriangle(const SheetLaw& law, const Corners& rest);

  double area() const { return area_; }  // at rest (m^2)
  double shear() const { return shear_; }
  double exponent() const { return exponent_; }
  const Eigen::Matrix<double, 2, 3>& slopes() const { return slopes_; }
  double energy(const Corners& places) const;     // J
  Corners gradient(const Corners& places) const;  // of the energy (N)
  // S = 2 mu t dW/dC, of the second Piola-Kirchhoff stress times t, is taken without its negative
  // eigenvalues for kConvex; the rest has none.
  Hessian hessian(const Corners& places, Curvature curvature) const;

 private:
  struct Strain {
    Eigen::Matrix<double, 3, 2> F;
    Eigen::Matrix2d inverse;   // of C
    double determinant = 0.0;  // of C
    double power = 0.0;        // det C^-s
  };
  Strain strainOf(const Corners& places) const;

  double shear_;     // mu t (N/m)
  double exponent_;  // s
  double area_ = 0.0;
  Eigen::Matrix<double, 2, 3> slopes_;  // of the corners' weights at rest (1/m)
};

}  // namespace robot_tissue
