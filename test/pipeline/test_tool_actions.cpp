// Tools that a force drives, and graspers.
#include <gtest/gtest.h>

#include <array>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_tool_actions {
namespace {

TEST_P(PressedBlock, DrivenToolMeetsItsForce) {
  pipeline_.step(pressed(-0.001));
  for (const double force : {0.1, 0.3, 0.2}) {
    pipeline_.push(0, Vec3(0.0, 0.0, -force));
    int updates = 0;
    while (updates < 20 && pipeline_.step(pressed(-0.001)).changed) ++updates;
    EXPECT_LT(updates, 20);
    EXPECT_NEAR(tool().force_on_tool.z(), force, 0.01 * force);
    EXPECT_LT(tool().offset.z(), -0.001);
    EXPECT_EQ(tool().offset.x(), 0.0);
    const Vec3 place = pipeline_.pose()->links.front().translation();
    EXPECT_LT((pressed(-0.001).links.front().translation() + tool().offset - place).norm(), 1e-12);
  }
  pipeline_.push(0, std::nullopt);
  pipeline_.step(pressed(-0.001));
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
  EXPECT_EQ(tool().offset, Vec3::Zero());
}

TEST(DrivenTool, KeepsItsForceWhileItsPoseGoesAside) {
  Pipeline pipeline(block(), {}, {withFriction(0.0, probe())});
  pipeline.step(pressed(-0.001));
  pipeline.push(0, Vec3(0.0, 0.0, -0.2));
  for (int i = 0; i < 10; ++i) pipeline.step(pressed(-0.001));
  for (int i = 1; i <= 5; ++i) {
    pipeline.step(pressed(-0.001, kMiddle + 0.001 * i));
    EXPECT_NEAR(pipeline.report().tools.front().force_on_tool.z(), 0.2, 0.01 * 0.2);
  }
}

// Its way counts from where it was told to be, not from where it was driven.
TEST(DrivenTool, StaysWhereItIsWhileTimePasses) {
  Pipeline pipeline(block(), {}, {probe()});
  pipeline.step(pressed(-0.001));
  pipeline.push(0, Vec3(0.0, 0.0, -0.2));
  for (int i = 0; i < 20 && pipeline.step(pressed(-0.001)).changed; ++i) {
  }
  const Vec3 place = pipeline.pose()->links.front().translation();
  for (int i = 0; i < 3; ++i) {
    pipeline.wait(0.1);
    EXPECT_LT((pipeline.pose()->links.front().translation() - place).norm(), 1e-5) << i;
    EXPECT_NEAR(pipeline.report().tools.front().force_on_tool.z(), 0.2, 0.01 * 0.2) << i;
  }
}

// As where time goes back; then it comes in anew, and goes on.
TEST(DrivenTool, IsNowhereWhereItsPoseIsWhereverItsForcePoints) {
  for (const double aside : {-0.02, 0.0, 0.02}) {
    Pipeline pipeline(block(), {}, {probe()});
    pipeline.step(pressed(-0.001));
    pipeline.push(0, Vec3(aside, aside, -0.2));
    const auto follow = [&](const RobotPose& pose) {
      for (int i = 0; i < 20 && pipeline.step(pose).changed; ++i) {
      }
      return pipeline.report().tools.front();
    };
    EXPECT_GT(follow(pressed(-0.001)).contacts, 0) << aside;
    EXPECT_EQ(follow(RobotPose()).contacts, 0) << aside;
    EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0) << aside;
    EXPECT_TRUE(pipeline.pose()->links.front().isApprox(Pipeline::away(), 0.0)) << aside;
    EXPECT_FALSE(pipeline.report().changed || pipeline.report().too_fast) << aside;
    EXPECT_NEAR(follow(pressed(-0.001)).force_on_tool.norm(), 0.2, 0.02) << aside;
  }
}

