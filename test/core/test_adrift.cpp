// Tissue that given forces move without end, as nothing else holds it; loads and undo of tissue
// that hangs on a load alone.
#include <gtest/gtest.h>

#include "tissue_fixtures.h"

namespace robot_tissue::test_adrift {
namespace {

constexpr double kSpacing = 0.005;    // m
constexpr int kWide = 12, kHigh = 6;  // spacings
const Vec3 kPull(0.0, 0.0, 0.3);      // N

TissueConfig block() {
  TissueConfig config = withFixedBottom(blockOf(kWide, kWide, kHigh, kSpacing));
  config.model = "elastic";
  config.material.poisson_ratio = 0.45;
  return config;
}

Box middleOfTop(const TissueConfig& config) {
  return nodeBox(config, {4, 4, kHigh}, {8, 8, kHigh});
}

// All through, at so many spacings over the bottom.
std::vector<Vec3> planeAt(double height) {
  const double z = height * kSpacing, far = (kWide + 1) * kSpacing;
  return {{-kSpacing, -kSpacing, z}, {far, -kSpacing, z}, {far, far, z}, {-kSpacing, far, z}};
}

double farthest(const Tissue& tissue) {
  double farthest = 0.0;
  for (const Vec3& moved : tissue.state().displacement) farthest = std::max(farthest, moved.norm());
  return farthest;
}

class PieceAdrift : public ::testing::TestWithParam<const char*> {
 protected:
  PieceAdrift() { solver_.method = GetParam(); }

