// Tools and supports beside tissue that moves in time.
#include <gtest/gtest.h>

#include <random>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_tools_in_time {
namespace {

constexpr double kRate = 200.0;  // poses a second
constexpr double kGravity = 9.81;

TissueConfig inTime(TissueConfig tissue, double damping_time) {
  tissue.time = TimeConfig{damping_time};
  return tissue;
}

struct Case {
  double damping_time;  // s
  double friction;
};

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  return "Damping" + std::to_string(static_cast<int>(1e3 * info.param.damping_time)) + "Friction" +
         std::to_string(static_cast<int>(10.0 * info.param.friction));
}

// A robot whose poses come at uneven times.
class UnevenPoses : public testing::TestWithParam<Case> {
 protected:
  static constexpr double kDepth = 0.004;  // m

  // For some seconds, from one depth to another; the last pose is the whole way.
  void move(double from, double to, double seconds) {
    const double start = stamp_;
    while (stamp_ < start + seconds) {
      stamp_ += (0.6 + 0.8 * share_(random_)) / kRate;
      step(from + std::min(1.0, (stamp_ - start) / seconds) * (to - from));
    }
  }
  void step(double depth) {
    RobotPose pose = pressed(depth);
    pose.stamp_s = stamp_;
    const double before = force();
    pipeline_.step(pose);
    ASSERT_EQ(pipeline_.tissue().lastReport().status, SolveStatus::kOk) << stamp_;
    greatest_change_ = std::max(greatest_change_, std::abs(force() - before));
    greatest_ = std::max(greatest_, force());
  }
  double force() const { return pipeline_.report().tools.front().force_on_tool.norm(); }
  // What friction holds back hangs on the way there, so forces at rest differ.
  void expectHeld(double force_at_rest) {
    EXPECT_NEAR(force(), force_at_rest, 0.06 * force_at_rest) << stamp_;
  }
  static double forceWithoutTime() {
    Pipeline still(block("elastic", kSpacing), methodOf("elastic"),
                   {withFriction(GetParam().friction, probe())});
    walk(still, -0.001, kDepth);
    return still.report().tools.front().force_on_tool.norm();
  }

  Pipeline pipeline_{inTime(block("elastic", kSpacing), GetParam().damping_time),
                     methodOf("elastic"),
                     {withFriction(GetParam().friction, probe())}};
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> share_{0.0, 1.0};
  double stamp_ = 0.0;            // s
  double greatest_change_ = 0.0;  // of the force, from pose to pose (N)
  double greatest_ = 0.0;         // N
};

TEST_P(UnevenPoses, AToolThatPressesIsHeldThroughASilenceAndLetGo) {
  const double at_rest = forceWithoutTime();
  move(-0.001, kDepth, 0.5);
  move(kDepth, kDepth, 0.4);
  expectHeld(at_rest);
  greatest_change_ = 0.0;
  move(kDepth, kDepth, 0.3);  // it does not tremble
  EXPECT_LT(greatest_change_, 0.01 * at_rest);
  stamp_ += 0.1;  // as long as a clock lets time go by in a silence
  step(kDepth);
  expectHeld(at_rest);
  move(kDepth, kDepth, 0.3);
  expectHeld(at_rest);
  move(kDepth, -0.03, 0.05);
  EXPECT_EQ(force(), 0.0);
  move(-0.03, -0.03, 1.5);
  EXPECT_EQ(force(), 0.0);
  EXPECT_FALSE(pipeline_.tissue().isMoving());
  EXPECT_LT(greatestDisplacement(pipeline_.tissue()), 1e-5);
}

// What presses harder than it will at rest is inertia and viscosity: no more than they ask for.
TEST_P(UnevenPoses, AToolThatPressesEvenlyPressesEvenly) {
  const double at_rest = forceWithoutTime();
  move(-0.001, kDepth, 0.5);
  EXPECT_LT(greatest_, 1.35 * at_rest);
  EXPECT_LT(greatest_change_, 0.32 * at_rest);
}

