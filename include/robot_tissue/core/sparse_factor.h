// Direct solution of K x = b for a sparse, symmetric, positive definite K.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

namespace robot_tissue {

class SparseFactor {
 public:
  SparseFactor();
  ~SparseFactor();

  // For matrices of this pattern from now on; only the lower triangle is read.
  void analyze(const Eigen::SparseMatrix<double>& matrix);
  // False when the matrix is not positive definite, or too large for the memory.
  bool factorize(const Eigen::SparseMatrix<double>& matrix);
  Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const;

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

}  // namespace robot_tissue
