// Boxes and cylinders on a half-space.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
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
}

// d = 2 p / (pi E*) (ln(4 L / a) - 1 / 2), a^2 = 4 p R / (pi E*): a long one.
TEST(Footprint, ALyingCylinderIsALineOfHertzsWidth) {
  const double radius = 0.002, length = 0.1, load = kForce / length / kModulus;
  const Footprint footprint = under(cylinder(radius, length), Vec3(0.6, 0.8, 0.0));
  const double half_width = std::sqrt(4.0 * load * radius / M_PI);
  EXPECT_NEAR(footprint.width, 2.0 * half_width, 1e-3 * half_width);
  EXPECT_NEAR(footprint.depth, 2.0 * load / M_PI * (std::log(4.0 * length / half_width) - 0.5),
              0.01 * footprint.depth);
}

// p = E* a tan(slope): a long edge, its faces at 45 degrees (Johnson 1985, 5.3).
TEST(Footprint, AnEdgeIsAWedge) {
  const double length = 0.1, load = kForce / length / kModulus;
  EXPECT_NEAR(under(box(length, 0.01, 0.01), Vec3(0.0, 1.0, 1.0)).width, 2.0 * load, 0.3 * load);
}

// A half-space under cells of even pressure, none of which pulls (Love 1929): where a shape of that
// height over each cell's middle comes to stand under a force, its lowest place that deep (m).
class HalfSpaceCells {
 public:
  static constexpr int kCells = 28;  // along each side

  HalfSpaceCells(double width, double length)
      : wide_(width / kCells), long_(length / kCells), way_(kAll, kAll) {
    for (int i = 0; i < kAll; ++i) {
      for (int j = 0; j < kAll; ++j) {
        const double x = wide_ * (i / kCells - j / kCells), y = long_ * (i % kCells - j % kCells);
        way_(i, j) = loveAt(x, y);
      }
    }
  }

  Vec3 middle(int cell) const {
    return {(cell / kCells + 0.5) * wide_, (cell % kCells + 0.5) * long_, 0.0};
  }

  // The force (N) by the depth; E* = kModulus.
  double forceAt(double depth, const Eigen::VectorXd& height) {
    Eigen::VectorXd pressure = Eigen::VectorXd::Zero(kAll);
    for (int round = 0; round < 400; ++round) {
      for (int i = 0; i < kAll; ++i) {
        const double missing = depth - height[i] - way_.row(i) * pressure;
        pressure[i] = std::max(0.0, pressure[i] + missing / way_(i, i));
      }
    }
    touches_ = pressure;
    return pressure.sum() * wide_ * long_;
  }

  // Whether what touched last goes on beyond the border, at either end of the width.
  bool isCutOff() const { return touches_.head(kCells).sum() + touches_.tail(kCells).sum() > 0.0; }

 private:
  static constexpr int kAll = kCells * kCells;

  double loveAt(double x, double y) const {
    const auto part = [](double along, double across) {
      return along * std::asinh(across / std::abs(along));
    };
    double sum = 0.0;
    for (const double right : {-0.5, 0.5}) {
      for (const double up : {-0.5, 0.5}) {
        const double a = x + right * wide_, b = y + up * long_;
        sum += (right * up > 0.0 ? 1.0 : -1.0) * (part(a, b) + part(b, a));
      }
    }
    return sum / (M_PI * kModulus);
  }

  double wide_, long_;  // of a cell (m)
  Eigen::MatrixXd way_;
  Eigen::VectorXd touches_;
};

// A box that faces down, its lowest corner above the cells' middle.
double heightOfBox(const Vec3& size, const Vec3& facing, const Vec3& along, const Vec3& off) {
  const Vec3 place = off.x() * along + off.y() * facing.cross(along);
  double height = -1.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (facing[axis] > 1e-9) height = std::max(height, place[axis] / facing[axis]);
  }
  const Vec3 inwards = height * facing - place;
  const bool is_on_it = (inwards.array() > -1e-9).all() && (inwards.array() < size.array()).all();
  return is_on_it ? height : 1.0;
}

