// Load steps are given up that take far too long again and again: counted, not timed.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "tissue_fixtures.h"

namespace robot_tissue::test_patience {
namespace {

constexpr int kUsual = 30;
constexpr int kNoBound = std::numeric_limits<int>::max();

Patience forScene() {
  Patience patience(kUsual);
  patience.limit();
  return patience;
}

void solve(Patience& patience, int iterations, bool converged = true) {
  const Patience::LoadStep load_step(patience);
  patience.note(iterations, converged);
}

// Solves that take all that is left, until there is no more.
void jam(Patience& patience) {
  while (!patience.isOver()) solve(patience, patience.left(), false);
}

TEST(Patience, OutlastsASlipAndEndsInAJam) {
  Patience patience = forScene();
  solve(patience, 800);
  EXPECT_FALSE(patience.isOver());
  int hard = 0;
  for (; hard < 1000 && !patience.isOver(); ++hard) solve(patience, 200, false);
  EXPECT_LT(hard, 10);
}

// As where tissue slips off an edge of a tool once in each spacing of its way.
TEST(Patience, SpendsLittleWhereItLedToBalance) {
  Patience patience = forScene();
  for (int hard = 0; hard < 50; ++hard) solve(patience, 200);
  EXPECT_FALSE(patience.isOver());
  for (int hard = 0; hard < 1000 && !patience.isOver(); ++hard) solve(patience, 200);
  EXPECT_TRUE(patience.isOver());
}

TEST(Patience, ForgivesSlipsAmongEasyLoadSteps) {
  Patience patience = forScene();
  for (int slip = 0; slip < 100; ++slip) {
    solve(patience, 800);
    for (int easy = 0; easy < 200; ++easy) solve(patience, kUsual);
    ASSERT_FALSE(patience.isOver()) << slip;
  }
}

// As counted where a box's edge is dragged over 25 mm of a block.
TEST(Patience, OutlastsTissueThatSnapsOverAnEdge) {
  Patience patience = forScene();
  for (const int hard_steps : {4, 5, 7}) {
    for (int hard = 0; hard < hard_steps; ++hard) solve(patience, 150);
    ASSERT_FALSE(patience.isOver()) << hard_steps;
    for (int easy = 0; easy < 46; ++easy) solve(patience, 10);
  }
}

TEST(Patience, ForgivesNothingForWhatIsCutOff) {
  Patience patience = forScene();
  jam(patience);
  for (int i = 0; i < 1000; ++i) solve(patience, patience.left(), false);
  EXPECT_TRUE(patience.isOver());
  solve(patience, kUsual);
  EXPECT_FALSE(patience.isOver());
}

TEST(Patience, LeavesTheUsualWorkToEachLoadStep) {
  Patience patience = forScene();
  jam(patience);
  const int usual = patience.left();
  EXPECT_GE(usual, kUsual);
  EXPECT_LT(usual, 2 * kUsual);
  const Patience::LoadStep load_step(patience);
  solve(patience, 20);
  EXPECT_LT(patience.left(), usual - 20);
  solve(patience, usual - 20);
  EXPECT_EQ(patience.left(), 0);
}

TEST(Patience, TakesTheSolvesOfALoadStepAsOne) {
  Patience patience = forScene();
  const int fresh = patience.left();
  for (int i = 0; i < 1000; ++i) {
    const Patience::LoadStep load_step(patience);
    for (int part = 0; part < 4; ++part) solve(patience, kUsual / 4);
  }
  EXPECT_EQ(patience.left(), fresh);
}

// As where contacts change from round to round: what each solve begins and ends with is work, too.
TEST(Patience, EndsForManyShortSolves) {
  Patience in_one = forScene(), in_many = forScene();
  for (int i = 0; i < 500; ++i) {
    solve(in_one, kUsual);
    const Patience::LoadStep load_step(in_many);
    for (int part = 0; part < kUsual; ++part) solve(in_many, 1);
  }
  EXPECT_FALSE(in_one.isOver());
  EXPECT_TRUE(in_many.isOver());
}

TEST(Patience, CountsAllThatLedNowhere) {
  Patience useful = forScene(), unsettled = forScene(), lost = forScene();
  for (int i = 0; i < 200; ++i) {
    solve(useful, kUsual);
    solve(unsettled, std::min(kUsual, unsettled.left()), false);
    const Patience::LoadStep load_step(lost);
    solve(lost, std::min(kUsual, lost.left()));
    lost.noteLost();
  }
  EXPECT_FALSE(useful.isOver());
  EXPECT_TRUE(unsettled.isOver());
  EXPECT_TRUE(lost.isOver());
}

// Where iterations take long, there are fewer beyond the usual ones, and fewer of these once they
// are spent.
TEST(Patience, IsLessOnALargeLattice) {
  Patience small = forScene(), large(kUsual, 1000000);
  large.limit();
  EXPECT_GT(small.left(), 10 * large.left());
  for (int i = 0; i < 1000; ++i) {
    ASSERT_GE(large.left(), kUsual - 2);
    solve(large, large.left());
    if (large.isOver()) break;
  }
  jam(small);
  jam(large);
  EXPECT_GE(small.left(), kUsual);
  EXPECT_LT(large.left(), kUsual / 2);
}

// And where there are more touches than nodes, each iteration counts for more.
TEST(Patience, GoesByWhatIterationsCost) {
  Patience cheap = forScene(), dear = forScene();
  for (int i = 0; i < 100; ++i) {
    solve(cheap, kUsual);
    const Patience::LoadStep load_step(dear);
    dear.note(kUsual, true, Patience::Of::kLoadStep, 8.0);
  }
  EXPECT_FALSE(cheap.isOver());
  EXPECT_TRUE(dear.isOver());
}

// Of four iterations in a time step, one.
TEST(Patience, TakesMoreOfTimeSteps) {
  Patience of_loads = forScene(), of_time = forScene();
  for (int i = 0; i < 10; ++i) {
    solve(of_loads, 90, false);
    const Patience::LoadStep load_step(of_time);
    of_time.note(4 * 90, false, Patience::Of::kTimeStep);
  }
  EXPECT_FALSE(of_loads.isOver());
  EXPECT_GE(of_time.left(), of_loads.left());
  EXPECT_GE(of_time.left(Patience::Of::kTimeStep), 4 * of_loads.left());
}

// A method that usually takes more is given more.
TEST(Patience, GoesByWhatIsUsual) {
  Patience quick = forScene(), slow(10 * kUsual);
  slow.limit();
  for (int hard = 0; hard < 1000 && !quick.isOver(); ++hard) {
    ASSERT_NEAR(slow.left(), 10 * quick.left(), 10) << hard;  // whole ones
    solve(quick, 200);
    solve(slow, 2000);
    if (hard % 3 > 0) continue;
    for (Patience* patience : {&quick, &slow}) solve(*patience, kUsual);
  }
  EXPECT_TRUE(slow.isOver());
}

TEST(Patience, EndsForNoMethodThatKnowsNoUsualLoadStep) {
  Patience patience;
  patience.limit();
  for (int i = 0; i < 100; ++i) solve(patience, 1000000);
  EXPECT_FALSE(patience.isOver());
  EXPECT_EQ(patience.left(), kNoBound);
}

TEST(Patience, IsOfOneWayUntilItIsLimited) {
  Patience patience(kUsual);
  jam(patience);
  EXPECT_FALSE(patience.cutsOff());
  EXPECT_EQ(patience.left(), kNoBound);
  patience.forgetWay();
  EXPECT_FALSE(patience.isOver());
  patience.limit();
  jam(patience);
  patience.forgetWay();
  EXPECT_TRUE(patience.cutsOff());
  patience.forget();
  EXPECT_FALSE(patience.isOver());
}

TEST(Patience, LastsAsManyTimesAsItIsTold) {
  const auto lasts = [](double times) {
    Patience patience(kUsual);
    patience.limit(times);
    int hard = 0;
    for (; hard < 1000 && !patience.isOver(); ++hard) solve(patience, 200, false);
    return hard;
  };
  EXPECT_NEAR(lasts(3.0), 3.0 * lasts(1.0), 2.0);
}

TEST(Patience, TrialsSpendTheirOwn) {
  Patience patience = forScene();
  patience.beginTrial();
  jam(patience);
  patience.endTrial();
  EXPECT_FALSE(patience.isOver());
  solve(patience, 200);
  const int left = patience.left();
  patience.beginTrial();
  EXPECT_TRUE(patience.isOver());
  patience.endTrial();
  EXPECT_EQ(patience.left(), left);
}

TEST(Patience, IsOverForTrialsToo) {
  Patience patience = forScene();
  jam(patience);
  patience.beginTrial();
  EXPECT_TRUE(patience.isOver());
  patience.endTrial();
}

// A block pulled out to twice its height, farther each time: more cycles than are usual.
class ImpatientTissue : public ::testing::Test {
 protected:
  static TissueConfig block() {
    TissueConfig config = withFixedBottom(blockOf(4, 4, 4, 0.01));
    config.model = "elastic";
    config.material.poisson_ratio = 0.49;
    return config;
  }
  static SolverConfig exact() {
    SolverConfig solver;
    solver.tolerance = 1e-12;
    return solver;
  }
  SolveReport pull(double way) {
    const TissueConfig config = block();
    LoadStep step =
        loadOf({displacedPatch("top", nodeBox(config, {1, 1, 4}, {3, 3, 4}), {0, 0, way})});
    step.increments = 1;
    SolveReport report;
    tissue_.load(step, [&](int, int, const SolveReport& of) { report = of; });
    return report;
  }
  void SetUp() override { tissue_.patience().limit(); }

