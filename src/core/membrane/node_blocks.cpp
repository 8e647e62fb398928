#include "membrane/node_blocks.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "membrane/row_kernel.h"

namespace robot_tissue {
namespace {

// Of a block's trace (1): added to a diagonal block that may have no stiffness along some
// direction, before it is inverted. Rounding.
constexpr double kSomeStiffness = 1e-9;

}  // namespace

NodeBlocks::NodeBlocks(int rows, std::vector<std::pair<int, int>> pairs) {
  for (int row = 0; row < rows; ++row) pairs.emplace_back(row, row);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  first_.assign(at(rows) + 1, 0);
  for (const auto& [row, column] : pairs) {
    ++first_[at(row) + 1];
    column_.push_back(column);
  }
  for (int row = 0; row < rows; ++row) first_[at(row) + 1] += first_[at(row)];
  clear();
}

void NodeBlocks::addRow(const std::vector<int>& columns,
                        const std::vector<Eigen::Matrix3d>& blocks) {
  for (const int column : columns) {
    column_.push_back(column);
    blocks_.back() = blocks[at(column)];
    blocks_.emplace_back(Eigen::Matrix3d::Zero());
  }
  first_.push_back(static_cast<int>(column_.size()));
}

void NodeBlocks::clear() { blocks_.assign(column_.size() + 1, Eigen::Matrix3d::Zero()); }

void NodeBlocks::operator*=(double factor) {
  for (Eigen::Matrix3d& block : blocks_) block *= factor;
}

int NodeBlocks::place(int row, int column) const {
  const auto begin = column_.begin() + first(row), end = column_.begin() + last(row);
  return static_cast<int>(std::lower_bound(begin, end, column) - column_.begin());
}

std::vector<Vec3> NodeBlocks::times(const std::vector<Vec3>& vectors) const {
  std::vector<Vec3> product(at(rows()));
  sumBlocks(first_.data(), column_.data(), blocks_.front().data(), rows(), padded(vectors).data(),
            product.data());
  return product;
}

double greatestOverDiagonal(const TimesVectors& times, const std::vector<Eigen::Matrix3d>& diagonal,
                            int steps, std::vector<Vec3>& start) {
  std::vector<Eigen::Matrix3d> regular, inverse;
  for (const Eigen::Matrix3d& own : diagonal) {
    const double some = own.trace() > 0.0 ? kSomeStiffness * own.trace() : 1.0;
    regular.emplace_back(own + some * Eigen::Matrix3d::Identity());
    inverse.emplace_back(regular.back().inverse());
  }
  double greatest = 0.0;
  for (int step = 0; step < steps; ++step) {
    const std::vector<Vec3> product = times(start);
    double length = 0.0, work = 0.0;
    for (std::size_t row = 0; row < start.size(); ++row) {
      length += start[row].dot(regular[row] * start[row]);
      work += start[row].dot(product[row]);
      start[row] = inverse[row] * product[row];
    }
    if (!(length > 0.0)) break;
    greatest = std::max(greatest, work / length);
    for (Vec3& vector : start) vector /= greatest > 0.0 ? greatest : 1.0;
  }
  return greatest;
}

}  // namespace robot_tissue