  SolverConfig solver_;
};

// A cut frees what a force pulls at: it stays where it was, and that is told. Held again, the force
// is answered.
TEST_P(PieceAdrift, StaysWhereItWas) {
  const TissueConfig config = block();
  Tissue tissue(config, solver_);
  tissue.load(loadOf({forcedPatch("pull", middleOfTop(config), kPull)}));
  ASSERT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  EXPECT_TRUE(tissue.adriftLoads().empty());
  const double before = farthest(tissue);
  const CutReport report = tissue.cut(planeAt(3.5));
  EXPECT_EQ(report.pieces, 2);
  EXPECT_EQ(report.solve.status, SolveStatus::kUnconverged);
  EXPECT_EQ(tissue.adriftLoads(), std::vector<std::string>{"pull"});
  const PatchAnswer answer = tissue.answerOf("pull", tissue.lastReport());
  EXPECT_TRUE(answer.is_adrift);
  EXPECT_EQ(answer.force, Vec3(Vec3::Zero()));
  EXPECT_LE(farthest(tissue), 1.01 * before);
  EXPECT_LT(tissue.lastReport().iterations, 50);
  const Box corner = nodeBox(config, {0, 0, kHigh}, {1, 1, kHigh});
  tissue.load(loadOf({displacedPatch("hold", corner, Vec3::Zero())}, 1));
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  EXPECT_TRUE(tissue.adriftLoads().empty());
  EXPECT_LT((tissue.answerOf("pull", tissue.lastReport()).force - kPull).norm(),
            0.05 * kPull.norm());
}

INSTANTIATE_TEST_SUITE_P(By, PieceAdrift, ::testing::Values("layered", "newton"));

TEST(PieceAdriftReleased, ComesToRestByASettle) {
  const TissueConfig config = block();
  Tissue tissue(config, {});
  tissue.load(loadOf({forcedPatch("pull", middleOfTop(config), kPull)}));
  tissue.cut(planeAt(3.5));
  tissue.release({"pull"});
  EXPECT_EQ(tissue.settle().status, SolveStatus::kOk);
  EXPECT_TRUE(tissue.adriftLoads().empty());
}

// Two forces that balance hold a piece that floats; a third does not.
TEST(PieceAdriftBetweenForces, IsSolvedForWhereTheyBalance) {
  TissueConfig config = block();
  config.fixed.clear();
  Tissue tissue(config, {});
  const Box low = nodeBox(config, {0, 0, 0}, {kWide, kWide, 0});
  const Box high = nodeBox(config, {0, 0, kHigh}, {kWide, kWide, kHigh});
  tissue.load(loadOf({forcedPatch("low", low, -kPull), forcedPatch("high", high, kPull)}, 1));
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  EXPECT_TRUE(tissue.adriftLoads().empty());
  tissue.load(loadOf({forcedPatch("high", high, 4.0 * kPull)}, 1));
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kUnconverged);
  EXPECT_EQ(tissue.adriftLoads(), (std::vector<std::string>{"low", "high"}));
}

// On its way from the rest shape to that under a load, the load's piece is not let go of.
TEST(PieceOnALoad, IsNotDroppedWhenAnotherLoadIsReleased) {
  TissueConfig config = block();
  config.gravity = Vec3(0.0, 0.0, -1.0);
  config.free_pieces = FreePieces::kDrop;
  Tissue tissue(config, {});
  tissue.settle();
  const Box rim = nodeBox(config, {0, 0, 5}, {0, kWide, kHigh});
  const Box side = nodeBox(config, {kWide, 0, 1}, {kWide, kWide, 2});
  tissue.load(loadOf({displacedPatch("hold", rim, Vec3::Zero())}, 1));
  tissue.load(loadOf({displacedPatch("b", side, Vec3(0.001, 0.0, 0.0))}, 1));
  tissue.cut(planeAt(3.5));
  ASSERT_EQ(tissue.state().pieces, 2);
  tissue.release({"b"});
  EXPECT_TRUE(tissue.droppedPieces().empty());
  EXPECT_FALSE(nodesOfPatch(tissue, "hold").empty());
}

// What a removal took comes back where its surroundings are by then.
TEST(UndoneRemoval, ComesBackWhereTheTissueWent) {
  TissueConfig config = block();
  config.fixed.clear();
  Tissue tissue(config, {});
  const Box low = nodeBox(config, {0, 0, 0}, {kWide, kWide, 0});
  tissue.load(loadOf({displacedPatch("hold", low, Vec3::Zero())}, 1));
  tissue.remove(PlacedBox{Box(Vec3(0.02, 0.02, 0.015), Vec3(0.04, 0.04, 1.0))});
  const Vec3 way(0.02, 0.0, 0.05);
  tissue.load(loadOf({displacedPatch("hold", low, way)}));
  EXPECT_EQ(tissue.undo(1).status, SolveStatus::kOk);
  double off = 0.0;
  for (const Vec3& moved : tissue.state().displacement) {
    off = std::max(off, (moved - way).norm());
  }
  EXPECT_LT(off, 1e-4);
}

// A force that turns its patch acts in the middle of what a removal leaves of it.
TEST(ForceOnPartOfItsNodes, ActsInTheMiddleOfThem) {
  const TissueConfig config = block();
  Tissue tissue(config, {});
  PatchConfig pull = forcedPatch("pull", middleOfTop(config), Vec3(0.05, 0.0, 0.1));
  pull.turns = true;
  tissue.load(loadOf({pull}));
  tissue.remove(PlacedBox{Box(Vec3(0.0301, -1.0, 0.02), Vec3(1.0, 1.0, 1.0))});
  const LoadingPatch& patch = tissue.patches().front();
  Vec3 middle = Vec3::Zero();
  for (const int node : patch.nodes) {
    middle += tissue.lattice().restPosition(node) / static_cast<double>(patch.nodes.size());
  }
  EXPECT_LT(middle.x(), 0.0299);
  EXPECT_LT((patch.center - middle).norm(), 1e-12);
  EXPECT_EQ(tissue.settle().status, SolveStatus::kOk);
  EXPECT_LT((tissue.answerOf("pull", tissue.lastReport()).force - *pull.force).norm(),
            0.02 * pull.force->norm());
}

// Of a load that had no time, and one in increments after it, both go on to their ends.
TEST(LoadsWithoutTime, GoOnToTheirEndsBesideOneAnother) {
  const TissueConfig config = block();
  Tissue tissue(config, {});
  const Box left = nodeBox(config, {1, 4, kHigh}, {4, 8, kHigh});
  const Box right = nodeBox(config, {8, 4, kHigh}, {11, 8, kHigh});
  const Vec3 way(0.0, 0.0, -0.01);
  tissue.setDeadline(Deadline(1e-6));
  tissue.load(loadOf({displacedPatch("a", left, way)}, 3));
  ASSERT_TRUE(tissue.isLoading());
  tissue.load(loadOf({displacedPatch("b", right, way)}, 3));
  tissue.setDeadline(std::nullopt);
  tissue.loadOn();
  EXPECT_FALSE(tissue.isLoading());
  for (const char* name : {"a", "b"}) {
    const Vec3 moved = tissue.answerOf(name, tissue.lastReport()).displacement;
    EXPECT_LT((moved - way).norm(), 1e-9) << name;
  }
}

// What a refused load step leaves to balance is what there was before it.
TEST(ShapesThatComeBack, HaveLeftToBalanceWhatTheyHad) {
  const TissueConfig config = block();
  SolverConfig solver;
  Tissue tissue(config, solver);
  const Box top = nodeBox(config, {0, 0, kHigh}, {kWide, kWide, kHigh});
  tissue.load(loadOf({displacedPatch("pull", top, Vec3(0.0, 0.0, 0.004))}, 1));
  const double whole = tissue.answerOf("pull", tissue.lastReport()).force.z();
  tissue.setDeadline(Deadline(1e-6));
  tissue.cut(
      {{-0.01, -0.01, 0.0125}, {0.03, -0.01, 0.0125}, {0.03, 0.07, 0.0125}, {-0.01, 0.07, 0.0125}});
  ASSERT_TRUE(tissue.isLate());
  const Tissue::Shape late = tissue.shape();
  EXPECT_FALSE(late.disturbed.empty());
  tissue.setDeadline(std::nullopt);
  tissue.follow({}, {});
  const double cut = tissue.answerOf("pull", tissue.lastReport()).force.z();
  EXPECT_LT(cut, 0.9 * whole);
  tissue.restore(late);
  tissue.follow({}, {});
  EXPECT_NEAR(tissue.answerOf("pull", tissue.lastReport()).force.z(), cut, 0.01 * whole);
}

}  // namespace
}  // namespace robot_tissue::test_adrift
