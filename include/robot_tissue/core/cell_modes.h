// The lean way through the cells of model `elastic` (core/elastic_cell.h), for methods that move
// one node at a time: what the cells that meet at a node do to it, all of them in one pass.
//
// Seen from that node, a cell's corners are k = 0 .. 7 (bits of k: axes; the node is 0), and the
// modes of the trilinear cell are M_s = sum over k of (-1)^(bits in both k and s) x_k. Then (own)
//
//   F e_a = -+ M_a / 4h,   I1 = sum over s of w_s |M_s|^2 / 16h^2
//
// with w_s = 1, 2/3, 1/3 for modes of one, two, three axes. The numbers are ElasticCell's.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/material.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class CellModes {
 public:
  explicit CellModes(double spacing) : spacing_(spacing) {}

  // At most 8 cells, each with the corner that it is seen from.
  void add(const Moduli& moduli, const std::array<int, kCorners>& nodes, int corner,
           const std::vector<Vec3>& displacement);
  void solve();

  // False where the barrier may rise or the cell is pressed flat: there ask ElasticCell.
  bool suffices(int cell) const { return lean_[cell]; }

  // Of the energy in the node, from the cells that the modes suffice for.
  Vec3 gradient() const { return gradient_; }                // N
  const Eigen::Matrix3d& block() const { return block_; }  // N/m

 private:
  static constexpr int kCells = 8;

  void transform();
  bool hasSqueezedCorner(int cell) const;

  double spacing_;
  int count_ = 0;
  // Everything a cell: the lanes of vector instructions.
  double mode_[kCorners][3][kCells] = {};  // x_k, then M_s, over 4h
  double shear_[kCells] = {};              // Pa
  double bulk_[kCells] = {};               // Pa
  double side_[3][kCells] = {};            // at rest M_a / 4h is this along a
  bool lean_[kCells] = {};
  Vec3 gradient_ = Vec3::Zero();
  Eigen::Matrix3d block_ = Eigen::Matrix3d::Zero();
};

}  // namespace robot_tissue
