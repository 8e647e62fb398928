// What cells are filled with: moments of octants, of slices of meshes, of parts.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/mesh_slicing.h"
#include "lattice/slivers.h"
#include "mesh_fixtures.h"
#include "robot_tissue/core/cell_fill.h"
#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/lattice.h"

namespace robot_tissue::test_cell_fill {
namespace {

constexpr double kRounding = 1e-12;

double difference(const FillIntegrals& a, const FillIntegrals& b) {
  return std::abs(a.volume - b.volume) + (a.first - b.first).norm() + (a.second - b.second).norm() +
         std::abs(a.triple - b.triple);
}

// Of a box in the cell, in closed form.
FillIntegrals boxIntegrals(const Vec3& low, const Vec3& high) {
  const Vec3 size = high - low, middle = 0.5 * (low + high);
  FillIntegrals box;
  box.add(middle, size.prod());
  box.second.diagonal() += size.prod() / 12.0 * size.cwiseProduct(size);
  return box;
}

// Of the whole mesh, in spacings about the origin, by tetrahedra from there: the mean of x_a x_b
// over one is (sum of x_a x_b over its corners + 16 times that at its centroid) / 20.
FillIntegrals meshIntegrals(const TriangleMesh& mesh, double spacing) {
  FillIntegrals sum;
  for (const MeshTriangle& triangle : mesh.triangles) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = mesh.vertices[at(triangle[at(i)])] / spacing;
    const double volume = corners.determinant() / 6.0;
    const Vec3 centroid = corners.rowwise().sum() / 4.0;
    sum.volume += volume;
    sum.first += volume * centroid;
    sum.second +=
        volume / 20.0 * (corners * corners.transpose() + 16.0 * centroid * centroid.transpose());
  }
  return sum;
}

FillIntegrals integralsAt(const MeshCells& cells, int cell) {
  for (const auto& [number, integrals] : cells.partial) {
    if (number == cell) return integrals;
  }
  return integralsOf(CellFill()).scaledBy(cells.filled[at(cell)]);
}

std::array<int, 3> placeOf(const Grid& grid, int cell) {
  const int nx = grid.size()[0] - 1, ny = grid.size()[1] - 1;
  return {cell % nx, cell / nx % ny, cell / nx / ny};
}

TEST(CellFill, OfAFullCellIsTheSumOfItsOctants) {
  EXPECT_LT(difference(octantIntegrals(0xff), integralsOf(CellFill())), kRounding);
  for (int corner = 0; corner < kCorners; ++corner) {
    EXPECT_NEAR(CellFill().cornerShare(corner), 0.125, kRounding);
  }
}

TEST(CellFill, OfOneOctantIsAtItsCorner) {
  const CellFill fill = fillOf(octantIntegrals(1 << 5));
  EXPECT_NEAR(fill.share, 0.125, kRounding);
  EXPECT_LT((fill.centroid - Vec3(0.25, -0.25, 0.25)).norm(), kRounding);
  EXPECT_LT((fill.covariance() - Eigen::Matrix3d::Identity() / 48.0).norm(), kRounding);
  // The shape function of its corner is 3/4 along each axis in its middle, the opposite one's 1/4.
  EXPECT_NEAR(fill.cornerShare(5), 27.0 / 64.0, kRounding);
  EXPECT_NEAR(fill.cornerShare(2), 1.0 / 64.0, kRounding);
}

TEST(CellFill, OfABoxByAMeshIsInClosedForm) {
  const Vec3 low(0.3, -0.2, 0.6), high(0.9, 0.7, 0.95);
  const TriangleMesh box = boxMesh(low, high);
  const Grid grid({Vec3(0.0, -1.0, 0.0), Vec3(1.0, 1.0, 2.0)}, 1.0);
  const MeshCells cells = sliced(box, grid);
  ASSERT_EQ(cells.partial.size(), 2U);
  const FillIntegrals before = integralsAt(cells, 0), behind = integralsAt(cells, 1);
  const Vec3 half = Vec3::Constant(0.5);
  EXPECT_LT(difference(before, boxIntegrals({0.3 - 0.5, 0.3, 0.1}, {0.4, 0.5, 0.45})), kRounding);
  EXPECT_LT(difference(behind, boxIntegrals(Vec3(0.3, 0.0, 0.6) - half, high - half)), kRounding);
}

TEST(CellFill, OfASlicedMeshAddsUpToTheMesh) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> offset(-0.5, 0.5);
  const double spacing = 0.4;
  for (int trial = 0; trial < 5; ++trial) {
    const Vec3 by(offset(random), offset(random), offset(random));
    TriangleMesh ball = moved(sphereMesh(1.0, 2), Pose(Eigen::Translation3d(by)));
    // A second shell, inside out: the ball is hollow.
    const TriangleMesh hole = moved(sphereMesh(0.8, 2), Pose(Eigen::Translation3d(by)));
    const int first = static_cast<int>(ball.vertices.size());
    ball.vertices.insert(ball.vertices.end(), hole.vertices.begin(), hole.vertices.end());
    for (const auto& [a, b, c] : hole.triangles) {
      ball.triangles.push_back({first + a, first + c, first + b});
    }
    const Grid grid({Vec3::Constant(-2.0), Vec3::Constant(2.0)}, spacing);
    const MeshCells cells = sliced(ball, grid);
    FillIntegrals sum;
    for (int cell = 0; cell < grid.cellCount(); ++cell) {
      const FillIntegrals here = integralsAt(cells, cell);
      const auto place = placeOf(grid, cell);
      const Vec3 middle = Vec3(place[0], place[1], place[2]) + Vec3::Constant(0.5 - 2.0 / spacing);
      sum.volume += here.volume;
      sum.first += here.first + here.volume * middle;
      sum.second += here.second + here.first * middle.transpose() +
                    middle * here.first.transpose() + here.volume * middle * middle.transpose();
    }
    const FillIntegrals whole = meshIntegrals(ball, spacing);
    EXPECT_LT(std::abs(sum.volume - whole.volume), 1e-9);
    EXPECT_LT((sum.first - whole.first).norm(), 1e-8);
    EXPECT_LT((sum.second - whole.second).norm(), 1e-8);
  }
}