  Tissue tissue_{block(), exact()};
};

TEST_F(ImpatientTissue, EndsItsLoadsAfterTheUsualIterationsAndSaysSo) {
  ASSERT_EQ(pull(0.004).status, SolveStatus::kOk);
  const int whole = tissue_.lastReport().iterations;
  jam(tissue_.patience());
  const int left = tissue_.patience().left();
  ASSERT_GT(whole, left);
  const SolveReport report = pull(0.008);
  EXPECT_EQ(report.status, SolveStatus::kUnconverged);
  EXPECT_LE(report.iterations, left);
}

// Of the middle of the top face.
ContactSpring touchOn(const Tissue& tissue) {
  const Lattice& lattice = tissue.lattice();
  const auto& size = lattice.size();
  ContactSpring touch;
  const int node = lattice.node(size[0] / 2, size[1] / 2, size[2] - 1);
  touch.carriers = {{node, 1.0}};
  touch.rest = lattice.restPosition(node);
  touch.normal = -Vec3::UnitZ();
  touch.plane_point = touch.rest + 0.001 * touch.normal;
  touch.stiffness = 0.01 * tissue.nodeStiffness(node);
  return touch;
}

// Work that patience lost by it, over iterations and the two that a solve begins and ends with.
double costOfFollowing(Tissue& tissue, std::size_t touches) {
  LoadingPatch tool;
  tool.contacts = std::vector<ContactSpring>(touches, touchOn(tissue));
  Patience& patience = tissue.patience();
  const Patience::LoadStep load_step(patience);
  const int before = patience.left();
  const SolveReport report = tissue.follow({tool}, {});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_GT(report.iterations, 0);
  return static_cast<double>(before - patience.left()) / (report.iterations + 2);
}

// Cells that cuts parted take longer.
TEST(Patience, CountsIterationsOnCutTissueSeveralTimes) {
  TissueConfig block = withFixedBottom(blockOf(20, 20, 10, 0.005));
  block.model = "elastic";
  Tissue tissue(block, {});
  tissue.patience().limit();
  EXPECT_NEAR(costOfFollowing(tissue, 1), 1.0, 0.1);
  tissue.cut(
      {{0.026, -0.01, -0.01}, {0.026, 0.11, -0.01}, {0.026, 0.11, 0.06}, {0.026, -0.01, 0.06}});
  EXPECT_GT(costOfFollowing(tissue, 1), 2.0);
}

// Three touches a node, as of a fine mesh on a coarse lattice: an iteration is three, and so are
// the two that a solve begins and ends with.
TEST_F(ImpatientTissue, CountsIterationsOfMoreTouchesThanNodesSeveralTimes) {
  const int nodes = tissue_.lattice().nodeCount();
  for (const int touches_a_node : {0, 1, 3}) {
    const auto touches = static_cast<std::size_t>(touches_a_node * nodes + 1);
    const double cost = std::max(1.0, static_cast<double>(touches) / nodes);
    EXPECT_NEAR(costOfFollowing(tissue_, touches), cost, 0.3);
  }
}

TEST_F(ImpatientTissue, GivesUpTrialsByThemselves) {
  tissue_.beginAside();
  jam(tissue_.patience());
  EXPECT_EQ(pull(0.004).status, SolveStatus::kUnconverged);
  tissue_.endAside();
  EXPECT_EQ(pull(0.006).status, SolveStatus::kOk);
  tissue_.beginAside();
  EXPECT_EQ(pull(0.004).status, SolveStatus::kUnconverged);
  tissue_.endAside();
}

TEST_F(ImpatientTissue, BeginsAnewAtRest) {
  jam(tissue_.patience());
  tissue_.reset();
  EXPECT_EQ(pull(0.004).status, SolveStatus::kOk);
}

}  // namespace
}  // namespace robot_tissue::test_patience