// Faces, edges and corners, tilted by much and by little. Each is looked at through a window of
// cells, along an edge as long as that.
TEST(Footprint, IsThatOfTheHalfSpaceThatABoxIsPressedInto) {
  const Vec3 size(0.012, 0.016, 0.02);
  struct Case {
    Vec3 facing;
    double depth, width, length;  // m
  };
  for (const auto& [towards, depth, width, length] :
       {Case{{0.1, 0.0, 1.0}, 4e-4, 0.004, 0.016}, Case{{0.2, 0.0, 1.0}, 6e-4, 0.003, 0.016},
        Case{{0.5, 0.0, 1.0}, 1e-3, 0.002, 0.016}, Case{{1.0, 0.0, 1.0}, 1.2e-3, 0.002, 0.016},
        Case{{0.1, 0.05, 1.0}, 2e-4, 0.0025, 0.005}, Case{{0.3, 0.3, 1.0}, 1e-3, 0.005, 0.005},
        Case{{0.36, 0.1, 1.0}, 6e-4, 0.003, 0.008}, Case{{1.0, 0.9, 0.8}, 2e-3, 0.006, 0.006}}) {
    const Vec3 facing = towards.normalized();
    const Vec3 along = (Vec3::UnitX() - facing.x() * facing).normalized();
    const bool is_edge = towards.y() == 0.0;
    const double beside = towards.x() < 1.0 ? 0.8 : 0.5;
    const Vec3 lowest(beside * width, is_edge ? length : beside * length, 0.0);
    HalfSpaceCells cells(width, length);
    Eigen::VectorXd height(HalfSpaceCells::kCells * HalfSpaceCells::kCells);
    for (int i = 0; i < height.size(); ++i) {
      height[i] = heightOfBox(size, facing, along, cells.middle(i) - lowest);
    }
    const double force = cells.forceAt(depth, height);
    EXPECT_FALSE(cells.isCutOff()) << towards.transpose();
    BoxOrCylinder body;
    body.half_size = 0.5 * size;
    EXPECT_NEAR(footprintOf(body, facing, force, kModulus).depth, depth, 0.04 * depth)
        << towards.transpose();
  }
}

// A face on an organ touches somewhere within; a corner and a sharp edge where they are.
TEST(Footprint, OfWhatFacesTissueThatBulgesIsNotKnown) {
  const Bulge organ = {20.0, 0.005};
  const auto on_organ = [&](const Vec3& facing) {
    return footprintOf(box(0.01, 0.012, 0.02), facing.normalized(), kForce, kModulus, organ);
  };
  EXPECT_DOUBLE_EQ(on_organ(Vec3::UnitZ()).bulge, 20.0 * (0.01 * 0.01 + 0.012 * 0.012) / 8.0);
  EXPECT_DOUBLE_EQ(on_organ(Vec3(0.5, 0.0, 1.0)).bulge, 20.0 * 0.012 * 0.012 / 8.0);
  EXPECT_EQ(on_organ(Vec3(0.5, 0.4, 1.0)).bulge, 0.0);
  EXPECT_EQ(under(box(0.01, 0.012, 0.02), Vec3::UnitZ()).bulge, 0.0) << "flat";
}

// From a face to an edge, and from lying to standing, without a leap.
TEST(Footprint, ChangesLittleWithTheWayItFaces) {
  for (const BoxOrCylinder& body : {box(0.004, 0.006, 0.01), cylinder(0.003, 0.01)}) {
    Footprint last = under(body, Vec3::UnitZ());
    for (int step = 1; step <= 9000; ++step) {
      const double angle = M_PI / 2.0 * step / 9000.0;
      const Footprint next = under(body, Vec3(0.0, std::sin(angle), std::cos(angle)));
      ASSERT_TRUE(std::isfinite(next.depth) && next.width > 0.0) << step;
      EXPECT_NEAR(next.depth, last.depth, 0.02 * last.depth) << step;
      last = next;
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_footprint
