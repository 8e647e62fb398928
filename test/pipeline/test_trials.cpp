// Trial steps: what they do is undone, and nothing that follows depends on them.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "pipeline_fixtures.h"
#include "robot_tissue/core/compat.h"

namespace robot_tissue::test_trials {
namespace {

void expectSameBits(const Vec3& one, const Vec3& other, const std::string& what) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(one[axis], other[axis]) << what;
}

void expectSameBits(const Pipeline& one, const Pipeline& other, const std::string& when) {
  EXPECT_TRUE(one.tissue().state().displacement == other.tissue().state().displacement) << when;
  EXPECT_EQ(one.report().substeps, other.report().substeps) << when;
  EXPECT_EQ(one.report().changed, other.report().changed) << when;
  EXPECT_EQ(one.hasArrived(), other.hasArrived()) << when;
  EXPECT_EQ(one.tissue().lastReport().iterations, other.tissue().lastReport().iterations) << when;
  ASSERT_EQ(one.report().tools.size(), other.report().tools.size());
  for (std::size_t tool = 0; tool < one.tools().size(); ++tool) {
    const ToolReport& here = one.report().tools[tool];
    const ToolReport& there = other.report().tools[tool];
    expectSameBits(here.force_on_tool, there.force_on_tool, when + ": force");
    expectSameBits(here.torque_on_tool, there.torque_on_tool, when + ": torque");
    expectSameBits(here.point, there.point, when + ": point");
    expectSameBits(here.offset, there.offset, when + ": offset");
    EXPECT_EQ(here.max_penetration, there.max_penetration) << when;
    EXPECT_EQ(here.contacts, there.contacts) << when;
    EXPECT_EQ(here.grasps, there.grasps) << when;
    EXPECT_EQ(here.holds_nothing, there.holds_nothing) << when;
  }
}

void tryAt(Pipeline& pipeline, const RobotPose& pose) {
  pipeline.beginTrial();
  pipeline.step(pose);
  pipeline.undoTrial();
}

using Poses = std::vector<RobotPose>;

// Both follow the poses; the second one tries a pose of its own before each.
void expectNothingLeft(Pipeline& plain, Pipeline& tried, const Poses& poses, const Poses& trials) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    tryAt(tried, trials[i % trials.size()]);
    plain.step(poses[i]);
    tried.step(poses[i]);
    expectSameBits(plain, tried, "pose " + std::to_string(i));
  }
}

TEST_P(PressedBlock, ATrialLeavesNothing) {
  Pipeline plain = anotherPipeline();
  expectNothingLeft(plain, pipeline_,
                    {pressed(-0.001), pressed(0.0015), pressed(0.002, 0.031), pressed(-0.001)},
                    {pressed(0.001), pressed(0.004, 0.028), at({Pipeline::away().translation()}),
                     pressed(-0.05, 0.3)});
}

TEST_P(PressedBlock, ATrialBeforeTheFirstPoseLeavesNothing) {
  tryAt(pipeline_, pressed(0.003));
  EXPECT_FALSE(pipeline_.pose().has_value());
  Pipeline plain = anotherPipeline();
  plain.step(pressed(0.002));
  pipeline_.step(pressed(0.002));
  expectSameBits(plain, pipeline_, "first pose");
}

// What rims bear is steadied from solve to solve.
TEST(Trial, OfAFlatToolLeavesNothingToALoad) {
  const ToolGeometry box = withFriction(0.1, toolOf(boxOf(Vec3(0.02, 0.02, 0.02))));
  const auto place = [](double depth, double x) {
    return at({Vec3(x, kMiddle + 0.001, kTop + 0.01 - depth)});
  };
  Pipeline plain(block(), methodOf("elastic"), {box}), tried(block(), methodOf("elastic"), {box});
  expectNothingLeft(plain, tried, {place(-0.001, 0.031), place(0.001, 0.031), place(0.002, 0.032)},
                    {place(0.003, 0.033), place(0.0005, 0.029)});
  PatchConfig pulled;
  pulled.name = "pulled";
  pulled.box = {Vec3(0.0, 0.0, kTop), Vec3(0.01, 0.01, kTop)};
  pulled.displacement = {{0.0, 0.0, 0.002}};
  tryAt(tried, place(0.003, 0.034));
  for (Pipeline* pipeline : {&plain, &tried}) pipeline->load({1, {pulled}});
  expectSameBits(plain, tried, "load");
}

