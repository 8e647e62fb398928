// How much of a cell is filled, and where (own): volume, centroid and second moments of the region
// of it that holds material. A mesh's surface fills cells in part, and a cut leaves parts of cells.
//
// Lengths are in spacings h from the cell's middle: a cell reaches from -1/2 to 1/2 along each
// axis. Corner c sits at its high end along axis a where bit a of c is set.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A full cell by default.
struct CellFill {
  double share = 1.0;  // of h^3, in (0, 1]
  Vec3 centroid = Vec3::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Identity() / 12.0;  // p_ab = mean of x_a x_b
  double triple = 0.0;                                            // mean of x_0 x_1 x_2
  Vec3 spread = Vec3::Constant(1.0 / 12.0);  // eigenvalues of the covariance, ascending
  double lent = 0.0;  // least of what it counts as spread across itself (core/lattice/slivers.h)
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // its eigenvectors, in columns
  // Of a layer that fixed nodes beyond it hold (core/lattice/held_layers.h): the cell's side where
  // they are (number 2 a is down axis a, 2 a + 1 up), else -1, and its thickness.
  int held_side = -1;
  double thickness = 1.0;

  Eigen::Matrix3d covariance() const;
  // How far it reaches to both sides of its centroid along the unit direction, as a layer with its
  // variance there.
  double reachAlong(const Vec3& direction) const;
  bool isHeldAcross(int axis) const { return held_side >= 0 && held_side / 2 == axis; }
  double firmness() const { return 1.0 / (thickness * thickness); }  // of its material's stiffness
  // Mean of the corner's trilinear shape function over the fill, which is its part of the cell's
  // mass. 1 in sum over the corners.
  double cornerShare(int corner) const;
};

// The same as integrals over a region, which add up over regions that do not overlap.
struct FillIntegrals {
  double volume = 0.0;  // of h^3
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double triple = 0.0;

  // A small volume at a point: quadrature points of a region make its integrals.
  void add(const Vec3& point, double with_volume);
  FillIntegrals& operator+=(const FillIntegrals& other);
  FillIntegrals scaledBy(double factor) const;
};

FillIntegrals integralsOf(const CellFill& fill);
CellFill fillOf(const FillIntegrals& integrals);  // of a volume above 0
// Of the eighths of a cell at the corners whose bits are set.
FillIntegrals octantIntegrals(std::uint8_t corners);

}  // namespace robot_tissue
