// Loads that nothing answers, or that surgery took nodes from; sutures that tear what they draw.
#include <gtest/gtest.h>

#include <cmath>

#include "tissue_fixtures.h"

namespace robot_tissue::test_loads_and_surgery {
namespace {

constexpr double kSpacing = 0.01;  // m

TissueConfig block(int x, int y, int z, double poisson_ratio, double spacing = kSpacing) {
  TissueConfig config = withFixedBottom(blockOf(x, y, z, spacing));
  config.model = "elastic";
  config.material.poisson_ratio = poisson_ratio;
  return config;
}

TEST(LoadsOfNoForce, AreInBalanceBesideOthers) {
  const TissueConfig config = block(6, 6, 3, 0.45);
  Tissue tissue(config, {});
  const Box corner = nodeBox(config, {0, 0, 3}, {1, 1, 3});
  for (const SolveReport& report :
       reportsOf(tissue, loadOf({forcedPatch("q", corner, Vec3::Zero())}, 1))) {
    EXPECT_EQ(report.status, SolveStatus::kOk);
  }
  const Box middle = nodeBox(config, {2, 2, 3}, {4, 4, 3});
  const LoadStep pressed = loadOf({displacedPatch("p", middle, Vec3(0.0, 0.0, -0.001))}, 1);
  for (const SolveReport& report : reportsOf(tissue, pressed)) {
    EXPECT_EQ(report.status, SolveStatus::kOk);
    EXPECT_LT(report.iterations, 50);
  }
  EXPECT_LT(tissue.answerOf("q", tissue.lastReport()).force.norm(),
            1e-4 * tissue.answerOf("p", tissue.lastReport()).force.norm());
}

TEST(LoadsOfNoForce, LetGoWhatAnotherForcePulled) {
  const TissueConfig config = block(6, 6, 3, 0.45);
  Tissue tissue(config, {});
  const Box corner = nodeBox(config, {0, 0, 3}, {1, 1, 3});
  tissue.load(loadOf({forcedPatch("q", corner, Vec3(0.0, 0.0, -0.1))}));
  ASSERT_TRUE(isDeformed(tissue));
  tissue.load(loadOf({forcedPatch("q", corner, Vec3::Zero())}));
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  EXPECT_FALSE(isDeformed(tissue));
}

// 1 MN on tissue of 1 kPa goes too far in the shortest of increments: that is taken, and time ends
// the way.
TEST(LoadsBeyondAllForces, EndWithTheirTime) {
  TissueConfig config = block(3, 3, 3, 0.45);
  config.material.young_modulus = 1e3;
  Tissue tissue(config, {});
  tissue.setDeadline(Deadline(0.05));
  const Box top = nodeBox(config, {0, 0, 3}, {3, 3, 3});
  tissue.load(loadOf({forcedPatch("a", top, Vec3(0.0, 0.0, 1e6))}));
  EXPECT_NE(tissue.lastReport().status, SolveStatus::kOk);
  EXPECT_TRUE(tissue.isLoading());
  EXPECT_TRUE(isDeformed(tissue));
}

TEST(LoadsAndRemovals, ALoadThatTurnsGoesOnWithoutWhereALineOfNodesIsLeft) {
  const TissueConfig config = block(10, 10, 5, 0.45);
  Tissue tissue(config, {});
  PatchConfig punch =
      forcedPatch("punch", nodeBox(config, {4, 4, 5}, {6, 6, 5}), Vec3(0.05, 0.0, 0.1));
  punch.turns = true;
  tissue.load(loadOf({punch}));
  tissue.remove(PlacedBox{Box(Vec3(0.0405, -1.0, 0.04), Vec3(1.0, 1.0, 1.0))});
  ASSERT_EQ(nodesOfPatch(tissue, "punch").size(), 3U);
  EXPECT_EQ(tissue.settle().status, SolveStatus::kOk);
  EXPECT_LT((tissue.answerOf("punch", tissue.lastReport()).force - *punch.force).norm(),
            0.02 * punch.force->norm());
}

// Under another load than then an undo gives the cells back, the load by its box takes the nodes.
TEST(LoadsAndRemovals, ALoadHasItsNodesAgainByItsBoxAfterAnUndo) {
  const TissueConfig config = block(8, 6, 4, 0.3);
  Tissue tissue(config, {});
  const auto loadP = [&](double depth) {
    tissue.load(loadOf(
        {displacedPatch("p", nodeBox(config, {3, 2, 4}, {5, 4, 4}), Vec3(0.0, 0.0, -depth))}));
  };
  loadP(0.002);
  const std::vector<int> nodes = nodesOfPatch(tissue, "p");
  tissue.remove(PlacedBox{Box(Vec3(0.04, -1.0, 0.02), Vec3(1.0, 1.0, 1.0))});
  ASSERT_LT(nodesOfPatch(tissue, "p").size(), nodes.size());
  tissue.load(
      loadOf({displacedPatch("q", nodeBox(config, {0, 0, 4}, {1, 1, 4}), Vec3(0.0, 0.0, -0.002))}));
  tissue.undo(1);
  loadP(0.004);
  EXPECT_EQ(nodesOfPatch(tissue, "p"), nodes);
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  const int middle = tissue.lattice().node(4, 3, 4);
  EXPECT_EQ(tissue.state().displacement[at(middle)], Vec3(0.0, 0.0, -0.004));
}

// As if nothing had been removed: the patch is one hard piece again, and turns about its middle.
TEST(LoadsAndRemovals, ALoadThatTurnsIsWholeAgainByItsBoxAfterAnUndo) {
  const TissueConfig config = block(8, 6, 4, 0.3);
  SolverConfig exact;
  exact.method = "newton";
  PatchConfig a = forcedPatch("a", nodeBox(config, {2, 1, 4}, {6, 5, 4}), Vec3(0.0, 0.6, 0.6));
  a.turns = true;
  const LoadStep beside =
      loadOf({displacedPatch("b", nodeBox(config, {0, 0, 4}, {0, 1, 4}), Vec3(0.0, 0.0, -0.001))});
  Tissue whole(config, exact), tissue(config, exact);
  whole.load(loadOf({a}));
  whole.load(beside);
  tissue.load(loadOf({a}));
  tissue.remove(PlacedBox{Box(Vec3(0.045, -1.0, 0.015), Vec3(1.0, 1.0, 1.0))});
  ASSERT_LT(nodesOfPatch(tissue, "a").size(), nodesOfPatch(whole, "a").size());
  tissue.load(beside);
  tissue.undo(1);
  tissue.load(loadOf({a}));
  EXPECT_EQ(nodesOfPatch(tissue, "a"), nodesOfPatch(whole, "a"));
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    const Vec3 off = tissue.state().displacement[at(node)] - whole.state().displacement[at(node)];
    ASSERT_LT(off.norm(), 1e-6) << node;
  }
}

// Of a millionth of a millisecond: a cycle a solve. The patch is of the shape in balance all the
// same, not of the one that it was put on.
TEST(LoadsOnLateShapes, OfAForceAreOfTheShapeInBalance) {
  const TissueConfig config = block(8, 6, 4, 0.3);
  SolverConfig hurried, slow;
  hurried.max_ms = 1e-6;
  hurried.tolerance = slow.tolerance = 1e-4;
  Tissue late(config, hurried), tissue(config, slow);
  PatchConfig b = forcedPatch("b", nodeBox(config, {5, 2, 4}, {7, 5, 4}), Vec3(0.0, 0.1, 0.1));
  b.turns = true;
  const PatchConfig a =
      displacedPatch("a", nodeBox(config, {2, 2, 4}, {4, 5, 4}), Vec3(0.0, 0.0, 0.012));
  for (Tissue* each : {&late, &tissue}) {
    each->load(loadOf({a}, 1));
    EXPECT_EQ(each->isLate(), each == &late);
    each->load(loadOf({b}));
  }
  for (int settles = 0; settles < 500 && late.isLate(); ++settles) late.settle();
  ASSERT_FALSE(late.isLate());
  double off = 0.0, all = 0.0;
  for (std::size_t node = 0; node < tissue.state().displacement.size(); ++node) {
    const Vec3& moved = tissue.state().displacement[node];
    off += (late.state().displacement[node] - moved).squaredNorm();
    all += moved.squaredNorm();
  }
  EXPECT_LT(std::sqrt(off / all), 1e-4);
}

TEST(SuturesThatTear, TearInTheirOwnStep) {
  TissueConfig config = block(20, 10, 6, 0.45, 0.005);
  config.material.tear_stretch = 1.3;
  Tissue tissue(config, {});
  SutureConfig thread;
  thread.name = "s1";
  thread.from = Vec3(0.03, 0.025, 0.03);
  thread.to = Vec3(0.07, 0.025, 0.03);
  tissue.suture(thread);
  const int torn = tissue.springsTorn();
  EXPECT_GT(torn, 0);
  tissue.settle();
  EXPECT_EQ(tissue.springsTorn(), torn);
  ASSERT_EQ(tissue.undoable(), 1);
  tissue.undo(1);
  EXPECT_TRUE(tissue.sutures().empty());
  expectAtRest(tissue);
}

}  // namespace
}  // namespace robot_tissue::test_loads_and_surgery
