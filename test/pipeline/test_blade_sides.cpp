// Where the sides of a blade are, however its shapes were drawn.
#include <gtest/gtest.h>

#include "../contact/contact_fixtures.h"
#include "blade_sides.h"
#include "pipeline_fixtures.h"

namespace robot_tissue::test_blade_sides {
namespace {

const Vec3 kPlate(0.04, 0.001, 0.03);  // m
const std::vector<Vec3> kEdge = {Vec3(-0.02, 0.0, 0.0), Vec3(0.02, 0.0, 0.0)};

std::vector<Vec3> cornersOfPlate(const Vec3& center) {
  std::vector<Vec3> corners;
  for (const Triangle& triangle : boxTriangles(kPlate, center)) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  return corners;
}

TEST(BladeSides, GoFromTheEdgeToTheMiddle) {
  const BladeSides sides = sidesOf(kEdge, cornersOfPlate(Vec3(0.0, 0.0, 0.015)));
  EXPECT_EQ(sides.middle, Vec3::Zero());
  EXPECT_NEAR(std::abs(sides.across.y()), 1.0, 1e-9);
  EXPECT_EQ(sidesOf(kEdge, {}).across, Vec3::Zero());
}

TEST(BladeSides, AreWhereItIsNarrowestAroundAnEdgeInItsMiddle) {
  for (const double angle : {0.0, 0.3, 1.2}) {
    const Pose turned = makePose(Vec3::Zero(), angle, Vec3::UnitX());
    std::vector<Vec3> corners = cornersOfPlate(Vec3(0.0, 0.0, 1e-9));
    for (Vec3& corner : corners) corner = turned * corner;
    const Vec3 across = sidesOf(kEdge, corners).across;
    EXPECT_NEAR(std::abs(across.dot(turned.linear() * Vec3::UnitY())), 1.0, 1e-8) << angle;
  }
}

// Along y (N), of a blade that has cut in and is pressed aside.
double forceAside(const ToolShape& shape) {
  ToolGeometry knife = toolOf(shape, "knife");
  knife.role = toolRole("blade");
  knife.friction = 0.1;
  knife.blade.edge = kEdge;
  knife.blade.resistance = 20.0;
  Pipeline pipeline(block(), {}, {knife});
  const double y = kMiddle + 0.001;
  const Vec3 above(kMiddle, y, kTop + 0.005), within(kMiddle, y, kTop - 0.015);
  pipeline.step(at({above}));
  walk(pipeline, {above}, {within}, 0.005);
  walk(pipeline, {within}, {within + 0.005 * Vec3::UnitY()}, 0.00125);
  return pipeline.report().tools.front().force_on_tool.y();
}

// Its origin in its middle, or on its edge.
TEST(BladeSides, OfAMeshPushAsThoseOfABox) {
  const Vec3 center(0.0, 0.0, 0.5 * kPlate.z());
  const double of_box = forceAside(boxOf(kPlate, center));
  EXPECT_LT(of_box, -0.1);
  const ToolShape at_edge = mesh(writeStl("blade_at_edge.stl", boxTriangles(kPlate, center)));
  EXPECT_NEAR(forceAside(at_edge), of_box, 0.02 * std::abs(of_box));
}

}  // namespace
}  // namespace robot_tissue::test_blade_sides
