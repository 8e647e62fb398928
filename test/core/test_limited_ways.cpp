// Solves that end where a vertex went as far as it may at once.
#include <gtest/gtest.h>

#include "tissue_fixtures.h"

namespace robot_tissue::test_limited_ways {
namespace {

constexpr double kSpacing = 0.01;

TissueConfig softBlock() {
  TissueConfig config = withFixedBottom(blockOf(4, 4, 3, kSpacing));
  config.model = "elastic";
  config.material.poisson_ratio = 0.4;
  return config;
}

class ShortWays : public ContactUpdate {
 public:
  explicit ShortWays(const Tissue& tissue) : tissue_(tissue) {}

  std::vector<double> longestWays() override {
    return std::vector<double>(tissue_.vertices().size(), 0.02 * kSpacing);
  }
  double shareOfWay(const std::vector<Vec3>&) override { return 1.0; }
  bool renew(std::vector<LoadingPatch>&, Shape shape, Round) override {
    ++solves;
    solved += shape == Shape::kSolved ? 1 : 0;
    return shape != Shape::kSolved;
  }

  int solves = 0, solved = 0;

 private:
  const Tissue& tissue_;
};

// A solve ends where a vertex went farther than it may, and the next goes on from there.
TEST(LimitedWays, TakeMoreSolvesToTheSameShape) {
  Tissue free(softBlock(), SolverConfig()), limited(softBlock(), SolverConfig());
  ShortWays ways(limited);
  limited.setContactUpdate(&ways);
  const Box top{Vec3(-1.0, -1.0, 0.03 - 1e-6), Vec3(1.0, 1.0, 1.0)};
  const LoadStep load = loadOf({displacedPatch("top", top, Vec3(0.2 * kSpacing, 0.0, 0.0))}, 1);
  free.load(load);
  limited.load(load);
  EXPECT_GT(ways.solves, 2);
  EXPECT_EQ(ways.solved, 2) << "as the load begins, and when it has come";
  EXPECT_EQ(limited.lastReport().status, SolveStatus::kOk);
  for (std::size_t node = 0; node < free.state().displacement.size(); ++node) {
    const Vec3 off = limited.state().displacement[node] - free.state().displacement[node];
    EXPECT_LT(off.norm(), 0.02 * 0.2 * kSpacing);
  }
}

}  // namespace
}  // namespace robot_tissue::test_limited_ways
