// Meshes sliced by the grid: the filled cells hold the mesh's volume wherever the grid lies.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "geometry/mesh_slicing.h"
#include "mesh_fixtures.h"
#include "robot_tissue/core/mesh_checks.h"

namespace robot_tissue::test_mesh_slicing {
namespace {

constexpr double kSpacing = 0.005;

double filledVolume(const MeshCells& cells, double spacing) {
  return std::accumulate(cells.filled.begin(), cells.filled.end(), 0.0) * spacing * spacing *
         spacing;
}

// Holds the mesh, its nodes at a random place.
Grid shiftedGrid(const TriangleMesh& mesh, double spacing, Random& random) {
  Box box = boundsOf(mesh.vertices);
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] -= random.between(0.0, spacing);
    box.max()[axis] =
        box.min()[axis] + spacing * std::ceil((box.max()[axis] - box.min()[axis]) / spacing + 1.0);
  }
  return Grid(box, spacing);
}

std::array<int, 3> cellCount(const Grid& grid) {
  return {grid.size()[0] - 1, grid.size()[1] - 1, grid.size()[2] - 1};
}

Vec3 lowestNode(const Grid& grid, std::size_t cell) {
  const auto count = cellCount(grid);
  const int index = static_cast<int>(cell);
  return grid.shape().min() + grid.spacing() * Vec3(index % count[0], index / count[0] % count[1],
                                                    index / count[0] / count[1]);
}

// How far the point is from the nearest occupied cell, along the axis where it is furthest.
double distanceToOccupied(const Vec3& point, const MeshCells& cells, const Grid& grid) {
  double nearest = 1e9;
  for (std::size_t cell = 0; cell < cells.occupied.size(); ++cell) {
    if (cells.occupied[cell] == 0) continue;
    const Vec3 half = Vec3::Constant(0.5 * grid.spacing());
    const Vec3 from_middle = point - lowestNode(grid, cell) - half;
    nearest = std::min(nearest, (from_middle.cwiseAbs() - half).maxCoeff());
  }
  return nearest;
}

TEST(MeshSlicing, AlignedBoxFillsItsCellsAndTouchesNoOthers) {
  const TriangleMesh box = boxMesh(Vec3(0.1, 0.0, -0.02), Vec3(0.13, 0.02, 0.005));
  const Grid around = gridAround(box, kSpacing);
  EXPECT_EQ(cellCount(around), (std::array<int, 3>{6, 4, 5}));
  EXPECT_NEAR((around.shape().min() - Vec3(0.1, 0.0, -0.02)).norm(), 0.0, 1e-12);
  const MeshCells cells = sliced(box, around);
  for (const double filled : cells.filled) EXPECT_EQ(filled, 1.0);
  // One cell more all round.
  const Vec3 margin = Vec3::Constant(kSpacing);
  const Grid wider({around.shape().min() - margin, around.shape().max() + margin}, kSpacing);
  const MeshCells in_wider = sliced(box, wider);
  EXPECT_NEAR(filledVolume(in_wider, kSpacing), 0.03 * 0.02 * 0.025, 1e-15);
  EXPECT_EQ(std::accumulate(in_wider.occupied.begin(), in_wider.occupied.end(), 0), 6 * 4 * 5);
  EXPECT_EQ(std::count(in_wider.filled.begin(), in_wider.filled.end(), 1.0), 6 * 4 * 5);
}

// Coordinates of a file are rounded to float.
TEST(MeshSlicing, RoundedBoxIsSlicedLikeTheExactOne) {
  TriangleMesh box = boxMesh(Vec3(0.1, 0.0, -0.02), Vec3(0.13, 0.02, 0.005));
  for (Vec3& vertex : box.vertices) vertex = vertex.cast<float>().cast<double>();
  const Grid grid = gridAround(box, kSpacing);
  EXPECT_EQ(cellCount(grid), (std::array<int, 3>{6, 4, 5}));
  const Vec3 margin = Vec3::Constant(kSpacing);
  const MeshCells cells =
      sliced(box, Grid({grid.shape().min() - margin, grid.shape().max() + margin}, kSpacing));
  EXPECT_EQ(std::accumulate(cells.occupied.begin(), cells.occupied.end(), 0), 6 * 4 * 5);
}

