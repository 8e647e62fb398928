#include "solvers/multigrid/level/skyline_cholesky.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace robot_tissue {
namespace {

using Values = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

void SkylineCholesky::reset(std::vector<int> first) {
  first_ = std::move(first);
  start_.clear();
  std::ptrdiff_t end = 0;
  for (int row = 0; row < rows(); ++row) {
    start_.push_back(end);
    end += row + 1 - first_[static_cast<std::size_t>(row)];
  }
  values_.assign(static_cast<std::size_t>(end), 0.0);
}

double SkylineCholesky::workOf(const std::vector<int>& first) {
  double work = 0.0;
  for (std::size_t row = 0; row < first.size(); ++row) {
    const double length = static_cast<double>(row) + 1.0 - first[row];
    work += length * length;
  }
  return work;
}

void SkylineCholesky::factorize() {
  for (int row = 0; row < rows(); ++row) {
    const int first = first_[static_cast<std::size_t>(row)];
    double* values = rowOf(row);
    for (int column = first; column <= row; ++column) {
      const double* other = rowOf(column);
      const int begin = std::max(first, first_[static_cast<std::size_t>(column)]);
      const Eigen::Index length = column - begin;
      const double left =
          values[column] - Values(values + begin, length).dot(Values(other + begin, length));
      values[column] = column < row ? left / other[column] : std::sqrt(left);
    }
  }
}

void SkylineCholesky::solve(Eigen::VectorXd& vector) const {
  for (int row = 0; row < rows(); ++row) {
    const int first = first_[static_cast<std::size_t>(row)];
    const double* values = rowOf(row);
    vector[row] -= Values(values + first, row - first).dot(vector.segment(first, row - first));
    vector[row] /= values[row];
  }
  for (int row = rows() - 1; row >= 0; --row) {
    const int first = first_[static_cast<std::size_t>(row)];
    const double* values = rowOf(row);
    vector[row] /= values[row];
    vector.segment(first, row - first) -= vector[row] * Values(values + first, row - first);
  }
}

}  // namespace robot_tissue
