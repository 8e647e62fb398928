// What a call of the pipeline has no time for is carried on by the steps that follow. The budget is
// none at all, so that it does not matter how fast the machine is.
#include "pipeline_fixtures.h"

namespace robot_tissue::test_late_work {
namespace {

constexpr int kMostSteps = 400;

Pipeline blockUnder(const std::vector<ToolGeometry>& tools) {
  return {block(), methodOf("elastic"), tools};
}

LoadStep punch(double depth) {
  LoadStep load;
  load.patches.push_back({});
  load.patches.front().name = "punch";
  load.patches.front().box = {Vec3(0.0, 0.0, kTop), Vec3(0.01, kWidth, kTop)};
  load.patches.front().displacement = {{0.0, 0.0, -depth}};
  return load;
}

PatchAnswer answerOfPunch(const Pipeline& pipeline) {
  return pipeline.tissue().answerOf("punch", pipeline.tissue().lastReport());
}

void stepUntilDone(Pipeline& pipeline, const RobotPose& pose) {
  int steps = 0;
  while (pipeline.step(pose).changed && ++steps < kMostSteps) {
  }
  EXPECT_LT(steps, kMostSteps);
  EXPECT_FALSE(pipeline.isLate());
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
}

double force(const Pipeline& pipeline) {
  return pipeline.report().tools.front().force_on_tool.norm();
}

TEST(LateWork, BudgetBoundsSolvesWithoutMaxMs) {
  Pipeline pipeline = blockUnder({probe()});
  pipeline.setBudget(0.0);
  for (double depth = -0.001; depth < 0.004; depth += 0.0005) {
    pipeline.step(pressed(depth));
    EXPECT_LE(pipeline.tissue().lastReport().iterations, 1);
    EXPECT_LE(pipeline.report().substeps, 1);
  }
  EXPECT_TRUE(pipeline.isLate() || pipeline.report().too_fast);
  EXPECT_FALSE(pipeline.hasArrived());
  stepUntilDone(pipeline, pressed(0.004));
  EXPECT_TRUE(pipeline.hasArrived());
}

TEST(LateWork, LoadIsBroughtOnInLaterSteps) {
  Pipeline hurried = blockUnder({probe()}), patient = blockUnder({probe()});
  hurried.setBudget(0.0);
  for (Pipeline* pipeline : {&hurried, &patient}) {
    pipeline->step(pressed(-0.01));
    pipeline->load(punch(0.01));
  }
  EXPECT_TRUE(hurried.isLate());
  EXPECT_TRUE(hurried.tissue().isLoading());
  EXPECT_GT(answerOfPunch(hurried).displacement.z(), -0.009);
  stepUntilDone(hurried, pressed(-0.01));
  EXPECT_DOUBLE_EQ(answerOfPunch(hurried).displacement.z(), -0.01);
  EXPECT_LT(relativeDifference(hurried.tissue(), patient.tissue()), 0.03);
}

TEST(LateWork, LoadIsBroughtOnWhileTheToolsHaveNoPose) {
  Pipeline pipeline = blockUnder({probe()});
  pipeline.setBudget(0.0);
  pipeline.load(punch(0.01));
  int calls = 0;
  while (pipeline.isLate() && ++calls < kMostSteps) pipeline.carryOn();
  EXPECT_GT(calls, 1);
  EXPECT_DOUBLE_EQ(answerOfPunch(pipeline).displacement.z(), -0.01);
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
}

TEST(LateWork, LoadUnderWayIsReleased) {
  Pipeline pipeline = blockUnder({probe()});
  pipeline.setBudget(0.0);
  pipeline.step(pressed(-0.01));
  pipeline.load(punch(0.01));
  pipeline.release({"punch"});
  EXPECT_FALSE(pipeline.tissue().isLoading());
  stepUntilDone(pipeline, pressed(-0.01));
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

// Until then what the tool bears is told as it was.
TEST(LateWork, CutIsBalancedInLaterSteps) {
  Pipeline hurried = blockUnder({probe()}), patient = blockUnder({probe()});
  const double x = kMiddle + 0.0125;  // between nodes
  for (Pipeline* pipeline : {&hurried, &patient}) {
    walk(*pipeline, -0.001, 0.005);
    pipeline->step(pressed(0.005));
  }
  hurried.setBudget(0.0);
  const double before = force(hurried);
  for (Pipeline* pipeline : {&hurried, &patient}) {
    pipeline->cut({Vec3(x, -1.0, 0.01), Vec3(x, 1.0, 0.01), Vec3(x, 1.0, 1.0), Vec3(x, -1.0, 1.0)});
  }
  EXPECT_EQ(hurried.tissue().lastReport().iterations, 0);
  EXPECT_TRUE(hurried.isLate());
  EXPECT_EQ(force(hurried), before);
  EXPECT_LT(force(patient), 0.99 * before);
  EXPECT_EQ(hurried.tissue().surface().triangles, patient.tissue().surface().triangles);
  stepUntilDone(hurried, pressed(0.005));
  patient.step(pressed(0.005));
  EXPECT_NEAR(force(hurried), force(patient), 0.05 * force(patient));
  EXPECT_LT(relativeDifference(hurried.tissue(), patient.tissue()), 0.05);
}

// The shape is found anew from rest when the last tool leaves.
TEST(LateWork, StandingLoadComesBackWhenTheLastToolLeaves) {
  Pipeline hurried = blockUnder({probe()}), patient = blockUnder({probe()});
  for (Pipeline* pipeline : {&hurried, &patient}) {
    pipeline->load(punch(0.01));
    walk(*pipeline, -0.001, 0.003);
  }
  hurried.setBudget(0.0);
  stepUntilDone(hurried, pressed(-0.01));
  patient.step(pressed(-0.01));
  EXPECT_DOUBLE_EQ(answerOfPunch(hurried).displacement.z(), -0.01);
  EXPECT_LT(relativeDifference(hurried.tissue(), patient.tissue()), 0.03);
}

TEST(LateWork, ToolsThatAppearInsideComeInOneByOneWithoutTime) {
  Pipeline pipeline = blockUnder({probe("left"), probe("right")});
  pipeline.setBudget(0.0);
  const double z = kTop + kRadius - 0.004;
  const RobotPose inside = at({Vec3(0.015, kMiddle, z), Vec3(0.045, kMiddle, z)});
  const StepReport& report = pipeline.step(inside);
  EXPECT_EQ(report.were_inside, std::vector<std::size_t>{0});
  EXPECT_TRUE(report.too_fast);
  EXPECT_EQ(std::count(report.behind.begin(), report.behind.end(), 1U), 1);
  EXPECT_FALSE(pipeline.hasArrived());
  pipeline.step(inside);
  EXPECT_EQ(report.were_inside, std::vector<std::size_t>{1});
  stepUntilDone(pipeline, inside);
  EXPECT_TRUE(pipeline.hasArrived());
  EXPECT_NEAR(report.tools[0].force_on_tool.z(), report.tools[1].force_on_tool.z(),
              0.05 * report.tools[0].force_on_tool.z());
}

// Between plates that close until no shape follows.
class LostTools : public ::testing::Test {
 protected:
  void SetUp() override {
    pipeline_.step(squeezed(kTop + 0.002));
    double gap = kTop;
    for (; gap > 0.0 && !pipeline_.report().lost; gap -= 0.01) pipeline_.step(squeezed(gap));
    if (!pipeline_.report().lost) pipeline_.step(squeezed(-0.002));
    ASSERT_TRUE(pipeline_.report().lost);
    stand_ = squeezed(gap > 0.0 ? gap + 0.01 : -0.002);
  }
  static TissueConfig tissue() {
    TissueConfig tissue = block("elastic", 2.0 * kSpacing);
    tissue.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)});
    return tissue;
  }
  static std::vector<ToolGeometry> plates() {
    return {toolOf(boxOf(Vec3(0.2, 0.2, 0.01)), "above"),
            toolOf(boxOf(Vec3(0.2, 0.2, 0.01)), "below")};
  }
  static RobotPose squeezed(double gap) {
    const double middle = 0.5 * kTop, half = 0.5 * gap + 0.005;
    return at({Vec3(0.13, kMiddle, middle + half), Vec3(0.13, kMiddle, middle - half)});
  }

