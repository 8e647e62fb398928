// How a cell of model `elastic` that is filled in part deforms (doc/model.md, "Cells filled in
// part"). With x the displacement as a function of the place in the cell (in h from its middle),
// averaged over the fill:
//
//   F e_a = mean of dx/dx_a,   q_ab = d2x/dx_a dx_b at the centroid,   q_abc = d3x/dx_a dx_b dx_c
//   I1 = sum |F e_a|^2 + sum over i, j of W_ij |q_ij|^2 + sum of W_aa |d_a|^2 + w_abc |q_abc|^2
//
// i and j are the fill's own axes, the eigenvectors of its covariance.
//
// A trilinear cell has no q_aa: those are of the cell and its two neighbors along the axis
// (CellReach), q_aa their mean and d_a half their difference, and F e_a is taken where the fill's
// centroid is. A pair of axes has the number of the axis that it leaves out.
#pragma once

#include <Eigen/Core>
#include <array>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// q_00, q_11, q_22, q_12, q_02, q_01, of vectors.
constexpr int kSecond = 6;
using SecondSlopes = Eigen::Matrix<double, kSecond, 1>;
using SecondWeights = Eigen::Matrix<double, kSecond, kSecond>;

struct FillLaw {
  Vec3 centroid;          // h
  Vec3 pairs;             // mean products p_ab (h^2)
  SecondWeights bending;  // W_ij by the grid's axes
  double twisting = 0.0;  // w_abc
  // A box with the fill's centroid and variances, as far as it is in the cell (h): at its corners,
  // so where the material is, the barrier rises. Of a full cell the cell.
  Vec3 low, high;
};

// Of a full cell W_ij = 1/12, w_abc = 1/48, and there are no q_aa. `bulk_by_shear`: the material's
// moduli.
FillLaw fillLaw(const CellFill& fill, double bulk_by_shear);

// What the displacement of a corner, or of a node that the cell reaches (reachedNodes), adds to
// F e_a, q_aa, q_ab, d_a and q_abc (1).
struct CornerSlopes {
  Vec3 strain = Vec3::Zero();
  SecondSlopes bending = SecondSlopes::Zero();
  Vec3 uneven = Vec3::Zero();
  double twisting = 0.0;
};
std::array<CornerSlopes, kMostReached> cornerSlopes(const CellFill& fill, const CellReach* reach);
// Half the second derivative of I1 in the displacements of two corners, times h^2.
double invariantBetween(const FillLaw& law, const CornerSlopes& a, const CornerSlopes& b);

}  // namespace robot_tissue
