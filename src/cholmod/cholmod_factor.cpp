#include "cholmod_factor.h"

#include <Eigen/CholmodSupport>

// Of OpenBLAS, which CHOLMOD may call as its BLAS; null with another one.
extern "C" void openblas_set_num_threads(int count) __attribute__((weak));
// Of OpenMP, which CHOLMOD may be built with.
extern "C" int omp_get_max_active_levels(void) __attribute__((weak));
extern "C" void omp_set_max_active_levels(int levels) __attribute__((weak));

namespace robot_tissue {
namespace {

// CHOLMOD's threads wait in a busy loop, too, and it does not ask how many it may start: while this
// lives, OpenMP starts none.
class OneThread {
 public:
  OneThread() {
    if (omp_set_max_active_levels == nullptr || omp_get_max_active_levels == nullptr) return;
    levels_ = omp_get_max_active_levels();
    omp_set_max_active_levels(0);
  }
  ~OneThread() {
    if (levels_ >= 0) omp_set_max_active_levels(levels_);
  }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_ = -1;
};

class CholmodFactor : public SparseFactor {
 public:
  CholmodFactor() {
    cholesky_.cholmod().print = 0;  // a matrix that is not positive definite is no news
    // Its threads wait in a busy loop, for longer than our small fronts take, and split sums in a
    // way that depends on their number.
    if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  }
  void analyze(const Eigen::SparseMatrix<double>& matrix) override {
    cholesky_.analyzePattern(matrix);
  }
  bool factorize(const Eigen::SparseMatrix<double>& matrix) override {
    const OneThread one_thread;
    cholesky_.factorize(matrix);
    return cholesky_.info() == Eigen::Success;
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const override {
    const OneThread one_thread;
    return cholesky_.solve(right_hand_side);
  }

 private:
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholesky_;
};

}  // namespace

std::unique_ptr<SparseFactor> makeCholmodFactor() { return std::make_unique<CholmodFactor>(); }

}  // namespace robot_tissue
