// The lean way through the cells of model `elastic` (core/material/elastic_cell.h), up to eight at
// a time: the same numbers, without the barrier.
//
// A cell is seen from one of its corners. From there its corners are k = 0 .. 7 (bits of k: axes,
// itself 0), and the modes of the trilinear cell are M_s = sum over k of (-1)^(bits in k and s)
// x_k. Then (own)
//
//   F e_a = -+ M_a / 4h,   I1 = sum over s of w_s |M_s|^2 / 16h^2
//
// with w_s = 1, 2/3, 1/3 for modes of one, two, three axes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "config/material.h"
#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class CellModes {
 public:
  static constexpr int kMost = 8;

  explicit CellModes(double spacing) : spacing_(spacing) {}

  // A cell that is not full has other means than these modes tell: they do not suffice.
  void add(const Moduli& moduli, const std::array<int, kCorners>& nodes, int corner,
           const std::vector<Vec3>& displacement, bool is_full);
  int count() const { return count_; }
  // When all cells are added.
  void solve();

  // Whether the modes suffice for the cell. False where the barrier may rise or the cell is pressed
  // flat (J < kFlattest), and where it is not full: there ask ElasticCell.
  bool suffices(int cell) const { return lean_[cell]; }

  // Of the energy in the corner that all cells are seen from, a node's. Cells that the modes do not
  // suffice for add nothing.
  Vec3 gradient() const;          // N
  Eigen::Matrix3d block() const;  // N/m

  // Turns the modes into the energy's gradients in the cells' corners, as they are seen (N).
  void findGradients();
  Vec3 gradient(int cell, int k) const {
    return {mode_[k][0][cell], mode_[k][1][cell], mode_[k][2][cell]};
  }

 private:
  // Everything a cell: the lanes of vector instructions.
  using Lanes = double[kMost];

  void transform();
  void measure();
  void stiffen();
  void stiffenByStrain();
  void look();
  bool hasSqueezedCorner(int cell) const;

  double spacing_;
  int count_ = 0;
  Lanes mode_[kCorners][3];  // x_k, then M_s / 4h
  Lanes cofactor_[3][3];     // of F by columns M_a / 4h, then by axes
  Lanes shear_, bulk_;       // Pa
  Lanes exponent_;           // Moduli::stiffening
  bool stiffens_ = false;    // it is not 0 in one
  Lanes side_[3];            // at rest M_a / 4h is this along a
  Lanes hand_;               // product of the sides: the sign of det M_a at rest
  Lanes slight_;             // bound of |G - 1|^2 / 2 of all corners, see kSlight
  Lanes invariant_;          // I1
  Lanes volume_;             // J
  Lanes a_, slope_;          // a and its derivative by J (Pa); see ElasticCell
  Lanes steepness_;          // four times the second derivative of the energy's density by I1 (Pa)
  Lanes pressure_;           // derivative of the energy's density by J (Pa)
  Lanes curvature_;          // derivative of pressure_ by J (Pa)
  Lanes l_[3], c_[3];        // (1/2) dI1/dx and dJ/dx, times 4h, where the cell is seen from
  bool full_[kMost];
  bool lean_[kMost];
};

}  // namespace robot_tissue
