// Tools on a half-space, by what of them is no higher than each level.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "loads/footprint.h"
#include "mesh_fixtures.h"

namespace robot_tissue::test_footprint {
namespace {

constexpr double kModulus = 1e4;  // Pa, of plane strain
constexpr double kForce = 0.01;   // N
constexpr double kUpTo = 0.005;   // m

// Rings of a body around z, each (radius, z), from below; their first and last are its middles.
TriangleMesh revolved(const std::vector<std::pair<double, double>>& outline, int sides) {
  TriangleMesh mesh;
  for (const auto& [radius, z] : outline) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * M_PI * i / sides;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  for (int ring = 0; ring + 1 < static_cast<int>(outline.size()); ++ring) {
    for (int i = 0; i < sides; ++i) {
      const int here = ring * sides, next = (i + 1) % sides;
      mesh.triangles.push_back({here + i, here + next, here + sides + next});
      mesh.triangles.push_back({here + i, here + sides + next, here + sides + i});
    }
  }
  return welded(mesh);
}

TriangleMesh cylinder(double radius, double length, int sides = 64) {
  const double z = 0.5 * length;
  return revolved({{0.0, -z}, {radius, -z}, {radius, z}, {0.0, z}}, sides);
}

TriangleMesh box(double x, double y, double z) {
  const Vec3 half = 0.5 * Vec3(x, y, z);
  return boxMesh(-half, half);
}

IndenterPart partOf(const TriangleMesh& mesh, const Vec3& towards) {
  const Vec3 facing = towards.normalized();
  const Indenter indenter(mesh);
  return indenter.partAround(indenter.nearestFacing(facing, facing), facing, kUpTo);
}

Footprint under(const TriangleMesh& mesh, const Vec3& towards) {
  return footprintOf(partOf(mesh, towards), kForce / kModulus);
}

// King 1987, for a square; Sneddon 1946.
TEST(Footprint, AFlatEndGoesAsDeepAsARigidPunch) {
  const double side = 0.004, radius = 0.003;
  const Footprint square = under(box(side, side, 0.01), Vec3::UnitZ());
  EXPECT_NEAR(square.depth, kForce / (2.0 * kModulus * 1.012 * side / std::sqrt(M_PI)),
              0.01 * square.depth);
  EXPECT_NEAR(square.width, side, 0.02 * side);
  const Footprint disc = under(cylinder(radius, 0.01), -Vec3::UnitZ());
  EXPECT_NEAR(disc.depth, kForce / (2.0 * kModulus * radius), 0.01 * disc.depth);
}

// d = 2 p / (pi E*) (ln(4 L / a) - 1 / 2), a^2 = 4 p R / (pi E*): a long one. The ellipse of 50:1
// goes in a tenth less than that strip.
TEST(Footprint, ALyingCylinderIsALine) {
  const double radius = 0.002, length = 0.1, load = kForce / length / kModulus;
  const double half_width = std::sqrt(4.0 * load * radius / M_PI);
  const Footprint footprint = under(cylinder(radius, length), Vec3(0.6, 0.8, 0.0));
  EXPECT_NEAR(footprint.depth, 2.0 * load / M_PI * (std::log(4.0 * length / half_width) - 0.5),
              0.11 * footprint.depth);
}

// Hertz 1882, whole and as triangles; of triangles flat ones lie at its lowest place.
TEST(Footprint, OfABallIsHertzs) {
  const double radius = 0.004, load = kForce / kModulus;
  const double depth = std::cbrt(9.0 * load * load / (16.0 * radius));
  const IndenterPart ball = Indenter::ball(radius).partAround(0, Vec3::UnitX(), kUpTo);
  EXPECT_NEAR(footprintOf(ball, load).depth, depth, 0.03 * depth) << "its slopes are not small";
  std::vector<std::pair<double, double>> outline;
  for (int i = -24; i <= 24; ++i) {
    outline.emplace_back(radius * std::cos(M_PI * i / 48.0), radius * std::sin(M_PI * i / 48.0));
  }
  EXPECT_NEAR(under(revolved(outline, 48), -Vec3::UnitZ()).depth, footprintOf(ball, load).depth,
              0.02 * depth);
}

// Sneddon 1965: F = pi / 2 E* a^2 s, d = pi / 2 a s, of a slope s.
TEST(Footprint, OfAConeIsSneddons) {
  const double slope = 0.5, load = kForce / kModulus;
  const double contact = std::sqrt(2.0 * load / (M_PI * slope));
  const Footprint footprint =
      under(revolved({{0.0, 0.0}, {0.01, 0.01 * slope}, {0.0, 0.01}}, 64), -Vec3::UnitZ());
  EXPECT_NEAR(footprint.depth, 0.5 * M_PI * contact * slope, 0.02 * footprint.depth);
}

// Its two pieces are no higher, but do not hang together.
TEST(Footprint, OfAForkIsThatOfOneProng) {
  const TriangleMesh prong = box(0.002, 0.002, 0.01);
  const TriangleMesh fork = joined(prong, moved(prong, Vec3(0.006, 0.0, 0.0)));
  EXPECT_DOUBLE_EQ(under(fork, -Vec3::UnitZ()).depth, under(prong, -Vec3::UnitZ()).depth);
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
    const TriangleMesh body = box(size.x(), size.y(), size.z());
    EXPECT_NEAR(footprintOf(partOf(body, facing), force / kModulus).depth, depth, 0.055 * depth)
        << towards.transpose();
  }
}

// A tube's end, a triangle and an L, flat: where they touch is known, and how far they go in from
// cells.
TEST(Footprint, OfFlatEndsOfAnyOutlineIsTheHalfSpaces) {
  const double size = 0.006, depth = 1e-4;
  const auto ring = [](const Vec3& place) {
    return place.head<2>().norm() < 0.003 && place.head<2>().norm() > 0.0015;
  };
  const auto triangle = [](const Vec3& place) {
    return place.y() > -0.002 && place.y() < 0.002 - 2.0 * std::abs(place.x());
  };
  const auto bent = [](const Vec3& place) {
    return place.cwiseAbs().maxCoeff() < 0.0025 && (place.x() < 0.0 || place.y() < 0.0);
  };
  for (const std::function<bool(const Vec3&)>& touches :
       std::vector<std::function<bool(const Vec3&)>>{ring, triangle, bent}) {
    HalfSpaceCells cells(size, size);
    Eigen::VectorXd height(HalfSpaceCells::kCells * HalfSpaceCells::kCells);
    TriangleMesh mesh;
    const double half = 0.5 * size / HalfSpaceCells::kCells;
    for (int i = 0; i < height.size(); ++i) {
      const Vec3 place = cells.middle(i) - Vec3(0.5 * size, 0.5 * size, 0.0);
      height[i] = touches(place) ? 0.0 : 1.0;
      if (height[i] > 0.0) continue;
      const int first = static_cast<int>(mesh.vertices.size());
      for (const auto& [x, y] : {std::pair(-half, -half), std::pair(half, -half),
                                 std::pair(half, half), std::pair(-half, half)}) {
        mesh.vertices.push_back(place + Vec3(x, y, 0.0));
      }
      mesh.triangles.push_back({first, first + 2, first + 1});
      mesh.triangles.push_back({first, first + 3, first + 2});
    }
    const double force = cells.forceAt(depth, height);
    const IndenterPart part = partOf(welded(mesh), -Vec3::UnitZ());
    EXPECT_NEAR(footprintOf(part, force / kModulus).depth, depth, 0.025 * depth);
  }
}

// Hertz's of both curvatures: a wide face on a ball, a ball on a ball. A face's corner that the
// apex is beyond touches where it is nearest to that, and deeper.
TEST(Footprint, OnTissueThatBulgesIsHertzs) {
  const double load = kForce / kModulus, curvature = 25.0;
  const auto depth = [&](double of_both) { return std::cbrt(9.0 * load * load * of_both / 16.0); };
  const IndenterPart face = partOf(box(0.04, 0.03, 0.01), -Vec3::UnitZ());
  for (const double off : {0.0, 0.005}) {
    const Bulge organ = {curvature, face.levels.front().middle + Vec3(off, -off, 0.0)};
    EXPECT_NEAR(footprintOf(face, load, organ).depth, depth(curvature), 0.01 * depth(curvature));
  }
  const Bulge beyond = {curvature, face.levels.front().middle + Vec3(0.05, 0.0, 0.0)};
  EXPECT_GT(footprintOf(face, load, beyond).depth, 0.5 * curvature * 0.02 * 0.02);
  const double radius = 0.02;
  const IndenterPart ball = Indenter::ball(radius).partAround(0, Vec3::UnitX(), kUpTo);
  const double of_both = 1.0 / radius + curvature;
  EXPECT_NEAR(footprintOf(ball, load, {curvature, ball.lowest}).depth, depth(of_both),
              0.01 * depth(of_both));
}

TEST(Footprint, ALoadIsFoundByItsDepth) {
  const IndenterPart part = partOf(box(0.004, 0.006, 0.01), Vec3(0.3, 0.1, 1.0));
  const Bulge organ = {10.0, part.lowest};
  for (const double load : {1e-8, 1e-6, 1e-5}) {
    EXPECT_NEAR(loadAt(footprintOf(part, load, organ).depth, part, organ), load, 1e-3 * load);
  }
  EXPECT_EQ(loadAt(0.0, part), 0.0);
}

// From a face to an edge, and from lying to standing, without a leap.
TEST(Footprint, ChangesLittleWithTheWayItFaces) {
  for (const TriangleMesh& body : {box(0.004, 0.006, 0.01), cylinder(0.003, 0.01)}) {
    Footprint last = under(body, Vec3::UnitZ());
    for (int step = 1; step <= 3000; ++step) {
      const double angle = M_PI / 2.0 * step / 3000.0;
      const Footprint next = under(body, Vec3(0.0, std::sin(angle), std::cos(angle)));
      ASSERT_TRUE(std::isfinite(next.depth) && next.width > 0.0) << step;
      EXPECT_NEAR(next.depth, last.depth, 0.02 * last.depth) << step;
      last = next;
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_footprint
