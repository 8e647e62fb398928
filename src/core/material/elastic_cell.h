// The energy of one cell of model `elastic`: springs of zero rest length along its diagonals, held
// open by a volume energy. Derivation: doc/model.md.
//
//   E = h^3 [a(J) I1 / 2 - 3 mu / 2 + K / 2 (J - 1)^2] + barrier,   a(J) = mu J^(-2/3)
//
// I1 is the mean of tr F^T F over the trilinear cell, J the determinant of the mean deformation
// gradient. The barrier rises where the edges at a corner span less than 0.3 of their rest volume.
#pragma once

#include <Eigen/Core>
#include <array>

#include "config/material.h"
#include "material/energy_model.h"
#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class ElasticCell {
 public:
  // One vector a corner, in the order of cellCorners.
  using Corners = std::array<Vec3, kCorners>;

  // Displacements of the corners from rest (m).
  ElasticCell(const Moduli& moduli, double spacing, const Corners& displacement);

  double energy() const;                    // J, zero at rest
  Vec3 gradient(int corner) const;          // of the energy (N)
  Eigen::Matrix3d block(int corner) const;  // second derivative in one corner alone (N/m)
  CellHessian hessian() const;

 private:
  // Determinant of a deformation gradient F = sum of position * weight^T over the corners.
  struct Determinant {
    Eigen::Matrix3d gradient;  // F
    Corners weight;            // 1/m
    Corners slope;             // derivative of the determinant in each corner (1/m)
    double value = 1.0;
  };
  // A function of one variable, and its derivatives.
  struct Curve {
    double value = 0.0;
    double slope = 0.0;
    double curvature = 0.0;
  };

  Determinant determinantOf(const Corners& weight) const;
  void findSqueezedCorners();
  Curve stiffening() const;
  Curve volumeTerm() const;
  Curve barrier(const Determinant& edges) const;  // Pa

  Moduli moduli_;
  double spacing_;
  double volume_;     // at rest (m^3)
  Corners position_;  // from the lowest corner's rest place (m)
  Determinant mean_;
  std::array<Determinant, kCorners> squeezed_;  // where the barrier rises, the first of them
  int squeezed_count_ = 0;
  double invariant_ = 3.0;   // I1
  Corners invariant_slope_;  // (1/2) dI1/dx (1/m)
  Curve stiffening_;         // a(J), Pa
  Curve volume_term_;        // E / h^3 without the barrier, as a function of J at constant I1, Pa
};

}  // namespace robot_tissue