TEST(Trial, OfADrivenToolLeavesNothing) {
  Pipeline plain(block(), methodOf("elastic"), {probe()});
  Pipeline tried(block(), methodOf("elastic"), {probe()});
  for (Pipeline* pipeline : {&plain, &tried}) {
    pipeline->step(pressed(-0.001));
    pipeline->push(0, Vec3(0.0, 0.0, -0.2));
  }
  expectNothingLeft(plain, tried, Poses(4, pressed(-0.001)), {pressed(-0.002), pressed(0.001)});
}

// Its edge, which is looked for only where it may touch, is far off, dents and is inside in turn.
TEST(Trial, OfABladeLeavesNothing) {
  ToolGeometry knife;
  knife.name = "knife";
  knife.role = toolRole("blade");
  knife.links.push_back({"knife", {boxOf(Vec3(0.0008, 0.028, 0.02), Vec3(0.0, 0.0, 0.01))}});
  knife.blade.edge = {Vec3(0.0, -0.014, 0.0), Vec3(0.0, 0.014, 0.0)};
  knife.blade.resistance = 200.0;
  const auto over = [](double height) { return at({Vec3(0.0313, 0.03, kTop + height)}); };
  Pipeline plain(block(), methodOf("elastic"), {knife});
  Pipeline tried(block(), methodOf("elastic"), {knife});
  expectNothingLeft(plain, tried,
                    {over(0.05), over(0.002), over(-0.001), over(-0.002), over(-0.012), over(0.03)},
                    {over(-0.001), over(0.04), over(-0.006)});
  EXPECT_GT(tried.tissue().state().springs_cut, 0);
}

// Jaws that close on a ridge in the trial alone.
TEST(Trial, OfAGrasperLeavesNothing) {
  const ToolGeometry tool = ridgeGripper("grasper", 0.0085, 0.0095);
  const auto jaws = [](double gap) { return at(jawsOnRidge(gap)); };
  Pipeline plain(ridge(), {}, {tool}), tried(ridge(), {}, {tool});
  expectNothingLeft(plain, tried, {jaws(0.014), jaws(0.0098), jaws(0.008), jaws(0.016)},
                    {jaws(0.0075), jaws(0.0075), jaws(0.011)});
}

// Where a tool is near in two steps, the solver's levels are made: not in the first one, though it
// came near in a trial before.
TEST(Trial, InWhichAToolComesNearMakesNoLevels) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer has a heap of its own";
#endif
  if (compat::heapInUse() == 0.0) GTEST_SKIP() << "this heap does not tell";
  TissueConfig tissue = block("elastic", 0.0025);
  tissue.shape.max() = Vec3(0.1, 0.1, 0.05);
  const auto above = [](double height) { return at({Vec3(0.05, 0.05, 0.05 + kRadius + height)}); };
  Pipeline pipeline(tissue, SolverConfig(), {probe()});
  const double nodes = pipeline.tissue().lattice().nodeCount();
  pipeline.step(above(0.1));
  tryAt(pipeline, above(0.001));
  const double before = compat::heapInUse();
  pipeline.step(above(0.0015));
  const double came_near = compat::heapInUse();
  pipeline.step(above(0.001));
  const double levels = 50.0 * nodes;  // bytes; they take more
  EXPECT_LT(came_near - before, 0.2 * levels);
  EXPECT_GT(compat::heapInUse() - came_near, levels);
}

TEST(Trial, EndsWithAResetOrOtherTools) {
  ToolGeometry knife;
  knife.name = "knife";
  knife.role = toolRole("blade");
  knife.links.push_back({"knife", {}});
  knife.blade.edge = {Vec3(0.0, -0.05, 0.0), Vec3(0.0, 0.05, 0.0)};
  const auto over = [](double height) { return at({Vec3(0.0313, 0.03, kTop + height)}); };
  const std::vector<std::function<void(Pipeline&)>> ends = {
      [](Pipeline& pipeline) { pipeline.reset(); },
      [&](Pipeline& pipeline) { pipeline.setTools({knife}); }};
  for (const auto& end : ends) {
    Pipeline pipeline(block(), methodOf("elastic"), {knife});
    pipeline.beginTrial();
    pipeline.step(over(0.01));
    end(pipeline);
    pipeline.undoTrial();
    EXPECT_FALSE(pipeline.pose().has_value());
    pipeline.step(over(0.01));
    pipeline.step(over(-0.02));
    EXPECT_GT(pipeline.tissue().state().springs_cut, 0);
  }
}

}  // namespace
}  // namespace robot_tissue::test_trials
