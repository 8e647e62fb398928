// A symmetric matrix of blocks of 3 x 3, one for each pair of nodes that have something in common.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <utility>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

class NodeBlocks {
 public:
  NodeBlocks() = default;
  // Zero, with a place for each of these pairs (row, column), in any order, and for (i, i).
  NodeBlocks(int rows, std::vector<std::pair<int, int>> pairs);

  // Below the rows that there are, one with these columns, ascending, and what `blocks` has there.
  void addRow(const std::vector<int>& columns, const std::vector<Eigen::Matrix3d>& blocks);

  int rows() const { return static_cast<int>(first_.size()) - 1; }
  int first(int row) const { return first_[at(row)]; }  // place of the row's first block
  int last(int row) const { return first_[at(row) + 1]; }
  int column(int place) const { return column_[at(place)]; }
  int place(int row, int column) const;  // of a pair that there is
  const Eigen::Matrix3d& block(int place) const { return blocks_[at(place)]; }
  Eigen::Matrix3d& block(int place) { return blocks_[at(place)]; }
  const Eigen::Matrix3d& diagonal(int row) const { return block(place(row, row)); }

  void clear();
  void operator*=(double factor);
  std::vector<Vec3> times(const std::vector<Vec3>& vectors) const;

 private:
  std::vector<int> first_ = {0};
  std::vector<int> column_;
  // And one more: vector instructions read beyond the last one.
  std::vector<Eigen::Matrix3d> blocks_ = {Eigen::Matrix3d::Zero()};
};

// The greatest eigenvalue of D^-1 K, K the matrix and D its blocks on the diagonal, from below, by
// so many steps of the power method from `start`, which is left at its eigenvector.
using TimesVectors = std::function<std::vector<Vec3>(const std::vector<Vec3>&)>;
double greatestOverDiagonal(const TimesVectors& times, const std::vector<Eigen::Matrix3d>& diagonal,
                            int steps, std::vector<Vec3>& start);

}  // namespace robot_tissue
