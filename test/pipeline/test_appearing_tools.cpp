// Tools that appear inside the tissue: drawn out by the shortest way, and walked in from there.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "../contact/contact_fixtures.h"
#include "pipeline_fixtures.h"

namespace robot_tissue::test_appearing_tools {
namespace {

constexpr double kHair = 0.06 * kSpacing;  // deep in the surface shown (m), beside a rim, too

// Where a tool appears, and the direction of the tissue's force on it when it came the short way.
struct Appearance {
  std::string name;
  ToolShape shape;
  Vec3 place;
  Vec3 out;
};

ToolShape sphereOf(double radius) {
  ToolShape sphere;
  sphere.radius = radius;
  return sphere;
}

ToolShape needle() { return uprightCylinder(0.0005, 0.05); }

const Appearance kAppearances[] = {
    {"SphereToItsMiddle", sphereOf(kRadius), Vec3(kMiddle, kMiddle, kTop), Vec3::UnitZ()},
    {"SphereBeyondItsMiddle", sphereOf(kRadius), Vec3(kMiddle, kMiddle, kTop - 0.003),
     Vec3::UnitZ()},
    {"SphereBesideASide", sphereOf(0.006), Vec3(0.004, kMiddle, 0.018), -Vec3::UnitX()},
    {"SphereNearTheFixedBottom", sphereOf(0.006), Vec3(0.01, kMiddle, 0.008), -Vec3::UnitX()},
    {"Needle", needle(), Vec3(kMiddle + 0.001, kMiddle + 0.0015, kTop - 0.006), Vec3::UnitZ()},
    {"LyingBox", boxOf(Vec3(0.03, 0.02, 0.006)), Vec3(kMiddle, kMiddle, kTop - 0.004),
     Vec3::UnitZ()},
};

class AppearingTool : public ::testing::TestWithParam<Appearance> {};

TEST_P(AppearingTool, ComesInByTheShortestWay) {
  Pipeline pipeline(block(), {}, {toolOf(GetParam().shape)});
  const StepReport& report = pipeline.step(at({GetParam().place}));
  EXPECT_EQ(report.were_inside, std::vector<std::size_t>{0});
  EXPECT_FALSE(report.lost);
  const ToolReport& tool = report.tools.front();
  EXPECT_LT(tool.max_penetration, kHair);
  EXPECT_GT(tool.force_on_tool.dot(GetParam().out), 0.5 * tool.force_on_tool.norm());
  EXPECT_GT(tool.force_on_tool.norm(), 0.0);
  EXPECT_EQ(pipeline.tissue().lastReport().inverted_cells, 0);
  pipeline.step(at({GetParam().place + 0.04 * GetParam().out}));
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Where, AppearingTool, ::testing::ValuesIn(kAppearances),
                         [](const auto& row) { return row.param.name; });

// Nothing there can give way to it.
TEST(ToolInFixedTissue, IsToldAsDeepAsItIs) {
  Pipeline pipeline(block(), {}, {probe()});
  pipeline.step(at({Vec3(kMiddle, kMiddle, -0.02)}));
  pipeline.step(at({Vec3(kMiddle, kMiddle, 0.003 - kRadius)}));
  const ToolReport& tool = pipeline.report().tools.front();
  EXPECT_EQ(tool.contacts, 0);
  EXPECT_EQ(tool.force_on_tool, Vec3::Zero());
  EXPECT_NEAR(tool.max_penetration, 0.003, 1e-5);
}

// From beneath, through the fixed bottom, it is in the tissue without a touch; out through the side
// it takes the surface along that it stands through.
TEST(ToolInFixedTissue, LetsGoOfWhatItIsHookedOnOnceItIsOutside) {
  Pipeline pipeline(block(), {}, {toolOf(sphereOf(0.006))});
  const Vec3 beneath(kMiddle, kMiddle, -0.05), within(kMiddle, kMiddle, 0.5 * kTop);
  walk(pipeline, {beneath}, {within}, 0.002);
  double drawn_out = 0.0;
  bool was_hooked = false;
  for (double way = 0.0; way < 2.0 * kMiddle; way += 0.002) {
    const StepReport& report = pipeline.step(at({within + way * Vec3::UnitX()}));
    drawn_out = std::max(drawn_out, greatestDisplacement(pipeline.tissue()));
    was_hooked = was_hooked || !report.hooked.empty();
    EXPECT_TRUE(report.were_inside.empty()) << "it did not appear";
  }
  EXPECT_GT(drawn_out, 0.005);
  EXPECT_TRUE(was_hooked);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

// Around the block without a touch, or with only their origins in it.
ToolShape ringAround() {
  std::vector<Triangle> triangles;
  const int sides = 24;
  const auto corner = [&](double radius, int side, double z) -> Vec3 {
    const double angle = 2.0 * M_PI * side / sides;
    return {radius * std::cos(angle), radius * std::sin(angle), z};
  };
  const std::array<std::array<double, 2>, 4> section = {
      {{0.06, -0.005}, {0.06, 0.005}, {0.05, 0.005}, {0.05, -0.005}}};
  for (int side = 0; side < sides; ++side) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& [from, low] = section[k];
      const auto& [to, high] = section[(k + 1) % 4];
      const Vec3 a = corner(from, side, low), b = corner(from, side + 1, low),
                 c = corner(to, side + 1, high), d = corner(to, side, high);
      triangles.push_back({{a, b, c}});
      triangles.push_back({{a, c, d}});
    }
  }
  return mesh(writeStl("ring_around.stl", triangles));
}

ToolGeometry forkAround() {
  ToolGeometry fork = toolOf(boxOf(Vec3(0.005, 0.02, 0.02), Vec3(-0.04, 0.0, 0.0)));
  fork.links.front().shapes.push_back(boxOf(Vec3(0.005, 0.02, 0.02), Vec3(0.04, 0.0, 0.0)));
  return fork;
}

ToolShape boxAboveItsOrigin() {
  const Vec3 size = Vec3::Constant(0.02);
  return mesh(writeStl("box_above_origin.stl", boxTriangles(size, Vec3(0.0, 0.0, 0.03))));
}

TEST(ToolBesideTheTissue, IsNotInside) {
  const std::vector<ToolGeometry> around = {forkAround(), toolOf(ringAround()),
                                            toolOf(boxAboveItsOrigin())};
  for (std::size_t tool = 0; tool < around.size(); ++tool) {
    Pipeline pipeline(block(), {}, {around[tool]});
    const RobotPose there = at({Vec3(kMiddle, kMiddle, kTop - 0.005)});
    EXPECT_FALSE(pipeline.isInTissue(0, there)) << tool;
    const StepReport& report = pipeline.step(there);
    EXPECT_TRUE(report.were_inside.empty()) << tool;
    EXPECT_EQ(report.tools.front().force_on_tool, Vec3::Zero()) << tool;
    EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0) << tool;
  }
}

