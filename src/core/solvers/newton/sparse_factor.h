// Direct solution of K x = b for a sparse, symmetric, positive definite K.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

namespace robot_tissue {

class SparseFactor {
 public:
  SparseFactor() = default;
  SparseFactor(const SparseFactor&) = delete;
  SparseFactor& operator=(const SparseFactor&) = delete;
  virtual ~SparseFactor() = default;

  // For matrices of this pattern from now on; only the lower triangle is read.
  virtual void analyze(const Eigen::SparseMatrix<double>& matrix) = 0;
  // False when the matrix is not positive definite, or too large for the memory.
  virtual bool factorize(const Eigen::SparseMatrix<double>& matrix) = 0;
  virtual Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const = 0;
};

using SparseFactorMaker = std::unique_ptr<SparseFactor> (*)();

std::unique_ptr<SparseFactor> makeEigenFactor();

// By the maker that the program has set, else Eigen's.
std::unique_ptr<SparseFactor> makeSparseFactor();

// Before solvers are made. Returns the maker until now.
SparseFactorMaker setSparseFactorMaker(SparseFactorMaker maker);

}  // namespace robot_tissue