  Pipeline pipeline_{tissue(), methodOf("elastic"), plates()};
  RobotPose stand_;
};

// What no shape follows is told for as long as the tools stand there.
TEST_F(LostTools, HaveNotArrivedHoweverLongTheyStand) {
  for (int step = 0; step < 3; ++step) {
    pipeline_.step(stand_);
    EXPECT_TRUE(pipeline_.report().lost);
    EXPECT_FALSE(pipeline_.hasArrived());
  }
}

TEST_F(LostTools, AreToldAlsoWhileTheyHaveNoPose) {
  const std::vector<std::size_t> behind = pipeline_.report().behind;
  ASSERT_FALSE(behind.empty());
  for (int call = 0; call < 3; ++call) {
    pipeline_.carryOn();
    EXPECT_TRUE(pipeline_.report().lost);
    EXPECT_EQ(pipeline_.report().behind, behind);
  }
}

TEST_F(LostTools, AreNowhereAfterAReset) {
  ASSERT_GT(pipeline_.report().tools.front().max_penetration, 0.0);
  pipeline_.reset();
  EXPECT_FALSE(pipeline_.report().lost);
  EXPECT_TRUE(pipeline_.report().behind.empty());
  for (const ToolReport& tool : pipeline_.report().tools) EXPECT_EQ(tool.max_penetration, 0.0);
}

// Tissue snaps off a needle by solves that take many updates' time: they go on with what the last
// one came to.
TEST(LateWork, SlipIsFollowedThroughManyUpdates) {
  Pipeline pipeline = blockUnder({withFriction(0.3, toolOf(uprightCylinder(0.0005, 0.05)))});
  const Vec3 above(0.0263, 0.0311, kTop + 0.001), deep = above - 0.012 * Vec3::UnitZ(),
                                                  aside = deep + 0.008 * Vec3::UnitX(),
                                                  out = aside + 0.012 * Vec3::UnitZ();
  walk(pipeline, {above}, {deep}, 0.0005);
  pipeline.setBudget(0.0);
  int goes_on = 0;
  for (const auto& [from, to] : {std::make_pair(deep, aside), std::make_pair(aside, out)}) {
    for (int i = 1; i <= 16; ++i) {
      const RobotPose pose = at({Vec3(from + (to - from) * (i / 16.0))});
      for (int update = 0; update < 60; ++update) {
        const Vec3 before = pipeline.pose()->links.front().translation();
        const StepReport& report = pipeline.step(pose);
        ASSERT_FALSE(report.lost) << i;
        ASSERT_TRUE(report.tools.front().force_on_tool.allFinite());
        goes_on += report.too_fast && pipeline.pose()->links.front().translation() == before;
        if (!report.too_fast && !report.late) break;
      }
    }
  }
  EXPECT_GT(goes_on, 0);
  stepUntilDone(pipeline, at({out}));
  EXPECT_EQ(force(pipeline), 0.0);
}

}  // namespace
}  // namespace robot_tissue::test_late_work
