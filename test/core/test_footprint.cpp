// Boxes and cylinders on a half-space.
#include <gtest/gtest.h>

#include <cmath>

#include "loads/footprint.h"

namespace robot_tissue::test_footprint {
namespace {

constexpr double kModulus = 1e4;  // Pa, of plane strain
constexpr double kForce = 0.01;   // N

BoxOrCylinder box(double x, double y, double z) {
  BoxOrCylinder body;
  body.half_size = 0.5 * Vec3(x, y, z);
  return body;
}

BoxOrCylinder cylinder(double radius, double length) {
  BoxOrCylinder body;
  body.radius = radius;
  body.half_size = Vec3(radius, radius, 0.5 * length);
  return body;
}

Footprint under(const BoxOrCylinder& body, const Vec3& facing) {
  return footprintOf(body, facing.normalized(), kForce, kModulus);
}

// King 1987, for a square; Sneddon 1946.
TEST(Footprint, AFlatEndGoesAsDeepAsARigidPunch) {
  const double side = 0.004, radius = 0.003;
  const Footprint square = under(box(side, side, 0.01), Vec3::UnitZ());
  EXPECT_NEAR(square.depth, kForce / (2.0 * kModulus * 1.012 * side / std::sqrt(M_PI)),
              0.01 * square.depth);
  const Footprint disc = under(cylinder(radius, 0.01), -Vec3::UnitZ());
  EXPECT_NEAR(disc.depth, kForce / (2.0 * kModulus * radius), 0.02 * disc.depth);
  for (const Footprint& footprint : {square, disc}) {
    EXPECT_EQ(footprint.height, 0.0);
    EXPECT_EQ(footprint.share, 1.0);
  }
}

// d = 2 p / (pi E*) (ln(4 L / a) - 1 / 2), a^2 = 4 p R / (pi E*): a long one.
TEST(Footprint, ALyingCylinderIsALineOfHertzsWidth) {
  const double radius = 0.002, length = 0.1, load = kForce / length / kModulus;
  const Footprint footprint = under(cylinder(radius, length), Vec3(0.6, 0.8, 0.0));
  const double half_width = std::sqrt(4.0 * load * radius / M_PI);
  EXPECT_NEAR(footprint.width, 2.0 * half_width, 1e-3 * half_width);
  EXPECT_NEAR(footprint.depth + footprint.height,
              2.0 * load / M_PI * (std::log(4.0 * length / half_width) - 0.5),
              0.01 * footprint.depth);
}

TEST(Footprint, IsNotKnownOfEdgesCornersAndRims) {
  EXPECT_EQ(under(box(0.01, 0.01, 0.01), Vec3(0.0, 1.0, 1.0)).share, 0.0);
  EXPECT_EQ(under(box(0.01, 0.01, 0.01), Vec3(1.0, 1.0, 1.0)).share, 0.0);
  EXPECT_EQ(under(cylinder(0.01, 0.02), Vec3(0.0, 1.0, 1.0)).share, 0.0);
}

// From a face to an edge, and from lying to standing, without a leap.
TEST(Footprint, ChangesLittleWithTheWayItFaces) {
  for (const BoxOrCylinder& body : {box(0.004, 0.006, 0.01), cylinder(0.003, 0.01)}) {
    Footprint last = under(body, Vec3::UnitZ());
    for (int step = 1; step <= 9000; ++step) {
      const double angle = M_PI / 2.0 * step / 9000.0;
      const Footprint next = under(body, Vec3(0.0, std::sin(angle), std::cos(angle)));
      ASSERT_TRUE(std::isfinite(next.depth) && std::isfinite(next.height)) << step;
      EXPECT_NEAR(next.share, last.share, 0.05) << step;
      if (next.share > 0.0 && last.share > 0.0) {
        EXPECT_NEAR(next.depth + next.height, last.depth + last.height, 0.02 * last.depth) << step;
      }
      last = next;
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_footprint
