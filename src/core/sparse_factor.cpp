#include "robot_tissue/core/sparse_factor.h"

#include <Eigen/CholmodSupport>

// Of OpenBLAS, which CHOLMOD may call as its BLAS; null with another one.
extern "C" void openblas_set_num_threads(int count) __attribute__((weak));

namespace robot_tissue {

struct SparseFactor::Library {
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholesky;
};

SparseFactor::SparseFactor() : library_(std::make_unique<Library>()) {
  library_->cholesky.cholmod().print = 0;  // a matrix that is not positive definite is no news
  // Its threads wait in a busy loop, for longer than our small fronts take, and split sums in a way
  // that depends on their number.
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
}

SparseFactor::~SparseFactor() = default;

void SparseFactor::analyze(const Eigen::SparseMatrix<double>& matrix) {
  library_->cholesky.analyzePattern(matrix);
}

bool SparseFactor::factorize(const Eigen::SparseMatrix<double>& matrix) {
  library_->cholesky.factorize(matrix);
  return library_->cholesky.info() == Eigen::Success;
}

Eigen::VectorXd SparseFactor::solve(const Eigen::VectorXd& right_hand_side) const {
  return library_->cholesky.solve(right_hand_side);
}

}  // namespace robot_tissue
