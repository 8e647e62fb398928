// A symmetric, positive definite matrix that is zero before a column of each row, and its Cholesky
// factor, which is zero there too (George and Liu 1981).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace robot_tissue {

class SkylineCholesky {
 public:
  // Zero, with rows that begin at such columns, at most their own.
  void reset(std::vector<int> first);
  // Multiplications that `factorize` takes with such rows, to compare by.
  static double workOf(const std::vector<int>& first);
  int rows() const { return static_cast<int>(first_.size()); }

  // Of the lower triangle, in the envelope, by columns; until `factorize`.
  double* rowOf(int row) { return values_.data() + startOf(row); }

  void factorize();
  // In place, with the factor.
  void solve(Eigen::VectorXd& vector) const;

 private:
  const double* rowOf(int row) const { return values_.data() + startOf(row); }
  // In `values_`, of column 0, were it there.
  std::ptrdiff_t startOf(int row) const {
    const auto index = static_cast<std::size_t>(row);
    return start_[index] - first_[index];
  }

  std::vector<int> first_;
  std::vector<std::ptrdiff_t> start_;  // of rows, in `values_`
  std::vector<double> values_;
};

}  // namespace robot_tissue
