// A press by most of a block's height: in one go the shape is that of the way there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "robot_tissue/core/tissue.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_deep_press {
namespace {

constexpr double kTolerance = 0.01;
constexpr double kOverTolerance = 2.0;  // two shapes, each within it

struct DeepPress {
  double poisson_ratio;
  double depth;  // m, of 50 mm
};

class DeepPresses : public ::testing::TestWithParam<DeepPress> {};

// A punch of 20 mm on a block of 100 x 100 x 50 mm at 5 mm.
std::vector<Vec3> shapeOf(const DeepPress& press, int increments, double tolerance = kTolerance) {
  TissueConfig config;
  config.shape.max() = Vec3(0.1, 0.1, 0.05);
  config.spacing = 0.005;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = press.poisson_ratio;
  config.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  SolverConfig solver;
  solver.tolerance = tolerance;
  Tissue tissue(config, solver);
  const Box punch{Vec3(0.04, 0.04, 0.05), Vec3(0.06, 0.06, 0.05)};
  tissue.load(loadOf({displacedPatch("punch", punch, Vec3(0.0, 0.0, -press.depth))}, increments),
              [&](int, int, const SolveReport& report) {
                EXPECT_EQ(report.status, SolveStatus::kOk);
                EXPECT_LE(report.error_estimate, tolerance);
              });
  return tissue.state().displacement;
}

TEST_P(DeepPresses, AreTheSameInOneGoAsInMany) {
  const std::vector<Vec3> at_once = shapeOf(GetParam(), 1), by_parts = shapeOf(GetParam(), 20);
  double apart = 0.0, whole = 0.0;
  for (std::size_t node = 0; node < by_parts.size(); ++node) {
    apart += (at_once[node] - by_parts[node]).squaredNorm();
    whole += by_parts[node].squaredNorm();
  }
  EXPECT_LE(std::sqrt(apart / whole), kOverTolerance * kTolerance);
}

// There the block is about to buckle: rounding in single precision is more than the tolerance.
TEST(DeepPress, ComesToBalanceWhereTissueIsAboutToBuckle) {
  const std::vector<Vec3> shape = shapeOf({0.49, 0.04}, 1, 0.002);
  double lowest = 0.0;
  for (const Vec3& moved : shape) lowest = std::min(lowest, moved.z());
  EXPECT_LE(lowest, -0.04);  // the patch, or its rim's nodes, that slip under it
  EXPECT_GT(lowest, -0.05);
}

INSTANTIATE_TEST_SUITE_P(Layered, DeepPresses,
                         ::testing::Values(DeepPress{0.45, 0.035}, DeepPress{0.49, 0.035}));

}  // namespace
}  // namespace robot_tissue::test_deep_press
