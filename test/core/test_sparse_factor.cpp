// Eigen's factorization, which everyone has, and the one that this program took, which may be
// CHOLMOD's.
#include <gtest/gtest.h>

#include "elastic_fixtures.h"
#include "solvers/newton/sparse_factor.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_sparse_factor {
namespace {

// Of a chain of springs between `size` unknowns, its ends held by `hold`; lower triangle.
Eigen::SparseMatrix<double> chain(int size, double hold) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    entries.emplace_back(i, i, i == 0 || i + 1 == size ? 1.0 + hold : 2.0);
    if (i > 0) entries.emplace_back(i, i - 1, -1.0);
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

SparseFactorMaker programsMaker() {
  const SparseFactorMaker maker = setSparseFactorMaker(&makeEigenFactor);
  setSparseFactorMaker(maker);
  return maker;
}

class EachFactor : public testing::TestWithParam<SparseFactorMaker> {};

TEST_P(EachFactor, SolvesAndRefusesWhatIsNotPositiveDefinite) {
  constexpr int kSize = 50;
  const auto factor = GetParam()();
  factor->analyze(chain(kSize, 1.0));
  for (const double hold : {1.0, 3.0}) {
    ASSERT_TRUE(factor->factorize(chain(kSize, hold)));
    const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(kSize, -1.0, 2.0);
    const Eigen::SparseMatrix<double> lower = chain(kSize, hold);
    const Eigen::VectorXd force = lower.selfadjointView<Eigen::Lower>() * expected;
    const Eigen::VectorXd solution = factor->solve(force);
    EXPECT_LT((solution - expected).norm(), 1e-12 * expected.norm());
    EXPECT_EQ(solution, factor->solve(force));
  }
  EXPECT_FALSE(factor->factorize(chain(kSize, -2.0)));
  EXPECT_TRUE(factor->factorize(chain(kSize, 1.0)));
}

// A block of 5 x 5 x 3 nodes under a punch, pressed twice; the same to the last bit.
LatticeState pressed(SparseFactorMaker maker) {
  const SparseFactorMaker programs = setSparseFactorMaker(maker);
  const TissueConfig config = withFixedBottom(elasticBlockOf(4, 4, 2, 0.45));
  ElasticBlock block(config), again(config);
  setSparseFactorMaker(programs);
  const LoadingPatch punch =
      displaced(block.lattice.nodesIn(nodeBox(config, {1, 1, 2}, {3, 3, 2})), {0.001, 0, -0.004});
  for (ElasticBlock* one : {&block, &again}) {
    EXPECT_EQ(one->solve({punch}).status, SolveStatus::kOk);
  }
  EXPECT_EQ(block.state.displacement, again.state.displacement);
  return block.state;
}

TEST_P(EachFactor, GivesNewtonTheSameShape) {
  const LatticeState one = pressed(GetParam()), other = pressed(&makeEigenFactor);
  for (std::size_t node = 0; node < one.displacement.size(); ++node) {
    EXPECT_LT((one.displacement[node] - other.displacement[node]).norm(), 1e-12);  // m
  }
}

INSTANTIATE_TEST_SUITE_P(Maker, EachFactor, testing::Values(&makeEigenFactor, programsMaker()),
                         [](const testing::TestParamInfo<SparseFactorMaker>& one) {
                           return std::string(one.index == 0 ? "Eigen" : "Programs");
                         });

}  // namespace
}  // namespace robot_tissue::test_sparse_factor
