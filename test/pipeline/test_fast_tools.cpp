// Fast and thin tools, and two at once: none passes through what it should meet.
#include <gtest/gtest.h>

#include <limits>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_fast_tools {
namespace {

constexpr double kSheet = 0.01;  // its thickness: two cells (m)

// Fixed at its edges x = 0 and x = kWidth.
TissueConfig sheet() {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(kWidth, 0.04, kSheet);
  tissue.spacing = kSpacing;
  tissue.material.young_modulus = 1e4;
  tissue.fixed = {{Vec3(-1.0, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)},
                  {Vec3(kWidth - 1e-6, -1.0, -1.0), Vec3(1.0, 1.0, 1.0)}};
  return tissue;
}

ToolGeometry smallProbe(const std::string& name, double radius) {
  ToolGeometry tool = probe(name);
  tool.links.front().shapes.front().radius = radius;
  return tool;
}

// Every vertex of the surface is out of the sphere.
void expectOutside(const Tissue& tissue, const Vec3& center, double radius) {
  for (const Vec3& vertex : tissue.vertices()) {
    EXPECT_GT((vertex - center).norm(), radius - 0.05 * kSpacing);
  }
}

TEST_P(PressedBlock, FastToolDoesNotPassThrough) {
  pipeline_.step(pressed(-0.02));
  const StepReport& report = pipeline_.step(pressed(0.006));  // 26 mm in one update
  EXPECT_FALSE(report.too_fast);
  EXPECT_GE(report.substeps, 6);
  EXPECT_LT(tool().max_penetration, GetParam().hair());
  EXPECT_GT(tool().force_on_tool.z(), 0.1);
}

// Per update at 100 Hz.
class FastTool : public ::testing::TestWithParam<double> {};

TEST_P(FastTool, PressesABlock) {
  const double stride = 0.01 * GetParam();
  Pipeline pipeline(block(), {}, {probe()});
  for (double depth = -stride; depth < 0.007; depth += stride) pipeline.step(pressed(depth));
  const StepReport& report = pipeline.step(pressed(0.007));
  EXPECT_FALSE(report.too_fast);
  EXPECT_LT(report.tools.front().max_penetration, 0.05 * kSpacing);
  EXPECT_GT(report.tools.front().force_on_tool.z(), 0.2);
  expectOutside(pipeline.tissue(), pressed(0.007).links.front().translation(), kRadius);
  pipeline.step(pressed(-stride));
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

TEST_P(FastTool, TakesASheetAlong) {
  constexpr double kSmall = 0.006;
  const double stride = 0.01 * GetParam();
  Pipeline pipeline(sheet(), {}, {smallProbe("probe", kSmall)});
  const Vec3 middle(kMiddle, 0.02, kSheet + kSmall);
  const double depth = 0.015;  // more than the sheet is thick
  for (double way = -stride; way < depth; way += stride) {
    pipeline.step(at({middle - way * Vec3::UnitZ()}));
  }
  const Vec3 end = middle - depth * Vec3::UnitZ();
  const StepReport& report = pipeline.step(at({end}));
  EXPECT_FALSE(report.too_fast);
  EXPECT_LT(report.tools.front().max_penetration, 0.05 * kSpacing);
  EXPECT_GT(report.tools.front().force_on_tool.z(), 0.01);
  expectOutside(pipeline.tissue(), end, kSmall);
  // The sheet is below the sphere: its underside's middle went as far.
  const int under = pipeline.tissue().lattice().node(6, 4, 0);
  EXPECT_LT(pipeline.tissue().nodePosition(under).z(), end.z() - kSmall);
}

TEST_P(FastTool, DragsAlongTheSurface) {
  const double stride = 0.01 * GetParam();
  Pipeline pipeline(block(), {}, {probe()});
  walk(pipeline, -0.001, 0.004, 0.001);
  for (const double side : {1.0, -1.0}) {
    const double x = kMiddle + side * std::min(stride, 0.015);
    const StepReport& report = pipeline.step(pressed(0.004, x));
    EXPECT_FALSE(report.too_fast);
    EXPECT_LT(report.tools.front().max_penetration, 0.05 * kSpacing);
    EXPECT_GT(report.tools.front().force_on_tool.z(), 0.05);
    expectOutside(pipeline.tissue(), pressed(0.004, x).links.front().translation(), kRadius);
  }
}

INSTANTIATE_TEST_SUITE_P(MetersPerSecond, FastTool, ::testing::Values(1.0, 5.0));

// A needle thinner than a fifth of the spacing.
TEST(ThinTool, DoesNotPassThroughASheet) {
  Pipeline pipeline(sheet(), {}, {toolOf(uprightCylinder(0.0005, 0.04))});
  const Vec3 above(0.0313, 0.0211, kSheet + 0.002);
  walk(pipeline, {above}, {above - 0.006 * Vec3::UnitZ()}, 0.003);
  const ToolReport& tool = pipeline.report().tools.front();
  EXPECT_GT(tool.force_on_tool.z(), 1e-3);
  EXPECT_LT(tool.max_penetration, 0.05 * kSpacing);
}

// A plate that covers the block goes down to its fixed ground: there is no room left for tissue.
TEST(JammedTool, StandsWhereAShapeLastFollowedAndComesOut) {
  Pipeline pipeline(block("elastic", 0.01), {}, {toolOf(boxOf(Vec3(0.1, 0.1, 0.02)))});
  const auto place = [](double height) { return Vec3(kMiddle, kMiddle, height + 0.01); };
  walk(pipeline, {place(kTop + 0.001)}, {place(0.0)}, 0.004);
  const StepReport& report = pipeline.report();
  EXPECT_TRUE(report.lost);
  EXPECT_EQ(pipeline.tissue().lastReport().inverted_cells, 0);
  EXPECT_GT(pipeline.pose()->links.front().translation().z(), place(0.001).z());
  EXPECT_GT(report.tools.front().max_penetration, 0.001);  // of the tool where it is
  const Vec3 force = report.tools.front().force_on_tool;
  EXPECT_TRUE(force.allFinite());
  EXPECT_FALSE(pipeline.step(at({place(0.0)})).changed);  // stands still: nothing is tried again
  walk(pipeline, {place(0.0)}, {place(0.8 * kTop)}, 0.004);
  EXPECT_FALSE(report.lost);
  EXPECT_LT(report.tools.front().max_penetration, 0.05 * 0.01);
  EXPECT_LT(report.tools.front().force_on_tool.norm(), 0.5 * force.norm());
  pipeline.step(at({place(kTop + 0.05)}));
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

// Each update goes on with one cycle; then short steps are tried, and that none goes is said: no
// update catches up for ever.
TEST(JammedTool, IsGivenUpAlsoWhenTimeIsOver) {
  Pipeline pipeline(block("elastic", 0.01), {}, {toolOf(boxOf(Vec3(0.1, 0.1, 0.02)))});
  pipeline.setBudget(0.0);
  pipeline.step(at({Vec3(kMiddle, kMiddle, kTop + 0.011)}));
  const RobotPose down = at({Vec3(kMiddle, kMiddle, 0.01)});
  int updates = 0;
  while (!pipeline.step(down).lost && updates < 10000) ++updates;
  EXPECT_LT(updates, 10000);
  EXPECT_TRUE(pipeline.report().lost);
  for (int late = 0; pipeline.report().late && late < 2000; ++late) pipeline.step(down);
  EXPECT_TRUE(pipeline.report().lost);
  EXPECT_FALSE(pipeline.step(down).changed);
}

// What is on its way into a jam is no longer gone on with.
TEST(JammedTool, GoesBackAtOnceAlsoWhereTimeIsOver) {
  Pipeline pipeline(block("elastic", 0.01), {}, {toolOf(boxOf(Vec3(0.1, 0.1, 0.02)))});
  const auto place = [](double height) { return at({Vec3(kMiddle, kMiddle, height + 0.01)}); };
  const auto height = [&] { return pipeline.pose()->links.front().translation().z(); };
  pipeline.step(place(kTop + 0.001));
  pipeline.step(place(0.5 * kTop));
  pipeline.setBudget(0.0);
  int goes_on = 0;
  for (int update = 0; update < 400 && goes_on < 60; ++update) {
    const double before = height();
    const bool behind = pipeline.step(place(-0.01)).too_fast;
    goes_on = behind && height() == before ? goes_on + 1 : 0;
  }
  ASSERT_EQ(goes_on, 60);
  const double jammed = height();
  int updates = 0;
  while (updates < 600 && height() <= jammed) {
    pipeline.step(place(kTop));
    ++updates;
  }
  EXPECT_LT(updates, 10);
}

// No solve meets this tolerance: each step is tried short, and costs cycles that lead nowhere.
TEST(JammedTool, IsGivenUpWhereNoSolveConverges) {
  SolverConfig solver;
  solver.tolerance = 1e-15;
  Pipeline pipeline(block("elastic", 0.01), solver, {probe()});
  pipeline.step(pressed(-0.001));
  const StepReport& report = pipeline.step(pressed(0.02));
  EXPECT_TRUE(report.lost);
  EXPECT_GT(pipeline.pose()->links.front().translation().z(), kTop + kRadius - 0.01);
  EXPECT_FALSE(pipeline.step(pressed(0.02)).changed);
}

// Thrown through the block to its lower edge, the box has no way to there that a shape follows;
// from outside it has.
TEST(JammedTool, ComesInAnewWhereItIsLostAgainAndAgain) {
  const ToolShape box = boxOf(Vec3(0.02, 0.025, 0.015));
  Pipeline pipeline(block("elastic", 0.01), {}, {withFriction(0.3, toolOf(box))});
  walk(pipeline, {{kMiddle, kMiddle, kTop + 0.01}}, {{kMiddle, kMiddle, kTop}}, 0.004);
  RobotPose pose = at({Vec3(0.045, 0.067, 0.001)});
  pose.links[0].rotate(Eigen::AngleAxisd(1.935, Vec3(0.583, -0.791, -0.185).normalized()));
  EXPECT_TRUE(pipeline.step(pose).lost);
  const auto follows = [&] {
    return !pipeline.report().lost && pipeline.tissue().lastReport().status == SolveStatus::kOk;
  };
  for (int update = 0; update < 12 && !follows(); ++update) {
    pose.links[0].translation().z() += 0.0005;
    pipeline.step(pose);
  }
  EXPECT_FALSE(pipeline.report().lost);
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
  pose.links[0].translation().z() += 0.2;
  pipeline.step(pose);
  for (const Vec3& moved : pipeline.tissue().state().displacement) EXPECT_EQ(moved, Vec3::Zero());
}

TEST(TwoTools, OnOppositeSidesOfASheetPressEachOther) {
  constexpr double kSmall = 0.006;
  Pipeline pipeline(sheet(), {}, {smallProbe("upper", kSmall), smallProbe("lower", kSmall)});
  const auto apart = [](double gap) {
    return std::vector<Vec3>{Vec3(kMiddle, 0.02, 0.5 * kSheet + 0.5 * gap + kSmall),
                             Vec3(kMiddle, 0.02, 0.5 * kSheet - 0.5 * gap - kSmall)};
  };
  walk(pipeline, apart(kSheet + 0.002), apart(0.6 * kSheet));
  const StepReport& report = pipeline.report();
  const Vec3 upper = report.tools[0].force_on_tool, lower = report.tools[1].force_on_tool;
  EXPECT_GT(upper.z(), 0.05);
  EXPECT_LT((upper + lower).norm(), 0.03 * upper.norm());
  for (const ToolReport& tool : report.tools) EXPECT_LT(tool.max_penetration, 0.05 * kSpacing);
  for (const Vec3& center : apart(0.6 * kSheet)) {
    expectOutside(pipeline.tissue(), center, kSmall);
  }
  EXPECT_LT(pipeline.forceBalance().unbalanced().norm(), 0.02 * upper.norm());
  walk(pipeline, apart(0.6 * kSheet), apart(kSheet + 0.002));
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

TEST(TwoTools, OneLeavesTheOtherStays) {
  Pipeline pipeline(block(), {}, {smallProbe("left", 0.006), smallProbe("right", 0.006)});
  const auto both = [](double left, double right) {
    return std::vector<Vec3>{Vec3(0.015, kMiddle, kTop + 0.006 - left),
                             Vec3(0.045, kMiddle, kTop + 0.006 - right)};
  };
  walk(pipeline, both(0.0, 0.0), both(0.003, 0.003));
  const StepReport& report = pipeline.report();
  ASSERT_GT(report.tools[0].force_on_tool.z(), 0.05);
  EXPECT_NEAR(report.tools[0].force_on_tool.z(), report.tools[1].force_on_tool.z(),
              0.03 * report.tools[0].force_on_tool.z());
  walk(pipeline, both(0.003, 0.003), both(0.003, -0.002));
  EXPECT_EQ(report.tools[1].force_on_tool, Vec3::Zero());
  EXPECT_TRUE(report.tools[1].nodes.empty());
  EXPECT_GT(report.tools[0].force_on_tool.z(), 0.05);
  walk(pipeline, both(0.003, -0.002), both(-0.002, -0.002));
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

TEST(TwoTools, RigidAndConformingOnesPressSideBySide) {
  ToolGeometry rigid = smallProbe("rigid", 0.006);
  rigid.patch = ToolConfig::Patch::kRigid;
  Pipeline pipeline(block(), {}, {rigid, smallProbe("conforming", 0.006)});
  const auto both = [](double depth) {
    return std::vector<Vec3>{Vec3(0.015, kMiddle, kTop + 0.006 - depth),
                             Vec3(0.045, kMiddle, kTop + 0.006 - depth)};
  };
  walk(pipeline, both(0.0), both(0.003));
  const auto& tools = pipeline.report().tools;
  EXPECT_GT(tools[1].force_on_tool.z(), 0.05);
  EXPECT_NEAR(tools[0].force_on_tool.z(), tools[1].force_on_tool.z(),
              0.6 * tools[1].force_on_tool.z())
      << "round rigid ones have no law";
  EXPECT_LT(tools[1].max_penetration, 0.05 * kSpacing);
  EXPECT_LT(pipeline.forceBalance().unbalanced().norm(), 0.02 * tools[1].force_on_tool.norm());
  walk(pipeline, both(0.003), both(-0.002));
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

// A tool far from the tissue that moves a lot takes no load steps, and is not what is too fast.
TEST(FarTool, IsNeverBehindNorMakesOthersSo) {
  Pipeline pipeline(block(), {}, {probe("near"), probe("far")});
  const auto pose = [](double depth, double away) {
    return at({pressed(depth).links.front().translation(), Vec3(away, 1.0, 1.0)});
  };
  for (double depth = -0.001; depth < 0.003; depth += 0.0005) pipeline.step(pose(depth, 0.0));
  const double force = pipeline.report().tools.front().force_on_tool.z();
  ASSERT_GT(force, 0.05);
  pipeline.setBudget(1e-9);
  EXPECT_FALSE(pipeline.step(pose(0.003, 0.3)).too_fast);
  EXPECT_TRUE(pipeline.step(pose(0.008, 0.0)).too_fast);
  EXPECT_EQ(pipeline.report().behind, std::vector<std::size_t>{0});
  pipeline.setBudget(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(pipeline.step(pose(0.008, 0.0)).too_fast);
  EXPECT_FALSE(pipeline.step(pose(0.008, 0.6)).too_fast);  // 600 load steps
  EXPECT_TRUE(pipeline.report().jumped.empty());
  EXPECT_GT(pipeline.report().tools.front().force_on_tool.z(), force);
}

// Nor does it make others let go where it jumps past the tissue.
TEST(JumpingTool, ComesInAnewAlone) {
  Pipeline pipeline(ridge(), {}, {ridgeGripper("gripper", 0.008, 0.012), probe("other")});
  const auto pose = [](double gap, double lift, double side) {
    std::vector<Vec3> origins = jawsOnRidge(gap, lift);
    origins.push_back(Vec3(side, 0.0, 0.3));
    return at(origins);
  };
  for (double gap = 0.016; gap > 0.0069; gap -= 0.0005) pipeline.step(pose(gap, 0.0, 0.3));
  for (double lift = 0.0; lift < 0.0041; lift += 0.0005) pipeline.step(pose(0.007, lift, 0.3));
  const StepReport& report = pipeline.report();
  ASSERT_TRUE(report.tools.front().grasps);
  const Vec3 pull = report.tools.front().force_on_tool;
  ASSERT_LT(pull.z(), -0.2);
  pipeline.step(pose(0.007, 0.004, -0.3));
  EXPECT_EQ(report.jumped, std::vector<std::size_t>{1});
  EXPECT_TRUE(report.tools.front().grasps);
  EXPECT_LT((report.tools.front().force_on_tool - pull).norm(), 0.01 * pull.norm());
  EXPECT_FALSE(pipeline.step(pose(0.007, 0.004, -0.3)).too_fast);
}

TEST(JumpingTool, LetsGoAndIsMetWhereItCame) {
  Pipeline pipeline(block(), {}, {probe(), probe("other")}), fresh(block(), {}, {probe()});
  const Vec3 stands(0.045, kMiddle, kTop + 0.0085);
  const auto pose = [&](const Vec3& probe) { return at({probe, stands}); };
  const Vec3 first(0.015, kMiddle, kTop + 0.008), second(0.015, kMiddle, 0.5);
  walk(pipeline, {first + Vec3(0.0, 0.0, 0.004), stands + Vec3(0.0, 0.0, 0.004)}, {first, stands});
  pipeline.step(pose(second));
  EXPECT_EQ(pipeline.report().jumped, std::vector<std::size_t>{0});
  EXPECT_EQ(pipeline.report().tools.front().force_on_tool, Vec3::Zero());
  walk(fresh, {stands + Vec3(0.0, 0.0, 0.004)}, {stands});
  const Vec3 alone = fresh.report().tools.front().force_on_tool;
  EXPECT_LT((pipeline.report().tools.back().force_on_tool - alone).norm(), 0.05 * alone.norm());
  pipeline.step(pose(first));
  EXPECT_EQ(pipeline.report().jumped, std::vector<std::size_t>{0});
  EXPECT_TRUE(pipeline.hasArrived());
  EXPECT_GT(pipeline.report().tools.front().force_on_tool.z(), 0.05);
  EXPECT_LT(pipeline.report().tools.front().max_penetration, 0.05 * kSpacing);
}

}  // namespace
}  // namespace robot_tissue::test_fast_tools