// Prisms stand along z: with the axes in another order they are others.
TEST(CellFill, IsTheSameInAxesInAnotherOrder) {
  const Pose turn(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()));
  const TriangleMesh here = moved(boxMesh(Vec3(-1.3, -0.7, -0.2), Vec3(1.1, 0.9, 0.25)), turn);
  Eigen::Matrix3d next = Eigen::Matrix3d::Zero();  // x to y, y to z, z to x
  next(1, 0) = next(2, 1) = next(0, 2) = 1.0;
  TriangleMesh there = here;
  for (Vec3& vertex : there.vertices) vertex = next * vertex;
  const Grid grid({Vec3::Constant(-2.0), Vec3::Constant(2.0)}, 0.5);
  const MeshCells cells = sliced(here, grid), turned = sliced(there, grid);
  EXPECT_GT(cells.partial.size(), 50U);
  EXPECT_EQ(cells.partial.size(), turned.partial.size());
  const int count = grid.size()[0] - 1;
  for (const auto& [cell, integrals] : cells.partial) {
    const auto place = placeOf(grid, cell);
    const FillIntegrals other =
        integralsAt(turned, place[2] + count * (place[0] + count * place[1]));
    EXPECT_NEAR(integrals.volume, other.volume, 1e-10);
    EXPECT_LT((next * integrals.first - other.first).norm(), 1e-10);
    EXPECT_LT((next * integrals.second * next.transpose() - other.second).norm(), 1e-10);
    EXPECT_NEAR(integrals.triple, other.triple, 1e-10);
  }
}

TEST(CellFill, OfALatticeIsThatOfItsMesh) {
  TissueConfig config;
  config.mesh = std::make_shared<TriangleMesh>(boxMesh(Vec3::Zero(), Vec3(0.03, 0.02, 0.013)));
  config.spacing = 0.01;
  const Lattice lattice(config);
  ASSERT_EQ(lattice.cells().size(), 12U);
  // The grid is centered: half of 0.7 spacings is empty below, half above.
  for (const Cell& cell : lattice.cells()) {
    const double side = lattice.gridIndex(cell.nodes.front())[2] == 0 ? 1.0 : -1.0;
    ASSERT_NE(cell.fill, nullptr);
    EXPECT_NEAR(cell.share(), 0.65, 1e-9);
    EXPECT_LT((cell.fill->centroid - Vec3(0, 0, 0.175 * side)).norm(), 1e-9);
    EXPECT_NEAR(cell.fill->covariance()(2, 2), 0.65 * 0.65 / 12.0, 1e-9);
  }
}

// A slab on the floor of a cell that stands on another one.
std::vector<Cell> stacked(double thickness, double below) {
  std::vector<Cell> cells(2);
  for (int corner = 0; corner < kCorners; ++corner) {
    cells[0].nodes[at(corner)] = corner;
    cells[1].nodes[at(corner)] = corner + 4;
  }
  const auto slab = [](double low, double high) {
    return SharedConst<CellFill>(fillOf(boxIntegrals({-0.5, -0.5, low}, {0.5, 0.5, high})));
  };
  if (below < 1.0) cells[0].fill = slab(0.5 - below, 0.5);
  cells[1].fill = slab(-0.5, -0.5 + thickness);
  return cells;
}

TEST(Slivers, BesideAFullCellBendAsThat) {
  std::vector<Cell> cells = stacked(0.1, 1.0);
  EXPECT_EQ(cells[1].fill->lent, 0.0);
  stiffenSlivers(cells, 12);
  EXPECT_EQ(cells[0].fill, nullptr);
  EXPECT_NEAR(cells[1].fill->lent, 1.0 / 12.0, kRounding);
  EXPECT_NEAR(cells[1].fill->spread[0], 0.01 / 12.0, kRounding);
  EXPECT_NEAR(cells[1].share(), 0.1, kRounding);
}

TEST(Slivers, BesideAThinWallStayThin) {
  std::vector<Cell> cells = stacked(0.1, 0.5);
  stiffenSlivers(cells, 12);
  for (const Cell& cell : cells) EXPECT_EQ(cell.fill->lent, 0.0);
}

}  // namespace
}  // namespace robot_tissue::test_cell_fill
