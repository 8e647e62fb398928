// Cells parted where the blade passed: volumes, moments and the wound's surface against solids that
// are clipped exactly.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "../random_polygons.h"
#include "block_fixtures.h"
#include "cutting/cell_division.h"
#include "cutting/cut.h"
#include "cutting/split_cells.h"
#include "robot_tissue/core/surface.h"

namespace robot_tissue::test_cell_division {
namespace {

constexpr double kSpacing = 0.01;

void expectEqual(const FillIntegrals& one, const FillIntegrals& other, double tolerance) {
  EXPECT_NEAR(one.volume, other.volume, tolerance);
  EXPECT_LT((one.first - other.first).norm(), tolerance);
  EXPECT_LT((one.second - other.second).norm(), tolerance);
  EXPECT_NEAR(one.triple, other.triple, tolerance);
}

Vec3 anywhere(RandomNumbers& numbers, double size) {
  const double x = numbers.between(-size, size), y = numbers.between(-size, size);
  return {x, y, numbers.between(-size, size)};
}

Vec3 direction(RandomNumbers& numbers) {
  Vec3 any = Vec3::Zero();
  while (any.norm() < 0.1 || any.norm() > 1.0) any = anywhere(numbers, 1.0);
  return any.normalized();
}

// Six of the diagonal from corner 0 to 7.
std::vector<Tetrahedron> cube() {
  std::vector<Tetrahedron> solids;
  std::array<int, 3> axes = {0, 1, 2};
  do {
    Tetrahedron solid;
    Vec3 corner = Vec3::Constant(-0.5);
    for (std::size_t i = 0; i < 4; ++i) {
      solid[i] = corner;
      if (i < 3) corner[axes[i]] += 1.0;
    }
    solids.push_back(solid);
  } while (std::next_permutation(axes.begin(), axes.end()));
  return solids;
}

FillIntegrals cubeWithin(const std::vector<HalfSpace>& halves) {
  FillIntegrals sum;
  for (const Tetrahedron& solid : cube()) sum += integralsWithin(halves, solid);
  return sum;
}

TEST(TetrahedronIntegrals, OfACubeAreItsMoments) {
  FillIntegrals sum;
  for (const Tetrahedron& solid : cube()) sum += integralsOver(solid);
  expectEqual(sum, octantIntegrals(0xff), 1e-15);
  for (int corner = 0; corner < kCorners; ++corner) {
    std::vector<HalfSpace> halves;
    for (int axis = 0; axis < 3; ++axis) {
      const double side = (corner >> axis & 1) != 0 ? -1.0 : 1.0;
      halves.push_back({side * Vec3::Unit(axis), 0.0});
    }
    expectEqual(cubeWithin(halves), octantIntegrals(static_cast<std::uint8_t>(1 << corner)), 1e-15);
  }
}

TEST(TetrahedronIntegrals, BothSidesOfAPlaneAddUp) {
  RandomNumbers numbers;
  for (int trial = 0; trial < 200; ++trial) {
    Tetrahedron solid;
    for (Vec3& corner : solid) corner = anywhere(numbers, 1.0);
    const HalfSpace half{direction(numbers), numbers.between(-0.5, 0.5)};
    FillIntegrals sum = integralsWithin({half}, solid);
    EXPECT_GE(sum.volume, 0.0);
    sum += integralsWithin({{-half.normal, -half.offset}}, solid);
    expectEqual(sum, integralsOver(solid), 1e-14);
  }
}

// A plane through a cube's corner leaves a pyramid of known volume and center.
TEST(TetrahedronIntegrals, OfAClippedCornerAreKnown) {
  const double leg = 0.4;
  const HalfSpace half{Vec3::Ones(), leg - 1.5};
  const FillIntegrals corner = cubeWithin({half});
  EXPECT_NEAR(corner.volume, leg * leg * leg / 6.0, 1e-15);
  EXPECT_LT((corner.first / corner.volume - Vec3::Constant(leg / 4.0 - 0.5)).norm(), 1e-14);
}

// Planes at rest, each through all of the block: (normal, a point of it in spacings).
struct Plane {
  Vec3 normal;
  Vec3 point;
  double above(const Vec3& place) const { return normal.dot(place - point); }
};

std::vector<Vec3> polygonIn(const Plane& plane) {
  const Vec3 along = plane.normal.unitOrthogonal(), across = plane.normal.cross(along);
  std::vector<Vec3> corners;
  for (const auto& [u, v] :
       {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
    corners.emplace_back(kSpacing * (plane.point + 100.0 * (u * along + v * across)));
  return corners;
}

Lattice blockCut(const std::vector<Plane>& planes, LatticeState& state) {
  const Lattice lattice(blockOf(4, 4, 4));
  state = lattice.restState();
  for (const Plane& plane : planes) {
    sever(lattice, springsAcross(lattice, state, polygonIn(plane)), state, SplitCells::kParted);
  }
  return lattice;
}

// The exact solid of a part: its cell within the half spaces that its own corners are in. False
// where its corners are in several, so that planes cross there and no spring tells.
bool findExactPart(const Lattice& lattice, const Cell& part, const std::vector<Plane>& planes,
                   FillIntegrals& exact) {
  const auto low = lattice.gridIndex(lattice.cells()[at(part.place)].nodes.front());
  const Vec3 middle = Vec3(low[0], low[1], low[2]) + Vec3::Constant(0.5);
  std::vector<HalfSpace> halves;
  for (const Plane& plane : planes) {
    int above = 0, own = 0;
    for (int corner = 0; corner < kCorners; ++corner) {
      if (!part.owns(corner)) continue;
      const Vec3 place(low[0] + (corner & 1), low[1] + (corner >> 1 & 1), low[2] + (corner >> 2));
      above += plane.above(place) > 0.0 ? 1 : 0;
      ++own;
    }
    if (above != 0 && above != own) return false;
    const double side = above != 0 ? -1.0 : 1.0;
    halves.push_back({side * plane.normal, -side * plane.above(middle)});
  }
  exact = cubeWithin(halves);
  return true;
}

FillIntegrals partFill(const Lattice& lattice, const LatticeState& state, const Cell& part) {
  const auto fills = cornerFills(lattice, state, lattice.cells()[at(part.place)]);
  FillIntegrals sum;
  for (int corner = 0; corner < kCorners; ++corner) {
    if (part.owns(corner)) sum += fills[at(corner)];
  }
  return sum;
}

TEST(CellDivision, OfAPlaneIsTheClippedCell) {
  RandomNumbers numbers;
  int parts = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Plane plane{direction(numbers), Vec3::Constant(2.0) + anywhere(numbers, 0.7)};
    LatticeState state;
    const Lattice lattice = blockCut({plane}, state);
    double near_nodes = 1.0;  // a node so near the plane is moved off it
    for (int node = 0; node < lattice.nodeCount(); ++node) {
      const double above = plane.above(lattice.restPosition(node) / kSpacing);
      near_nodes = std::min(near_nodes, std::abs(above));
    }
    if (near_nodes < 0.01) continue;
    for (const Cell& cell : state.cells->all()) {
      if (!cell.isPart()) continue;
      ++parts;
      FillIntegrals exact;
      ASSERT_TRUE(findExactPart(lattice, cell, {plane}, exact));
      expectEqual(partFill(lattice, state, cell), exact, 1e-12);
    }
  }
  EXPECT_GT(parts, 500);
}

// Along their common line planes cross within cells; where each parts four springs of the cell the
// parts are exact.
TEST(CellDivision, OfPlanesThatCrossIsTheClippedCell) {
  const Plane one{Vec3(1.0, 0.1, 0.05).normalized(), Vec3(2.3, 2.0, 2.0)};
  const Plane two{Vec3(-0.1, 1.0, -0.1).normalized(), Vec3(2.0, 1.6, 2.0)};
  const Plane three{Vec3(0.05, 0.1, 1.0).normalized(), Vec3(2.0, 2.0, 2.45)};
  for (const auto& planes : {std::vector<Plane>{one, two}, std::vector<Plane>{one, two, three}}) {
    LatticeState state;
    const Lattice lattice = blockCut(planes, state);
    int most_parts = 0, parts = 0;
    for (const Cell& cell : state.cells->all()) {
      if (!cell.isPart()) continue;
      parts = cell.owns(0) ? 1 : parts + 1;
      most_parts = std::max(most_parts, parts);
      FillIntegrals exact;
      if (!findExactPart(lattice, cell, planes, exact)) continue;
      expectEqual(partFill(lattice, state, cell), exact, 2e-3);
    }
    EXPECT_EQ(most_parts, planes.size() == 2 ? 4 : 8);
  }
}

// Whatever was severed, where it ever was parted: all of the cell is in one part or another.
TEST(CellDivision, PartsFillTheCell) {
  RandomNumbers numbers;
  const Lattice lattice(blockOf(3, 3, 3));
  for (int trial = 0; trial < 100; ++trial) {
    LatticeState state = lattice.restState();
    std::vector<Crossing> crossings;
    const double share = numbers.between(0.1, 1.0);
    for (std::size_t spring = 0; spring < lattice.springs().size(); ++spring) {
      if (numbers.between(0.0, 1.0) > share) continue;
      Crossing crossing;
      crossing.spring = static_cast<int>(spring);
      crossing.along = numbers.between(-0.1, 1.1);
      crossings.push_back(crossing);
    }
    sever(lattice, crossings, state, SplitCells::kParted);
    for (const Cell& cell : lattice.cells()) {
      FillIntegrals sum;
      for (const FillIntegrals& fill : cornerFills(lattice, state, cell)) {
        EXPECT_GT(fill.volume, 0.0);
        sum += fill;
      }
      expectEqual(sum, octantIntegrals(0xff), 1e-14);
    }
    double sum = 0.0, least = 1.0;
    for (const Cell& cell : state.cells->all()) {
      sum += cell.share();
      least = std::min(least, cell.share());
    }
    EXPECT_NEAR(sum, 27.0, 1e-12);
    EXPECT_GE(least, 1e-3 - 1e-15);
    const TissueSurface surface = extractSurface(lattice, state);
    EXPECT_NEAR(enclosedVolume(surface, surface.rest), 27e-6, 1e-17);
  }
}

TEST(CellDivision, WoundLiesOnTheBlade) {
  RandomNumbers numbers;
  for (int trial = 0; trial < 20; ++trial) {
    const Plane plane{direction(numbers), Vec3::Constant(2.0) + anywhere(numbers, 0.7)};
    LatticeState state;
    const Lattice lattice = blockCut({plane}, state);
    const TissueSurface surface = extractSurface(lattice, state);
    double area = 0.0;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      if (surface.opened[i] == 0) continue;
      const auto& [a, b, c] = surface.triangles[i];
      for (const int vertex : {a, b, c}) {
        EXPECT_LT(std::abs(plane.above(surface.rest[at(vertex)] / kSpacing)), 2e-3);
      }
      const Vec3 ab = surface.rest[at(b)] - surface.rest[at(a)];
      area += 0.5 * ab.cross(surface.rest[at(c)] - surface.rest[at(a)]).norm();
    }
    EXPECT_GT(area, kSpacing * kSpacing);
    EXPECT_NEAR(enclosedVolume(surface, surface.rest), 64e-6, 1e-17);
  }
}

// A blade exactly on a plane of nodes leaves whole cells on both sides of it, but for a thousandth.
TEST(CellDivision, OnNodesTheBladePartsCellsAtTheirSides) {
  const Plane plane{Vec3::UnitZ(), Vec3(2.0, 2.0, 2.0)};
  LatticeState state;
  const Lattice lattice = blockCut({plane}, state);
  for (const Cell& cell : state.cells->all()) {
    if (!cell.isPart()) continue;
    EXPECT_NEAR(cell.share(), cell.owns(0) ? 0.999 : 0.001, 1e-12);
  }
}

}  // namespace
}  // namespace robot_tissue::test_cell_division
