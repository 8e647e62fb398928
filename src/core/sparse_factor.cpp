#include "robot_tissue/core/sparse_factor.h"

#include <Eigen/CholmodSupport>

namespace robot_tissue {

struct SparseFactor::Library {
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholesky;
};

SparseFactor::SparseFactor() : library_(std::make_unique<Library>()) {
  library_->cholesky.cholmod().print = 0;  // a matrix that is not positive definite is no news
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