TEST(MeshSlicing, ShareOfEachCellOfAShiftedBoxIsKnown) {
  const Vec3 low(0.2, 0.3, 0.4);
  const Vec3 high(2.7, 1.9, 3.1);
  const Grid grid({Vec3::Zero(), Vec3(3.0, 2.0, 4.0)}, 1.0);
  const MeshCells cells = sliced(boxMesh(low, high), grid);
  for (std::size_t cell = 0; cell < cells.filled.size(); ++cell) {
    const Vec3 from = lowestNode(grid, cell).cwiseMax(low);
    const Vec3 to = (lowestNode(grid, cell) + Vec3::Ones()).cwiseMin(high);
    EXPECT_NEAR(cells.filled[cell], (to - from).cwiseMax(0.0).prod(), 1e-12) << cell;
    EXPECT_NE(cells.occupied[cell], 0);
  }
}

TEST(MeshSlicing, VolumeDoesNotDependOnTheGridsPlace) {
  Random random;
  const std::vector<TriangleMesh> meshes = {
      sphereMesh(0.02, 3),
      boxMesh(Vec3::Zero(), Vec3(0.04, 0.03, 0.0004)),  // a plate of a twelfth of the spacing
      joined(sphereMesh(0.02, 2), insideOut(sphereMesh(0.012, 2)))};  // a cavity
  for (const TriangleMesh& mesh : meshes) {
    const double volume = volumeOf(mesh);
    for (int trial = 0; trial < 10; ++trial) {
      const TriangleMesh turned = moved(mesh, random.pose(0.1));
      const MeshCells cells = sliced(turned, shiftedGrid(turned, kSpacing, random));
      EXPECT_NEAR(filledVolume(cells, kSpacing) / volume, 1.0, 1e-9);
      EXPECT_LE(*std::max_element(cells.filled.begin(), cells.filled.end()), 1.0);
      EXPECT_GE(*std::min_element(cells.filled.begin(), cells.filled.end()), 0.0);
    }
  }
}

// Against counting points: cells of a ball, each by 12^3 points.
TEST(MeshSlicing, EachCellHoldsItsShareOfABall) {
  const double radius = 0.0163;
  const TriangleMesh ball = sphereMesh(radius, 5);
  const Grid grid({Vec3(-0.018, -0.0194, -0.0172), Vec3(0.022, 0.0206, 0.0228)}, kSpacing);
  const MeshCells cells = sliced(ball, grid);
  constexpr int kPoints = 12;
  for (std::size_t cell = 0; cell < cells.filled.size(); ++cell) {
    int inside = 0;
    for (int i = 0; i < kPoints * kPoints * kPoints; ++i) {
      const Vec3 place(i % kPoints, i / kPoints % kPoints, i / kPoints / kPoints);
      const Vec3 offset = (place + Vec3::Constant(0.5)) * (kSpacing / kPoints);
      inside += (lowestNode(grid, cell) + offset).norm() < radius ? 1 : 0;
    }
    EXPECT_NEAR(cells.filled[cell], inside / 1728.0, 0.02) << cell;
  }
}

