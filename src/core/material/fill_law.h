// How a cell of model `elastic` that is filled in part deforms (doc/model.md, "Cells filled in
// part"). With x the displacement as a function of the place in the cell (in h from its middle),
// averaged over the fill:
//
//   F e_a = mean of dx/dx_a,   q_ab = d2x/dx_a dx_b at the centroid,   q_abc = d3x/dx_a dx_b dx_c
//   I1 = sum |F e_a|^2 + sum over pairs w_ab |q_ab|^2 + w_abc |q_abc|^2
//
// A pair of axes has the number of the axis that it leaves out.
#pragma once

#include <array>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct FillLaw {
  Vec3 centroid;          // h
  Vec3 pairs;             // mean products p_ab (h^2), times `places`
  Vec3 places;            // where each F e_a is taken, CellFill::strain_places
  Vec3 bending;           // w_ab
  double twisting = 0.0;  // w_abc
  // A box with the fill's centroid and variances, as far as it is in the cell (h): at its corners,
  // so where the material is, the barrier rises. Of a full cell the cell.
  Vec3 low, high;
};

// Of a full cell 1/6 and 1/48.
FillLaw fillLaw(const CellFill& fill);

// What a corner's displacement adds to F e_a, q_ab and q_abc (1).
struct CornerSlopes {
  Vec3 strain;
  Vec3 bending;
  double twisting = 0.0;
};
std::array<CornerSlopes, kCorners> cornerSlopes(const FillLaw& law);
// Half the second derivative of I1 in the displacements of two corners, times h^2.
double invariantBetween(const FillLaw& law, const CornerSlopes& a, const CornerSlopes& b);

}  // namespace robot_tissue