// Not their mean place alone: that of these balls is above the block.
TEST(ToolInTheTissue, IsInsideWithAnyOfItsShapes) {
  ToolGeometry dumbbell = toolOf(sphereOf(0.001));
  dumbbell.links.front().shapes.push_back(sphereOf(0.001));
  dumbbell.links.front().shapes.back().pose.translation().z() = 0.04;
  Pipeline pipeline(block(), {}, {dumbbell});
  EXPECT_TRUE(pipeline.isInTissue(0, at({Vec3(kMiddle, kMiddle, kTop - 0.0125)})));
}

// Smaller than a step out, which passes the surface without a touch.
TEST(SmallTool, LeavesTheNearWayAndNotThroughTheFixedBottom) {
  for (const double z : {kTop - 0.0025, 0.0025}) {
    Pipeline pipeline(block(), {}, {toolOf(sphereOf(0.0005))});
    const StepReport& report = pipeline.step(at({Vec3(0.0125, kMiddle, z)}));
    EXPECT_EQ(report.were_inside, std::vector<std::size_t>{0});
    const Vec3 force = report.tools.front().force_on_tool;
    const Vec3 out = z > 0.5 * kTop ? Vec3(Vec3::UnitZ()) : Vec3(-Vec3::UnitX());
    EXPECT_GT(force.dot(out), 0.5 * force.norm()) << z;
    EXPECT_GT(force.norm(), 0.0) << z;
  }
}

// Its walls are as far off on all sides, and no way out is short: not searched for step by step.
TEST(AppearingTool, MeshAroundAllOfTheTissueIsTold) {
  const ToolShape ball = mesh(writeStl("large_ball.stl", ballTriangles(12, 10.0)));
  Pipeline pipeline(block(), methodOf("elastic"), {toolOf(ball)});
  EXPECT_EQ(pipeline.toolWarnings().size(), 1U);
  const StepReport& report = pipeline.step(at({Vec3(kMiddle, kMiddle, kTop)}));
  EXPECT_EQ(report.were_inside, std::vector<std::size_t>{0});
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

}  // namespace
}  // namespace robot_tissue::test_appearing_tools