// Vertices and edges straight above nodes and edges of the grid: nothing is counted twice.
TEST(MeshSlicing, VerticesOnTheGridAreNoSpecialCase) {
  TriangleMesh octahedron = sphereMesh(3.0, 0);
  const MeshCells cells =
      sliced(octahedron, Grid({Vec3::Constant(-3.0), Vec3::Constant(3.0)}, 1.0));
  EXPECT_NEAR(filledVolume(cells, 1.0), volumeOf(octahedron), 1e-12);
  const auto filledAt = [&cells](int i, int j, int k) {
    return cells.filled[at(i + 6 * (j + 6 * k))];
  };
  EXPECT_EQ(filledAt(3, 3, 3), 1.0);
  EXPECT_NEAR(filledAt(3, 3, 5), 1.0 / 6.0, 1e-12);  // x + y + z < 3, z > 2
  EXPECT_NEAR(filledAt(4, 3, 4), 1.0 / 6.0, 1e-12);
  EXPECT_NEAR(filledAt(4, 3, 3), 5.0 / 6.0, 1e-12);
  EXPECT_EQ(filledAt(5, 5, 5), 0.0);
  EXPECT_EQ(cells.occupied[at(5 + 6 * (5 + 6 * 5))], 0);
}

TEST(MeshSlicing, OrderAndTurnOfTheTrianglesDoNotMatter) {
  Random random;
  const TriangleMesh ball = moved(sphereMesh(0.02, 3), random.pose(0.1));
  TriangleMesh shuffled = ball;
  std::reverse(shuffled.triangles.begin(), shuffled.triangles.end());
  for (auto& [a, b, c] : shuffled.triangles) {
    std::swap(a, b);
    std::swap(b, c);
  }
  const Grid grid = shiftedGrid(ball, kSpacing, random);
  const MeshCells first = sliced(ball, grid);
  const MeshCells second = sliced(shuffled, grid);
  EXPECT_EQ(first.occupied, second.occupied);
  for (std::size_t cell = 0; cell < first.filled.size(); ++cell) {
    EXPECT_NEAR(first.filled[cell], second.filled[cell], 1e-9);
  }
}

TEST(MeshSlicing, EveryVertexLiesInAnOccupiedCell) {
  Random random;
  // A needle of a fiftieth of the spacing fills next to nothing, and is there.
  const std::vector<TriangleMesh> meshes = {sphereMesh(0.02, 3),
                                            boxMesh(Vec3::Zero(), Vec3(0.04, 0.03, 0.0004)),
                                            boxMesh(Vec3::Zero(), Vec3(0.05, 0.0001, 0.0001))};
  for (const TriangleMesh& mesh : meshes) {
    for (int trial = 0; trial < 5; ++trial) {
      const TriangleMesh fine = refined(moved(mesh, random.pose(0.1)), 0.5 * kSpacing);
      for (const Grid& grid : {gridAround(fine, kSpacing), shiftedGrid(fine, kSpacing, random)}) {
        const MeshCells cells = sliced(fine, grid);
        double furthest = -1.0;
        for (const Vec3& vertex : fine.vertices) {
          furthest = std::max(furthest, distanceToOccupied(vertex, cells, grid));
        }
        EXPECT_LE(furthest, 1.001e-3 * kSpacing);
      }
    }
  }
}

TEST(MeshSlicing, GridAroundIsCenteredAndMovesWithTheMesh) {
  const TriangleMesh ball = sphereMesh(0.0163, 3);
  const Grid grid = gridAround(ball, kSpacing);
  EXPECT_EQ(cellCount(grid), (std::array<int, 3>{7, 7, 7}));
  EXPECT_NEAR((grid.shape().min() + grid.shape().max()).norm(), 0.0, 1e-12);
  EXPECT_TRUE(spacingFits(grid.shape().max() - grid.shape().min(), kSpacing));
  const Vec3 offset(0.0317, -0.2213, 1.0171);
  const TriangleMesh away = moved(ball, offset);
  const MeshCells here = sliced(ball, grid);
  const MeshCells there = sliced(away, gridAround(away, kSpacing));
  ASSERT_EQ(here.filled.size(), there.filled.size());
  for (std::size_t cell = 0; cell < here.filled.size(); ++cell) {
    EXPECT_NEAR(here.filled[cell], there.filled[cell], 1e-9);
  }
}

}  // namespace
}  // namespace robot_tissue::test_mesh_slicing
