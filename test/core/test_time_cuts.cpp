// Tissue in time that is cut and removed while it moves, and that creeps: against what mechanics
// says of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tissue_fixtures.h"

namespace robot_tissue::test_time_cuts {
namespace {

constexpr double kGravity = 9.81;  // m/s^2
constexpr double kSpacing = 0.01;  // m

SolverConfig solverOf(const std::string& method, double tolerance) {
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = tolerance;
  return solver;
}

TissueConfig inTime(TissueConfig config, double damping_time) {
  config.model = "elastic";
  config.material.poisson_ratio = 0.4;
  config.time = TimeConfig{damping_time};
  return config;
}

double farthestOff(const std::vector<Vec3>& displacement) {
  double farthest = 0.0;
  for (const Vec3& moved : displacement) farthest = std::max(farthest, moved.norm());
  return farthest;
}

// The right half falls freely when it is cut across, behind the gap that parts it from the left
// one: both of its parts fall on.
TEST(CutsInTime, LeaveEachPartItsVelocity) {
  TissueConfig config = inTime(blockOf(10, 4, 4, kSpacing), 0.002);
  config.material.young_modulus = 5e4;
  config.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(0.051, 1.0, 1.0)});
  config.gravity = Vec3(0.0, 0.0, -kGravity);
  Tissue tissue(config, solverOf("layered", 0.001));
  tissue.cut(
      {{0.055, -0.01, -0.01}, {0.055, 0.05, -0.01}, {0.055, 0.05, 0.06}, {0.055, -0.01, 0.06}});
  ASSERT_EQ(tissue.state().pieces, 2);
  const auto fallOf = [&](std::size_t piece) -> Vec3 {
    return tissue.pieces()[piece].center - tissue.restingPieces()[piece].center;
  };
  for (int step = 0; step < 5; ++step) ASSERT_EQ(tissue.wait(0.02).status, SolveStatus::kOk);
  const double fallen = 0.5 * kGravity * 0.1 * 0.1;
  EXPECT_NEAR(fallOf(1).z(), -fallen, 1e-6 * fallen);
  const double low = 0.025 - fallen;
  tissue.cut({{0.03, -1.0, low}, {0.2, -1.0, low}, {0.2, 1.0, low}, {0.03, 1.0, low}});
  ASSERT_GE(tissue.state().pieces, 3);
  for (int step = 0; step < 10; ++step) ASSERT_EQ(tissue.wait(0.005).status, SolveStatus::kOk);
  const double at_last = 0.5 * kGravity * 0.15 * 0.15;
  const std::vector<TissuePiece> pieces = tissue.pieces();
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    if (pieces[piece].fixed) continue;
    EXPECT_LT((fallOf(piece) - Vec3(0.0, 0.0, -at_last)).norm(), 1e-5 * at_last) << piece;
  }
}

// What stood in for nodes beside the cut goes with the tissue that had it.
TEST(CutsInTime, LetWhatIsLeftComeToRest) {
  TissueConfig config = inTime(blockOf(20, 4, 4, kSpacing), 0.05);
  config.material.young_modulus = 2e4;
  config.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)});
  Tissue tissue(config, solverOf("layered", 0.01));
  const Box tip{Vec3(0.2, 0.0, 0.0), Vec3(0.2, 0.04, 0.04)};
  tissue.load(loadOf({displacedPatch("tip", tip, Vec3(0.0, 0.0, -0.03))}));
  tissue.release({"tip"});
  tissue.wait(0.02);
  tissue.cut(
      {{0.105, -0.01, 0.021}, {0.105, 0.05, 0.021}, {0.105, 0.05, 0.06}, {0.105, -0.01, 0.06}});
  tissue.wait(0.02);
  tissue.remove(PlacedBox{Box(Vec3(0.08, -1.0, -1.0), Vec3(1.0, 1.0, 1.0))});
  for (int second = 0; second < 6 && tissue.isMoving(); ++second) tissue.wait(1.0);
  EXPECT_FALSE(tissue.isMoving());
  EXPECT_LT(farthestOff(tissue.state().displacement), 1e-3 * kSpacing);
}

// A load and a settle are at rest also where there is time: all that tears does so at once.
TEST(TearsInTime, OfALoadAreThoseWithoutTime) {
  TissueConfig config = blockOf(5, 3, 2, kSpacing);
  config.model = "elastic";
  config.material.poisson_ratio = 0.4;
  config.material.tear_stretch = 1.2;
  config.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, 1e-6)});
  PatchConfig patch;
  patch.name = "pull";
  patch.box = {Vec3(-1.0, -1.0, 0.019), Vec3(0.011, 0.021, 1.0)};
  patch.displacement = {{0.002, 0.0, 0.004}};
  const auto torn = [&](const TissueConfig& tissue_config) {
    Tissue tissue(tissue_config, solverOf("layered", 0.01));
    tissue.load({1, {patch}});
    const int by_load = tissue.springsTorn();
    tissue.settle();
    EXPECT_EQ(tissue.springsTorn(), by_load);
    return by_load;
  };
  const int without_time = torn(config);
  EXPECT_GT(without_time, 1);
  config.time = TimeConfig{0.001};
  EXPECT_EQ(torn(config), without_time);
}

// With a damping of 100 s the block creeps for minutes to where it stands without time.
TEST(CreepInTime, EndsInBalance) {
  TissueConfig config = withFixedBottom(blockOf(4, 4, 4, kSpacing));
  config.material.young_modulus = 5e3;
  config.gravity = Vec3(0.0, 0.0, -kGravity);
  Tissue creeping(inTime(config, 100.0), solverOf("layered", 0.01));
  for (int step = 0; step < 10; ++step) creeping.wait(100.0);
  config.model = "elastic";
  config.material.poisson_ratio = 0.4;
  Tissue still(config, solverOf("layered", 0.001));
  still.settle();
  double off = 0.0;
  for (std::size_t node = 0; node < still.state().displacement.size(); ++node) {
    off = std::max(off,
                   (still.state().displacement[node] - creeping.state().displacement[node]).norm());
  }
  EXPECT_LT(off, 0.02 * farthestOff(still.state().displacement));
}

}  // namespace
}  // namespace robot_tissue::test_time_cuts
