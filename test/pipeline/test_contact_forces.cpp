// What tools with conforming contact meet: friction, wrenches, and the balance of all forces.
#include <gtest/gtest.h>

#include "pipeline_fixtures.h"
#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/pipeline/touch_pressure.h"

namespace robot_tissue::test_contact_forces {
namespace {

Vec3 forceOnTissue(const Pipeline& pipeline, std::size_t tool = 0) {
  return -(pipeline.pose()->links[tool].linear() * pipeline.report().tools[tool].force_on_tool);
}

class WithEachMethod : public ::testing::TestWithParam<const char*> {
 protected:
  static SolverConfig solver() {
    SolverConfig solver;
    solver.method = GetParam();
    return solver;
  }
};

TEST_P(WithEachMethod, ForcesBalance) {
  Pipeline pipeline(block("elastic", 0.01), solver(), {probe()});
  walk(pipeline, -0.001, 0.006, 0.001);
  const ForceBalance balance = pipeline.forceBalance();
  const double force = forceOnTissue(pipeline).norm();
  ASSERT_GT(force, 0.1);
  EXPECT_LT((balance.tools - forceOnTissue(pipeline)).norm(), 1e-9 * force);
  EXPECT_LT(balance.unbalanced().norm(), 0.02 * force);
  EXPECT_TRUE(balance.supports.isZero() && balance.loads.isZero() && balance.weight.isZero());
}

// A node tells wrenches first: they are those of a pipeline that looks for depths at once.
TEST(Depths, AreLookedForWhenAskedForWhereTheyAreLeft) {
  Pipeline at_once(block("elastic"), {}, {probe()}), leaving(block("elastic"), {}, {probe()});
  leaving.leaveDepths();
  double deepest = 0.0;
  for (int update = 0; update < 12; ++update) {
    const RobotPose pose = pressed(0.0005 * update);
    const ToolReport expected = at_once.step(pose).tools[0];
    const ToolReport left = leaving.step(pose).tools[0];
    EXPECT_EQ(left.force_on_tool, expected.force_on_tool);
    EXPECT_EQ(left.max_penetration, 0.0);
    leaving.findDepths();
    EXPECT_EQ(leaving.report().tools[0].max_penetration, expected.max_penetration);
    deepest = std::max(deepest, expected.max_penetration);
  }
  EXPECT_GT(deepest, 0.0);
}

TEST_P(WithEachMethod, ForcesBalanceWithLoadsAndWeight) {
  TissueConfig tissue = block("elastic", 0.01);
  tissue.gravity = Vec3(0.0, 0.0, -9.81);
  Pipeline pipeline(tissue, solver(), {probe()});
  pipeline.settle();
  PatchConfig patch;
  patch.name = "punch";
  patch.box = {Vec3(0.0, 0.0, kTop), Vec3(0.01, kWidth, kTop)};
  patch.force = Vec3(0.05, 0.0, -0.1);
  pipeline.load({{}, {patch}});
  walk(pipeline, -0.001, 0.006, 0.001);
  const ForceBalance balance = pipeline.forceBalance();
  const double force = balance.tools.norm();
  ASSERT_GT(force, 0.1);
  EXPECT_LT((balance.loads - *patch.force).norm(), 0.02 * force);
  EXPECT_NEAR(balance.weight.z(), -9.81 * 1000.0 * kWidth * kWidth * kTop, 1e-9);
  EXPECT_LT(balance.unbalanced().norm(), 0.02 * force);
}

TEST_P(WithEachMethod, MethodsAgreeAboutTheForce) {
  Pipeline pipeline(block("elastic", 0.01), solver(), {probe()});
  SolverConfig newton;
  newton.method = "newton";
  Pipeline exact(block("elastic", 0.01), newton, {probe()});
  walk(pipeline, -0.001, 0.006, 0.001);
  walk(exact, -0.001, 0.006, 0.001);
  const Vec3 force = forceOnTissue(exact);
  EXPECT_LT((forceOnTissue(pipeline) - force).norm(), 0.03 * force.norm());
}

INSTANTIATE_TEST_SUITE_P(Method, WithEachMethod, ::testing::Values("layered", "newton"),
                         [](const auto& row) { return std::string(row.param); });

TEST(TouchPressures, TimesTheirAreasAddUpToTheNormalForces) {
  Pipeline pipeline(block("elastic", 0.01), {}, {probe()});
  const auto total = [&] {
    const std::vector<double> pressures = touchPressures(pipeline);
    const Tissue& tissue = pipeline.tissue();
    double sum = 0.0;
    for (const MeshTriangle& triangle : tissue.surface().triangles) {
      const double third = doubleArea(tissue.vertices(), triangle).norm() / 6.0;
      for (const int vertex : triangle) sum += third * pressures[at(vertex)];
    }
    return sum;
  };
  EXPECT_EQ(total(), 0.0);
  walk(pipeline, -0.001, 0.006, 0.001);
  double pressed = 0.0;
  for (const ToolTouch& touch : pipeline.touchesOf(0)) pressed += touch.normal_force;
  ASSERT_GT(pressed, 0.1);
  EXPECT_NEAR(total(), pressed, 1e-9 * pressed);
}

// Of all ways to hold on to the tissue, dragged sideways so that friction acts, too.
TEST(Touches, AddUpToTheForceOfTheTool) {
  for (const auto patch : {ToolConfig::Patch::kConforming, ToolConfig::Patch::kRigid}) {
    ToolGeometry tool = probe();
    tool.patch = patch;
    Pipeline pipeline(block("elastic", 0.01), {}, {tool});
    EXPECT_TRUE(pipeline.touchesOf(0).empty());
    walk(pipeline, -0.001, 0.006, 0.001);
    const Vec3 down(kMiddle, kMiddle, kTop + kRadius - 0.006);
    walk(pipeline, {down}, {down + Vec3(0.003, 0.0, 0.0)}, 0.001);
    const std::vector<ToolTouch> touches = pipeline.touchesOf(0);
    const bool slides = patch == ToolConfig::Patch::kConforming;
    Vec3 sum = Vec3::Zero();
    double pressed = 0.0, dragged = 0.0;
    for (const ToolTouch& touch : touches) {
      sum += touch.normal_force * touch.normal + touch.friction_force;
      EXPECT_NEAR(touch.normal.norm(), 1.0, 1e-12);
      EXPECT_NEAR(touch.friction_force.dot(touch.normal), 0.0, 1e-9);
      EXPECT_LT((touch.point - down).norm(), kRadius + 0.01);
      if (!slides) continue;
      EXPECT_GE(touch.normal_force, 0.0);
      pressed += touch.normal_force;
      dragged += touch.friction_force.norm();
      EXPECT_LT(std::abs(touch.depth_m), 1e-4);
      EXPECT_NEAR((touch.point - pipeline.pose()->links[0].translation()).norm(), kRadius, 5e-4);
    }
    const Vec3 force = forceOnTissue(pipeline);
    ASSERT_GT(force.norm(), 0.1);
    EXPECT_GT(force.x(), 0.02);
    EXPECT_LT((sum - force).norm(), 1e-5 * force.norm()) << "slides: " << slides;
    EXPECT_LE(dragged, 1.05 * 0.3 * pressed);
  }
}

// A plane that covers the whole top is drawn along it until all of it slides.
TEST(FrictionCone, PlaneThatSlidesDragsWithItsFriction) {
  for (const double friction : {0.0, 0.1, 0.3}) {
    Pipeline pipeline(block("elastic", 0.01), {}, {withFriction(friction, toolOf(planeOf(false)))});
    const Vec3 above(kMiddle, kMiddle, kTop + 0.001), down(kMiddle, kMiddle, kTop - 0.003);
    walk(pipeline, {above}, {down});
    walk(pipeline, {down}, {down + Vec3(0.015, 0.0, 0.0)}, 0.001);
    const Vec3 force = forceOnTissue(pipeline);
    ASSERT_LT(force.z(), -1.0);
    EXPECT_NEAR(force.x(), -friction * force.z(), 0.05 * friction * -force.z() + 1e-3)
        << "friction " << friction;
    EXPECT_LT(std::abs(force.y()), 0.01 * -force.z());
  }
}

// What it ploughs is what it meets without friction.
TEST(FrictionCone, SphereThatSlidesDragsWithItsFriction) {
  constexpr double kFriction = 0.3;
  SolverConfig exact;  // the forces of the default tolerance are off by about what is allowed here
  exact.tolerance = 1e-3;
  Pipeline rough(block(), exact, {withFriction(kFriction, probe())});
  Pipeline smooth(block(), exact, {withFriction(0.0, probe())});
  const Vec3 above(0.02, kMiddle, kTop + kRadius + 0.001),
      down(0.02, kMiddle, kTop + kRadius - 0.003);
  double drags = 0.0, ploughs = 0.0;  // over the normal force, mean
  for (Pipeline* pipeline : {&rough, &smooth}) walk(*pipeline, {above}, {down});
  for (int i = 0; i < 20; ++i) {
    const Vec3 from = down + Vec3(1e-3 * i, 0.0, 0.0), to = from + Vec3(1e-3, 0.0, 0.0);
    for (Pipeline* pipeline : {&rough, &smooth}) walk(*pipeline, {from}, {to}, 0.001);
    if (i < 8) continue;
    drags -= forceOnTissue(rough).x() / forceOnTissue(rough).z() / 12.0;
    ploughs -= forceOnTissue(smooth).x() / forceOnTissue(smooth).z() / 12.0;
  }
  EXPECT_NEAR(drags - ploughs, kFriction, 0.05 * kFriction);
  EXPECT_LT(std::abs(ploughs), 0.07);
}

// The mean over the nodes under it.
TEST(FrictionCone, ToolThatIsDrawnALittleTakesTheTissueAlong) {
  Pipeline pipeline(block(), {}, {withFriction(0.5, probe())});
  walk(pipeline, -0.001, 0.004);
  const std::vector<int> under = pipeline.report().tools.front().nodes;
  const auto mean = [&] {
    Vec3 sum = Vec3::Zero();
    for (const int node : under) sum += pipeline.tissue().state().displacement[at(node)];
    return Vec3(sum / static_cast<double>(under.size()));
  };
  const Vec3 before = mean();
  const Vec3 down = pressed(0.004).links.front().translation();
  walk(pipeline, {down}, {down + Vec3(0.0005, 0.0, 0.0)});
  EXPECT_NEAR((mean() - before).x(), 0.0005, 0.2 * 0.0005);
  const Vec3 force = forceOnTissue(pipeline);
  EXPECT_GT(force.x(), 0.0);
  EXPECT_LT(force.x(), 0.5 * -force.z());
}

// All of a frictionless sphere's forces go through its middle.
TEST(Wrench, OfASmoothSphereHasNoTorqueAboutItsMiddle) {
  Pipeline pipeline(block(), {}, {withFriction(0.0, probe())});
  walk(pipeline, {Vec3(0.0237, 0.0311, kTop + kRadius)},
       {Vec3(0.0237, 0.0311, kTop + kRadius - 0.004)});
  const ToolReport& tool = pipeline.report().tools.front();
  ASSERT_GT(tool.force_on_tool.norm(), 0.1);
  EXPECT_LT(tool.torque_on_tool.norm(), 0.025 * kRadius * tool.force_on_tool.norm());
}

// The same press by a tool whose frame is turned and set off: its wrench is the same, told in its
// own frame and about its own origin. Beside a node: above it several triangles are as deep, and
// rounding would say which of them touches.
TEST(Wrench, IsInTheToolsFrameAboutItsOrigin) {
  const Vec3 offset(0.02, 0.0, 0.03);  // of the sphere in the tool's frame
  Pipeline plain(block(), {}, {probe()});
  Pipeline turned(block(), {}, {probe("probe", offset)});
  Pose rotation = Pose::Identity();
  rotation.linear() = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix();
  for (double depth = -0.0005; depth < 0.004; depth += 0.0005) {
    const RobotPose pose = pressed(depth, kMiddle + 0.0011);
    plain.step(pose);
    RobotPose same = pose;
    same.links.front().linear() = rotation.linear();
    same.links.front().translation() -= rotation.linear() * offset;
    turned.step(same);
  }
  const Vec3 force = plain.report().tools.front().force_on_tool;
  const ToolReport& told = turned.report().tools.front();
  ASSERT_GT(force.norm(), 0.1);
  EXPECT_NEAR((rotation.linear() * told.force_on_tool - force).norm(), 0.0, 1e-3 * force.norm());
  const Vec3 torque = offset.cross(told.force_on_tool) +
                      rotation.linear().transpose() * plain.report().tools.front().torque_on_tool;
  ASSERT_GT(torque.norm(), 1e-3);
  EXPECT_NEAR((told.torque_on_tool - torque).norm(), 0.0, 1e-3 * torque.norm());
}

TEST(Wrench, LongerThanAllowedIsToldAsTheLongestAllowed) {
  ToolGeometry limited = probe();
  limited.max_force = 0.05;
  Pipeline pipeline(block(), {}, {limited});
  Pipeline free(block(), {}, {probe()});
  for (Pipeline* each : {&pipeline, &free}) walk(*each, -0.001, 0.004);
  const ToolReport& told = pipeline.report().tools.front();
  const Vec3 force = free.report().tools.front().force_on_tool;
  ASSERT_GT(force.norm(), 0.05);
  EXPECT_FALSE(free.report().tools.front().saturated);
  EXPECT_TRUE(told.saturated);
  EXPECT_LT((told.force_on_tool - 0.05 * force.normalized()).norm(), 1e-9);
  EXPECT_NEAR(pipeline.forceBalance().tools.norm(), force.norm(), 1e-9);
}

// Not drawn along by the way that the tool came through the air.
TEST(ObliqueTouch, InOneLoadStepFeelsWhatItDoesInMany) {
  const Vec3 from(kMiddle + 0.0005, kMiddle - 0.0013, kTop + 0.0102),
      to(kMiddle + 0.0013, kMiddle - 0.0013, kTop + 0.009);
  const auto force = [&](int steps) {
    TissueConfig tissue = block();
    tissue.material.poisson_ratio = 0.45;
    Pipeline pipeline(tissue, SolverConfig(),
                      {withFriction(0.5, toolOf(boxOf(Vec3::Constant(0.02))))});
    for (int step = 0; step <= steps; ++step) {
      pipeline.step(at({from + (static_cast<double>(step) / steps) * (to - from)}));
    }
    return pipeline.report().tools.front().force_on_tool;
  };
  const Vec3 in_many = force(20);
  EXPECT_LT((force(1) - in_many).norm(), 0.02 * in_many.norm());
}

}  // namespace
}  // namespace robot_tissue::test_contact_forces
