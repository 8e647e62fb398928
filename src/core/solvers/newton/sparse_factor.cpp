#include "solvers/newton/sparse_factor.h"

#include <Eigen/SparseCholesky>
#include <new>
#include <utility>

namespace robot_tissue {
namespace {

class EigenFactor : public SparseFactor {
 public:
  void analyze(const Eigen::SparseMatrix<double>& matrix) override {
    fits_ = true;
    whenItFits([&] { cholesky_.analyzePattern(matrix); });
  }
  bool factorize(const Eigen::SparseMatrix<double>& matrix) override {
    whenItFits([&] { cholesky_.factorize(matrix); });
    return fits_ && cholesky_.info() == Eigen::Success;
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const override {
    return cholesky_.solve(right_hand_side);
  }

 private:
  // The factor of some 100,000 nodes has more entries than an int counts.
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Eigen::Index>;

  template <typename Work>
  void whenItFits(const Work& work) {
    try {
      if (fits_) work();
    } catch (const std::bad_alloc&) {
      fits_ = false;
    }
  }

  Eigen::SimplicialLLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<Eigen::Index>> cholesky_;
  bool fits_ = true;  // the memory
};

SparseFactorMaker made_by = &makeEigenFactor;

}  // namespace

std::unique_ptr<SparseFactor> makeEigenFactor() { return std::make_unique<EigenFactor>(); }

std::unique_ptr<SparseFactor> makeSparseFactor() { return made_by(); }

SparseFactorMaker setSparseFactorMaker(SparseFactorMaker maker) {
  return std::exchange(made_by, maker);
}

}  // namespace robot_tissue