TEST(DrivenTool, ThatFindsNothingStops) {
  Pipeline pipeline(block(), {}, {probe()});
  pipeline.step(pressed(-0.01));
  pipeline.push(0, Vec3(0.0, 0.0, 0.1));  // away from the tissue
  int updates = 0;
  while (updates < 50 && pipeline.step(pressed(-0.01)).changed) ++updates;
  EXPECT_LT(updates, 50);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

// Not where it was to go to, which is deeper.
TEST(DrivenTool, IsToldWhereItCameToWhereNoShapeFollows) {
  ToolShape sphere;
  sphere.radius = 0.008;
  TissueConfig tissue = block();
  tissue.shape.max().z() = 0.03;
  Pipeline pipeline(tissue, {}, {toolOf(sphere)});
  const RobotPose above = at({Vec3(kMiddle + 0.0037, kMiddle + 0.0061, 0.0375)});
  walk(pipeline, {Vec3(kMiddle + 0.0037, kMiddle + 0.0061, 0.04)},
       {above.links.front().translation()});
  bool is_lost = false;
  for (const double force : {10.0, 30.0, 60.0, 120.0, 240.0}) {
    pipeline.push(0, Vec3(0.0, 0.0, -force));
    for (int i = 0; i < 200 && pipeline.step(above).changed; ++i) {
    }
    is_lost = is_lost || pipeline.report().lost;
    const Vec3 came = pipeline.pose()->links.front().translation();
    const Vec3 offset = pipeline.report().tools.front().offset;
    EXPECT_LT((above.links.front().translation() + offset - came).norm(), 1e-12) << force;
  }
  ASSERT_TRUE(is_lost);
}

TEST(DrivenTool, ForceThatIsZeroOrNotFiniteIsRefused) {
  Pipeline pipeline(block(), {}, {probe()});
  EXPECT_THROW(pipeline.push(0, Vec3::Zero()), InputError);
  EXPECT_THROW(pipeline.push(0, Vec3(0.0, 0.0, NAN)), InputError);
}

// Two plates that close on the ridge along y.
class Grasper : public ::testing::TestWithParam<const char*> {
 protected:
  static constexpr double kCloseGap = 0.0085, kOpenGap = 0.0095;

  static ToolGeometry gripper(double max_force = 0.0) {
    ToolGeometry tool = ridgeGripper("gripper", kCloseGap, kOpenGap);
    tool.grasp.max_force = max_force;
    return tool;
  }
  static SolverConfig solver() {
    SolverConfig solver;
    solver.method = GetParam();
    return solver;
  }
  void close(Pipeline& pipeline) const { walk(pipeline, jawsOnRidge(0.014), jawsOnRidge(0.008)); }
};

TEST_P(Grasper, LiftsWhatIsBetweenItsJawsAndLetsGo) {
  Pipeline pipeline(ridge(), solver(), {gripper()});
  const auto tool = [&]() -> const ToolReport& { return pipeline.report().tools.front(); };
  close(pipeline);
  ASSERT_TRUE(tool().grasps);
  EXPECT_GT(tool().nodes.size(), 10u);
  EXPECT_FALSE(tool().jaws_overlap);
  const Lattice& lattice = pipeline.tissue().lattice();
  const int held = lattice.node(3, 1, 5);
  const double before = pipeline.tissue().nodePosition(held).z();
  walk(pipeline, jawsOnRidge(0.008), jawsOnRidge(0.008, 0.004));
  EXPECT_NEAR(pipeline.tissue().nodePosition(held).z(), before + 0.004, 1e-6);
  EXPECT_LT(tool().force_on_tool.z(), -0.05);  // the tissue draws it down
  const ForceBalance balance = pipeline.forceBalance();
  EXPECT_LT((balance.tools + tool().force_on_tool).norm(), 1e-9);
  EXPECT_LT((balance.tools + balance.fixed).norm(), 0.02 * balance.tools.norm());
  walk(pipeline, jawsOnRidge(0.008, 0.004), jawsOnRidge(0.016, 0.004));
  EXPECT_FALSE(tool().grasps);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
  EXPECT_EQ(tool().force_on_tool, Vec3::Zero());
}

TEST_P(Grasper, HoldsAndLetsGoWhenItIsTold) {
  ToolGeometry open = gripper();
  open.grasp.close_gap = 0.0;
  open.grasp.open_gap = 1.0;
  Pipeline pipeline(ridge(), solver(), {open});
  EXPECT_THROW(pipeline.grasp(0), InputError);  // it stands nowhere
  close(pipeline);
  EXPECT_FALSE(pipeline.report().tools.front().grasps);
  pipeline.grasp(0);
  EXPECT_TRUE(pipeline.report().tools.front().grasps) << "told at once, with no update";
  EXPECT_GT(pipeline.report().tools.front().nodes.size(), 0U);
  walk(pipeline, jawsOnRidge(0.008), jawsOnRidge(0.008, 0.003));
  EXPECT_TRUE(pipeline.report().tools.front().grasps);
  EXPECT_LT(pipeline.report().tools.front().force_on_tool.z(), -0.05);
  pipeline.letGo(0);
  EXPECT_FALSE(pipeline.report().tools.front().grasps);
  walk(pipeline, jawsOnRidge(0.008, 0.003), jawsOnRidge(0.016, 0.003));
  EXPECT_FALSE(pipeline.report().tools.front().grasps);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

TEST_P(Grasper, PulledTooHardItLosesTheTissue) {
  constexpr double kMost = 0.2;
  Pipeline pipeline(ridge(), solver(), {gripper(kMost)});
  close(pipeline);
  ASSERT_TRUE(pipeline.report().tools.front().grasps);
  bool torn = false;
  for (int i = 1; i <= 40 && !torn; ++i) {
    torn = !pipeline.step(at(jawsOnRidge(0.008, 0.0005 * i))).torn_off.empty();
    EXPECT_LE(pipeline.report().tools.front().force_on_tool.norm(), kMost + 1e-9);
  }
  EXPECT_TRUE(torn);
  EXPECT_FALSE(pipeline.report().tools.front().grasps);
}

TEST_P(Grasper, PulledTooHardItTakesOutWhatItHolds) {
  ToolGeometry tool = gripper(0.2);
  tool.grasp.tears_out = true;
  Pipeline pipeline(ridge(), solver(), {tool});
  close(pipeline);
  ASSERT_TRUE(pipeline.report().tools.front().grasps);
  std::vector<std::size_t> torn_out;
  double height = 0.0;
  while (torn_out.empty() && height < 0.02) {
    torn_out = pipeline.step(at(jawsOnRidge(0.008, height += 0.0005))).torn_out;
  }
  ASSERT_EQ(torn_out.size(), 1U);
  EXPECT_GT(pipeline.report().springs_torn, 0);
  const Tissue& tissue = pipeline.tissue();
  EXPECT_EQ(tissue.state().pieces, 2);
  EXPECT_EQ(tissue.undoable(), 1);
  // It stays in the jaws, without the rest of the tissue.
  const std::vector<int> nodes = pipeline.report().tools.front().nodes;
  ASSERT_FALSE(nodes.empty());
  const double before = tissue.nodePosition(nodes.front()).z();
  walk(pipeline, jawsOnRidge(0.008, height), jawsOnRidge(0.008, height + 0.01));
  EXPECT_TRUE(pipeline.report().tools.front().grasps);
  EXPECT_NEAR(tissue.nodePosition(nodes.front()).z(), before + 0.01, 1e-6);
  EXPECT_LT(pipeline.report().tools.front().force_on_tool.norm(), 1e-3);
  const std::vector<int> pieces = tissue.pieceOfNodes();
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    if (pieces[at(node)] == pieces[at(nodes.front())]) continue;
    EXPECT_LT(tissue.state().displacement[at(node)].norm(), 1e-4);
  }
  pipeline.undo(1);
  EXPECT_EQ(tissue.state().pieces, 1);
}

TEST_P(Grasper, CannotHoldWhatIsNotThere) {
  Pipeline pipeline(ridge(), solver(), {gripper()});
  pipeline.step(at(jawsOnRidge(0.014, 0.05)));
  EXPECT_THROW(pipeline.grasp(0), InputError);
  pipeline.step(at(jawsOnRidge(0.014, 0.051)));
  EXPECT_EQ(pipeline.report().tools.front().holds_nothing, "") << "open jaws need hold nothing";
  Pipeline pusher(ridge(), solver(), {probe()});
  pusher.step(pressed(-0.01));
  EXPECT_THROW(pusher.grasp(0), InputError);
}

// What a load moves, by a force or not, is the load's.
TEST_P(Grasper, CannotHoldWhatALoadMoves) {
  ToolGeometry wide = gripper();
  wide.grasp.close_gap = 0.012;
  wide.grasp.open_gap = 0.013;
  for (const bool by_force : {true, false}) {
    Pipeline pipeline(ridge(), solver(), {wide});
    LoadStep load;
    load.patches.push_back({});
    PatchConfig& patch = load.patches.front();
    patch.name = "load";
    patch.box = {Vec3(-1.0, -1.0, 0.014), Vec3(1.0, 1.0, 1.0)};
    if (by_force) {
      patch.force = Vec3(0.0, 0.0, -0.01);
    } else {
      patch.displacement = {{0.0, 0.0, -0.0001}};
    }
    pipeline.step(at(jawsOnRidge(0.014)));
    pipeline.load(load);
    pipeline.step(at(jawsOnRidge(0.0084)));
    EXPECT_FALSE(pipeline.report().tools.front().grasps) << by_force;
    EXPECT_THROW(pipeline.grasp(0), InputError) << by_force;
    EXPECT_NE(pipeline.report().tools.front().holds_nothing.find("held by others"),
              std::string::npos)
        << by_force << ": " << pipeline.report().tools.front().holds_nothing;
  }
}

// However fast they close, what they hold has been pressed aside, not been left within them.
TEST_P(Grasper, TissueStaysOutOfJawsThatCloseFastAndOn) {
  Pipeline pipeline(ridge(), solver(), {gripper()});
  const auto tool = [&]() -> const ToolReport& { return pipeline.report().tools.front(); };
  pipeline.step(at(jawsOnRidge(0.014)));
  for (const double gap : {0.008, 0.007, 0.006}) {
    pipeline.step(at(jawsOnRidge(gap)));
    ASSERT_TRUE(tool().grasps);
    EXPECT_LT(tool().max_penetration, 0.05 * kSpacing) << gap;
  }
}

// What they hold is squeezed on, and stretched again, all of it alike.
TEST_P(Grasper, JawsThatCloseOnSqueezeAllThatTheyHoldAlike) {
  Pipeline pipeline(ridge(), solver(), {gripper()});
  const auto layers = [&] {
    const Tissue& tissue = pipeline.tissue();
    std::array<double, 2> thickness;
    for (int j = 0; j < 2; ++j) {
      const int here = tissue.lattice().node(3, j, 5), next = tissue.lattice().node(3, j + 1, 5);
      thickness[at(j)] = (tissue.nodePosition(next) - tissue.nodePosition(here)).norm();
    }
    return thickness;
  };
  close(pipeline);
  ASSERT_TRUE(pipeline.report().tools.front().grasps);
  const std::array<double, 2> before = layers();
  walk(pipeline, jawsOnRidge(0.008), jawsOnRidge(0.005));
  ASSERT_TRUE(pipeline.report().tools.front().grasps);
  const std::array<double, 2> after = layers();
  for (std::size_t layer = 0; layer < before.size(); ++layer) {
    EXPECT_NEAR(after[layer] / before[layer], 5.0 / 8.0, 0.01) << layer;
  }
}

// With `newton` it takes half a minute.
class RigidGrasper : public Grasper {};

TEST_P(RigidGrasper, HoldsWhatItHasPressedAside) {
  ToolGeometry rigid = gripper();
  rigid.patch = ToolConfig::Patch::kRigid;
  Pipeline pipeline(ridge(), solver(), {rigid});
  close(pipeline);
  ASSERT_TRUE(pipeline.report().tools.front().grasps);
  walk(pipeline, jawsOnRidge(0.008), jawsOnRidge(0.008, 0.003));
  EXPECT_TRUE(pipeline.report().tools.front().grasps);
  EXPECT_LT(pipeline.report().tools.front().max_penetration, 0.05 * kSpacing);
  EXPECT_LT(pipeline.report().tools.front().force_on_tool.z(), -0.15);  // 0.35 of conforming ones
}

// Whatever it is asked for, what it tells is a shape that tissue has: jaws that close on, and leave
// the tissue no way.
TEST_P(RigidGrasper, KeepsTheLastGoodShapeWhereNoneFollows) {
  ToolGeometry rigid = gripper();
  rigid.patch = ToolConfig::Patch::kRigid;
  Pipeline pipeline(ridge(), solver(), {rigid});
  double pressed = 0.0;
  bool lost = false;
  for (int i = 0; i <= 28 && !lost; ++i) {
    const StepReport& report = pipeline.step(at(jawsOnRidge(0.014 - 0.0005 * i)));
    const ToolReport& tool = report.tools.front();
    EXPECT_EQ(pipeline.tissue().lastReport().inverted_cells, 0);
    EXPECT_LT(tool.force_on_tool.norm(), 5.0);  // N: E times the area of a jaw
    lost = report.lost;
    if (!lost) pressed = greatestDisplacement(pipeline.tissue());
  }
  ASSERT_TRUE(lost);
  EXPECT_GT(pressed, 0.0005);
  EXPECT_GE(greatestDisplacement(pipeline.tissue()), 0.9 * pressed);
}

// Its jaws come back around the ridge, not down on it.
TEST_P(Grasper, ThatAppearsClosedAroundTissueHoldsIt) {
  Pipeline pipeline(ridge(), solver(), {gripper()});
  pipeline.step(at(jawsOnRidge(0.008)));
  const auto tool = [&]() -> const ToolReport& { return pipeline.report().tools.front(); };
  EXPECT_EQ(pipeline.report().were_inside, std::vector<std::size_t>{0});
  EXPECT_TRUE(tool().grasps);
  Pipeline watched(ridge(), solver(), {gripper()});
  close(watched);
  EXPECT_LT(relativeDifference(pipeline.tissue(), watched.tissue()), 0.15);
  walk(pipeline, jawsOnRidge(0.008), jawsOnRidge(0.008, 0.003));
  EXPECT_LT(tool().force_on_tool.z(), -0.05);
}

TEST_P(Grasper, ThatCannotCloseOnTissueKeepsTheLastGoodShape) {
  Pipeline pipeline(ridge(), solver(), {gripper()});
  walk(pipeline, jawsOnRidge(0.014), jawsOnRidge(0.006));
  const std::vector<Vec3> outside = jawsOnRidge(-0.001);
  pipeline.step(at(outside));
  ASSERT_TRUE(pipeline.report().lost);
  EXPECT_EQ(pipeline.report().behind, std::vector<std::size_t>{0});
  EXPECT_TRUE(pipeline.report().tools.front().jaws_overlap);
  EXPECT_EQ(pipeline.tissue().lastReport().inverted_cells, 0);
  const auto shape = pipeline.tissue().state().displacement;
  pipeline.step(at(jawsOnRidge(-0.0015)));
  EXPECT_EQ(pipeline.tissue().state().displacement, shape);
  walk(pipeline, outside, jawsOnRidge(0.016), 0.001);
  EXPECT_FALSE(pipeline.report().tools.front().jaws_overlap);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

// Pressed down at some distance along the ridge from the middle of the jaws, which hold it (m).
double depthBesideJaws(const std::string& method, double along) {
  TissueConfig tissue = ridge();
  tissue.shape = Box(Vec3(-0.03, -0.01, 0.0), Vec3(0.03, 0.01, kRidgeTop));
  tissue.fixed = {bottomOf(tissue.shape)};
  ToolGeometry gripper = ridgeGripper("gripper", 0.016, 0.018);
  for (LinkGeometry& jaw : gripper.links) jaw.shapes.front().size.x() = 0.02;
  ToolShape ball;
  ball.radius = 0.006;
  SolverConfig solver;
  solver.method = method;
  Pipeline pipeline(tissue, solver, {gripper, withFriction(0.2, toolOf(ball))});
  const auto places = [&](double gap, double z) -> std::vector<Vec3> {
    return {Vec3(0.0, -0.5 * gap, 0.026), Vec3(0.0, 0.5 * gap, 0.026), Vec3(along, 0.0, z)};
  };
  walk(pipeline, places(0.026, 0.045), places(0.0135, 0.045), 0.001);
  EXPECT_TRUE(pipeline.report().tools.front().grasps);
  walk(pipeline, places(0.0135, 0.045), places(0.0135, 0.029), 0.001);
  EXPECT_FALSE(pipeline.report().lost);
  return pipeline.report().tools.back().max_penetration;
}

TEST_P(Grasper, HoldsTissueThatOthersPressBesideIt) {
  EXPECT_LT(depthBesideJaws(GetParam(), 0.02), 2e-4);
}

INSTANTIATE_TEST_SUITE_P(Method, RigidGrasper, ::testing::Values("layered"),
                         [](const auto& row) { return std::string(row.param); });
INSTANTIATE_TEST_SUITE_P(Method, Grasper, ::testing::Values("layered", "newton"),
                         [](const auto& row) { return std::string(row.param); });

}  // namespace
}  // namespace robot_tissue::test_tool_actions