// Its way takes the tissue a millisecond a load step, so that no step throws the tissue away: what
// a step of that length has is its shape's force, and damping_time / 1 ms times as much.
TEST_P(UnevenPoses, ARobotThatJumpsIsFollowed) {
  const double at_rest = forceWithoutTime();
  for (const double gap : {0.005, 0.0005}) {
    greatest_ = 0.0;
    move(-0.05, -0.05, 0.05);
    stamp_ += gap;
    step(kDepth);
    EXPECT_LT(greatest_, 3.0 * (1.0 + GetParam().damping_time / 0.001) * at_rest);
    move(kDepth, kDepth, 0.5);
    expectHeld(at_rest);
    stamp_ += gap;
    step(-0.05);
    EXPECT_EQ(force(), 0.0);
    move(-0.05, -0.05, 1.5);
    EXPECT_FALSE(pipeline_.tissue().isMoving());
    EXPECT_LT(greatestDisplacement(pipeline_.tissue()), 1e-5);
  }
}

// A bound on the time of an update that is over at once: each update makes one time step, whole.
TEST_P(UnevenPoses, ThatAreLateComeToTheSameRest) {
  pipeline_.setBudget(1e-9);
  move(-0.001, kDepth, 0.3);
  for (int i = 0; i < 300 && (i == 0 || pipeline_.tissue().isMoving()); ++i) {
    stamp_ += 1.0 / kRate;
    step(kDepth);
  }
  EXPECT_FALSE(pipeline_.tissue().isMoving());
  EXPECT_TRUE(pipeline_.hasArrived());
  expectHeld(forceWithoutTime());
  move(kDepth, -0.03, 0.05);
  for (int i = 0; i < 600 && (i == 0 || pipeline_.tissue().isMoving()); ++i) {
    stamp_ += 1.0 / kRate;
    step(-0.03);
  }
  EXPECT_EQ(force(), 0.0);
  EXPECT_FALSE(pipeline_.tissue().isMoving());
  EXPECT_LT(greatestDisplacement(pipeline_.tissue()), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Tissues, UnevenPoses,
                         testing::Values(Case{0.05, 0.3}, Case{0.05, 0.0}, Case{0.01, 0.3},
                                         Case{0.002, 0.3}),
                         nameOf);

// A block that hangs on its top above a table; what is cut off falls onto it.
class CutAboveATable : public testing::Test {
 protected:
  static constexpr double kFall = 0.005;       // m
  static constexpr double kCutHeight = 0.025;  // m
  static constexpr double kStep = 0.005;       // s

  static TissueConfig hanging() {
    TissueConfig tissue = inTime(block("elastic", kSpacing), 0.02);
    tissue.gravity = Vec3(0.0, 0.0, -kGravity);
    tissue.fixed = {{Vec3(-1.0, -1.0, kTop - 1e-6), Vec3(1.0, 1.0, kTop + 1e-6)}};
    return tissue;
  }
  static SupportConfig table() {
    SupportConfig table{"table", planeOf(true), 0.3};
    table.shape.pose.translation().z() = -kFall;
    return table;
  }
  void SetUp() override {
    pipeline_.settle();
    ASSERT_EQ(pipeline_
                  .cut({Vec3(-1.0, -1.0, kCutHeight), Vec3(1.0, -1.0, kCutHeight),
                        Vec3(1.0, 1.0, kCutHeight), Vec3(-1.0, 1.0, kCutHeight)})
                  .pieces,
              2);
  }
  double lowest() const {
    double lowest = kTop;
    for (const Vec3& vertex : pipeline_.tissue().vertices()) lowest = std::min(lowest, vertex.z());
    return lowest;
  }
  // Height of the cut piece's middle, as far as a corner of it tells.
  double height() const { return pipeline_.tissue().nodePosition(0).z(); }

  Pipeline pipeline_{hanging(), methodOf("elastic"), {}, {table()}};
};

TEST_F(CutAboveATable, TheFreePieceLandsAndRestsForNothing) {
  const double start = height();
  double after_landing = -kFall;
  bool has_landed = false;
  int steps = 0;
  for (; steps < 1000 && (steps == 0 || pipeline_.tissue().isMoving()); ++steps) {
    ASSERT_EQ(pipeline_.wait(kStep).status, SolveStatus::kOk) << steps;
    ASSERT_GT(lowest(), -kFall - 0.05 * kSpacing) << steps;
    has_landed = has_landed || pipeline_.forceBalance().supports.z() > 0.0;
    if (has_landed) after_landing = std::max(after_landing, height());
  }
  ASSERT_FALSE(pipeline_.tissue().isMoving());
  EXPECT_TRUE(has_landed);
  EXPECT_LT(after_landing, start - 0.5 * kFall);  // it bounces back by less than half
  EXPECT_NEAR(lowest(), -kFall, 0.01 * kSpacing);
  const double weight = kGravity * 1000.0 * kWidth * kWidth * 0.02;  // parted in springs' middles
  EXPECT_NEAR(pipeline_.forceBalance().supports.z(), weight, 0.3 * weight);
  const ForceBalance balance = pipeline_.forceBalance();
  EXPECT_LT(balance.unbalanced().norm(), 0.02 * weight);
  const std::vector<Vec3> at_rest = pipeline_.tissue().state().displacement;
  for (int i = 0; i < 200; ++i) {
    pipeline_.wait(kStep);
    ASSERT_EQ(pipeline_.report().substeps, 0);
  }
  EXPECT_EQ(pipeline_.tissue().state().displacement, at_rest);
}

// Points that come under an edge between those that touched before come out by and by: pushed out
// at once, they make the force jump by 17 % of the greatest.
TEST(AnEdgeInTime, IsDraggedWithoutJumps) {
  constexpr double kSpeed = 0.02;  // m/s
  TissueConfig tissue = inTime(block("elastic", kSpacing), 0.01);
  tissue.shape.max() = Vec3(0.1, 0.1, 0.05);
  Pipeline pipeline(tissue, methodOf("elastic"),
                    {withFriction(0.3, toolOf(boxOf(Vec3::Constant(0.02))))});
  RobotPose pose = at({Vec3::Zero()});
  pose.links.front().linear() = Eigen::AngleAxisd(M_PI / 4.0, Vec3::UnitY()).toRotationMatrix();
  const auto step = [&](double x, double depth) {
    pose.links.front().translation() = Vec3(x, 0.05, 0.05 + 0.01 * std::sqrt(2.0) - depth);
    pose.stamp_s += 1.0 / kRate;
    pipeline.step(pose);
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << x;
    return pipeline.report().tools.front().force_on_tool;
  };
  const double stride = kSpeed / kRate;
  Vec3 before = Vec3::Zero();
  for (double depth = -0.0005; depth < 0.005; depth += stride) before = step(0.035, depth);
  double jump = 0.0, greatest = 0.0;
  for (double x = 0.035; x < 0.045; x += stride) {
    const Vec3 force = step(x, 0.005);
    jump = std::max(jump, (force - before).norm());
    greatest = std::max(greatest, force.norm());
    before = force;
  }
  EXPECT_LT(jump, 0.1 * greatest);
}

// A tool that a force drives goes with the tissue that another one moves in time.
TEST(DrivenToolInTime, KeepsItsForceWhileTheTissueMoves) {
  TissueConfig tissue = inTime(block("elastic", kSpacing), 0.02);
  Pipeline pipeline(tissue, methodOf("elastic"), {probe()});
  RobotPose pose = pressed(-0.001);
  pipeline.step(pose);
  const double force = 0.1;  // N
  pipeline.push(0, Vec3(0.0, 0.0, -force));
  PatchConfig side;
  side.name = "side";
  side.box = {Vec3(0.0, 0.0, kTop), Vec3(0.01, kWidth, kTop)};
  side.displacement = {{0.0, 0.0, -0.003}};
  for (int update = 1; update <= 60; ++update) {
    if (update == 20) pipeline.load({1, {side}});
    if (update == 40) pipeline.release({"side"});
    pose.stamp_s += 0.005;
    pipeline.step(pose);
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << update;
    if (update % 20 < 4) continue;  // on its way
    const double met = pipeline.report().tools.front().force_on_tool.z();
    EXPECT_NEAR(met, force, 0.01 * force) << update;
  }
}

// Tissue that was never in balance falls, or sags, beside tools and supports that it does not meet
// as it does without them.
TEST(TissueUnderGravity, MovesFromTheStartAlsoBesideToolsThatAreAway) {
  TissueConfig falling = inTime(block("elastic", 0.01), 0.01);
  falling.gravity = Vec3(0.0, 0.0, -kGravity);
  TissueConfig sagging = falling;
  falling.fixed.clear();
  const double seconds = 0.1;
  for (const TissueConfig& tissue : {falling, sagging}) {
    SupportConfig table;
    table.name = "table";
    table.shape = planeOf(true);
    table.shape.pose.translation() = Vec3(0.0, 0.0, -1.0);
    Pipeline alone(tissue, methodOf("elastic"), {});
    Pipeline over_table(tissue, methodOf("elastic"), {}, {table});
    Pipeline beside_tool(tissue, methodOf("elastic"), {probe()});
    beside_tool.step(pressed(-0.5));
    for (Pipeline* pipeline : {&alone, &over_table, &beside_tool}) {
      pipeline->startClock(0.0);
      pipeline->wait(seconds);
    }
    const double way = greatestDisplacement(alone.tissue());
    EXPECT_GT(way, 1e-4);
    EXPECT_NEAR(greatestDisplacement(over_table.tissue()), way, 0.03 * way);
    EXPECT_NEAR(greatestDisplacement(beside_tool.tissue()), way, 0.03 * way);
  }
}

// A thread that is drawn in throws light nodes at more than a spacing in a millisecond: its motion
// asks for shorter steps, also where a tool that touches nothing is told of.
class StrongThread : public testing::Test {
 protected:
  static constexpr double kSeconds = 0.1;

  static TissueConfig tissue() {
    TissueConfig tissue;
    tissue.shape.max() = Vec3(0.02, 0.04, 0.05);
    tissue.spacing = 0.01;
    tissue.material.young_modulus = 12810.0;
    tissue.material.poisson_ratio = 0.49;
    tissue.fixed.push_back(bottomOf(tissue.shape));
    return inTime(tissue, 0.01);
  }
  static SutureConfig thread() {
    SutureConfig thread;
    thread.name = "thread";
    thread.from = Vec3(0.0088, 0.03128, 0.05);
    thread.to = Vec3(0.01566, 0.03631, 0.05);
    thread.rest_length = 0.00425;
    thread.stiffness = 2000.0;
    thread.bite = 0.00415;
    return thread;
  }
  static double tensionAfter(Pipeline& pipeline) {
    pipeline.startClock(0.0);
    pipeline.suture(thread());
    for (int part = 0; part < 4; ++part) {
      EXPECT_EQ(pipeline.wait(kSeconds / 4.0).status, SolveStatus::kOk) << part;
      EXPECT_FALSE(pipeline.report().lost) << part;
    }
    return pipeline.tissue().sutures().front().tension;
  }
};

TEST_F(StrongThread, ComesToItsTensionAsWithoutAToolThatIsFarAway) {
  Pipeline alone(tissue(), methodOf("elastic"), {});
  Pipeline beside_tool(tissue(), methodOf("elastic"), {probe()});
  beside_tool.step(at({Vec3(0.2, 0.01, 0.05)}));
  const double tension = tensionAfter(alone);
  EXPECT_GT(tension, 0.2);
  EXPECT_NEAR(tensionAfter(beside_tool), tension, 0.02 * tension);
}

// Without time for a step's solve the tissue goes as far as it comes and stands still there, so it
// comes to rest where it does with all the time, and never swings beyond.
TEST(AShortUpdate, EndsTimeStepsAndIsLate) {
  TissueConfig sagging = inTime(block("elastic", 0.01), 0.01);
  sagging.gravity = Vec3(0.0, 0.0, -kGravity);
  Pipeline unhurried(sagging, methodOf("elastic"), {});
  unhurried.wait(5.0);
  ASSERT_FALSE(unhurried.tissue().isMoving());
  const double sag = greatestDisplacement(unhurried.tissue());
  Pipeline hurried(sagging, methodOf("elastic"), {probe()});
  hurried.step(pressed(-0.5));
  hurried.startClock(0.0);
  hurried.setEnd(Deadline(-1.0));  // over for a second
  int late = 0;
  for (int update = 0; update < 1000 && hurried.tissue().isMoving(); ++update) {
    const SolveReport report = hurried.wait(1e-3);
    ASSERT_LE(report.iterations, 1) << update;
    ASSERT_FALSE(hurried.report().lost) << update;
    const bool is_late = report.status == SolveStatus::kLate;
    EXPECT_EQ(hurried.report().late, is_late) << update;
    late += is_late ? 1 : 0;
    ASSERT_LT(greatestDisplacement(hurried.tissue()), 1.05 * sag) << update;
  }
  EXPECT_GT(late, 3);
  EXPECT_NEAR(greatestDisplacement(hurried.tissue()), sag, 0.05 * sag);
}

}  // namespace
}  // namespace robot_tissue::test_tools_in_time
