// The energy of one cell of model `elastic`: springs of zero rest length along its diagonals, held
// open by a volume energy. Derivation: doc/model.md.
//
//   E = h^3 [a(J) I1 / 2 - 3 mu / 2 + K / 2 (J - 1)^2] + barrier,   a(J) = mu J^(-2/3)
//
// With the law `fung` h^3 [mu / 2 g(a(J) I1 / mu - 3) + K / 2 (J - 1)^2] (elastic_law.h).
//
// I1 is the mean of tr F^T F over the trilinear cell, J the determinant of the mean deformation
// gradient. The barrier rises where the edges at a corner span less than 0.3 of their rest volume.
// Of a cell that is filled in part the means are those over the fill, and the barrier's corners
// those of a box in it (material/fill_law.h).
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "config/material.h"
#include "material/energy_model.h"
#include "material/fill_law.h"
#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class ElasticCell {
 public:
  // One vector a corner, in the order of cellCorners.
  using Corners = std::array<Vec3, kCorners>;
  // Of a cell that is filled in part also of the nodes that it reaches, as reachedNodes.
  using Reached = std::array<Vec3, kMostReached>;

  // Displacements from rest (m). The moduli count for all of h^3; `fill`, null for a full cell,
  // tells where the material is; `reach`: null where no cell is beside it.
  ElasticCell(const Moduli& moduli, double spacing, const Reached& displacement,
              const CellFill* fill, const CellReach* reach);
  ElasticCell(const Moduli& moduli, double spacing, const Corners& displacement,
              const CellFill* fill = nullptr);

  // From here on also with what damps the strain that a time step adds (material/viscosity.h), of
  // these moduli; `from`: the cell where the rate is taken from.
  void damp(const Moduli& viscous, const ElasticCell& from);

  double energy() const;                    // J, zero at rest
  double shapeStrain() const;               // x of elastic_law.h, J^(-2/3) I1 - 3
  int nodeCount() const { return count_; }  // corners, and nodes reached
  Vec3 gradient(int corner) const;          // of the energy (N)
  Eigen::Matrix3d block(int corner) const;  // second derivative in one corner alone (N/m)
  CellHessian hessian() const;

 private:
  // Determinant of a deformation gradient F = sum of position * weight^T over the corners.
  struct Determinant {
    Eigen::Matrix3d gradient;  // F
    Reached weight;            // 1/m
    Reached slope;             // derivative of the determinant in each corner (1/m)
    double value = 1.0;
  };
  // A function of one variable, and its derivatives.
  struct Curve {
    double value = 0.0;
    double slope = 0.0;
    double curvature = 0.0;
  };

  // (1/2) d2I1/dx_i dx_j, times the unit matrix (1/12h^2).
  using Pairs =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostReached, kMostReached>;

  struct Damping {
    double shear = 0.0, lame = 0.0;                    // mu, lambda (Pa)
    Reached weight;                                    // F_0^-T w of each node (1/m)
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();  // 2 mu D + lambda tr D (Pa)
    Reached rough;        // of what bends and twists, half the derivative of its part of I1 (1/m)
    double energy = 0.0;  // density (Pa)
  };
  Vec3 roughSlope(std::size_t node) const;
  void addDamping(CellHessian& density) const;

  void measureFull();
  void measureFill();
  Pairs invariantPairs() const;
  Determinant determinantOf(const Reached& weight) const;
  Determinant determinantOf(const Reached& weight, const Eigen::Matrix3d& gradient) const;
  void findSqueezedCorners();
  void findSqueezedInFill();
  bool areEdgesNearRest() const;
  Curve neoHookean() const;
  void findLaw();
  Curve barrier(const Determinant& edges) const;  // Pa

  Moduli moduli_;
  double spacing_;
  double volume_;         // at rest (m^3)
  int count_ = kCorners;  // of nodes
  const CellFill* fill_ = nullptr;
  const CellReach* reach_ = nullptr;
  Reached position_;  // from the lowest corner's rest place (m)
  Determinant mean_;
  std::array<Determinant, kCorners> squeezed_;  // where the barrier rises, the first of them
  int squeezed_count_ = 0;
  std::optional<FillLaw> fill_law_;                 // none: the cell is full
  double invariant_ = 3.0;                          // I1
  Reached invariant_slope_;                         // (1/2) dI1/dx (1/m)
  std::array<double, kMostReached> invariant_own_;  // of invariantPairs, each with itself
  // E / h^3 without the barrier is a function of J and I1, all Pa: a is twice its derivative by I1,
  // cross_slope_ that of a by J, steepness_ four times the second derivative by I1.
  double a_ = 0.0;
  double cross_slope_ = 0.0;
  double steepness_ = 0.0;
  Curve volume_term_;  // as a function of J at constant I1
  std::optional<Damping> damping_;
};

}  // namespace robot_tissue
