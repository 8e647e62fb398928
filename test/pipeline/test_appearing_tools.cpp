// Tools that appear inside the tissue: drawn out by the shortest way, and walked in from there.
#include <gtest/gtest.h>

#include <algorithm>

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
