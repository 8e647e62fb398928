// The displayed surface: closed, outward, of the right volume, also along cuts.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "block_fixtures.h"
#include "cutting/cut.h"
#include "robot_tissue/core/surface.h"
#include "surface/hinges.h"

namespace robot_tissue::test_surface {
namespace {

constexpr double kSpacing = 0.01;

// How often each directed edge occurs.
std::map<std::pair<int, int>, int> edgesOf(const TissueSurface& surface) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& triangle : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{triangle[i], triangle[(i + 1) % 3]}];
  }
  return edges;
}

int countOpenEdges(const TissueSurface& surface) {
  const auto edges = edgesOf(surface);
  int open = 0;
  for (const auto& [edge, count] : edges) {
    const auto opposite = edges.find({edge.second, edge.first});
    if (opposite == edges.end() || opposite->second != count) ++open;
  }
  return open;
}

Vec3 areaOf(const TissueSurface& surface, std::size_t triangle) {
  const auto& corners = surface.triangles[triangle];
  const Vec3& a = surface.rest[at(corners[0])];
  return 0.5 * (surface.rest[at(corners[1])] - a).cross(surface.rest[at(corners[2])] - a);
}

// Area of the opened faces that look along the axis, either way.
double openedArea(const TissueSurface& surface, int axis) {
  double area = 0.0;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    if (surface.opened[i] != 0) area += std::abs(areaOf(surface, i)[axis]);
  }
  return area;
}

int countOpened(const TissueSurface& surface) {
  int opened = 0;
  for (const auto flag : surface.opened) opened += flag;
  return opened;
}

// Severs what a rectangle in the plane x = `x` crosses, from y0 to y1 and z0 to z1 (m).
LatticeState cutAcrossX(const Lattice& lattice, double x, double y0, double y1, double z0,
                        double z1) {
  LatticeState state = lattice.restState();
  const auto crossing =
      springsAcross(lattice, state, {{x, y0, z0}, {x, y1, z0}, {x, y1, z1}, {x, y0, z1}});
  sever(lattice, crossing, state);
  return state;
}

TEST(Surface, OfAWholeBlockIsClosedAndConsistentlyOriented) {
  const Lattice lattice(blockOf(4, 3, 2));
  const TissueSurface surface = extractSurface(lattice, lattice.restState());
  EXPECT_EQ(surface.triangles.size(), 4u * (4 * 3 + 3 * 2 + 2 * 4));
  ASSERT_EQ(surface.opened.size(), surface.triangles.size());
  EXPECT_EQ(countOpened(surface), 0);
  for (const auto& [edge, count] : edgesOf(surface)) EXPECT_EQ(count, 1);
  EXPECT_EQ(countOpenEdges(surface), 0);
}

TEST(Surface, HasItsVerticesOnTheOuterNodes) {
  const Lattice lattice(blockOf(4, 3, 2));
  const TissueSurface surface = extractSurface(lattice, lattice.restState());
  EXPECT_EQ(surface.rest.size(), 5u * 4u * 3u - 3u * 2u * 1u);
  ASSERT_EQ(surface.carriers.size(), surface.rest.size());
  for (std::size_t vertex = 0; vertex < surface.rest.size(); ++vertex) {
    ASSERT_EQ(surface.carriers[vertex].size(), 1u);
    const NodeWeight& carrier = surface.carriers[vertex][0];
    EXPECT_EQ(carrier.weight, 1.0);
    EXPECT_EQ(surface.rest[vertex], lattice.restPosition(carrier.node));
  }
}

TEST(Surface, LooksOutwardsOnEveryFace) {
  TissueConfig config = blockOf(3, 4, 5);
  config.shape.min() += Vec3(1.0, -2.0, 3.0);
  config.shape.max() += Vec3(1.0, -2.0, 3.0);
  const Lattice lattice(config);
  const TissueSurface surface = extractSurface(lattice, lattice.restState());
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const Vec3 normal = areaOf(surface, i).normalized();
    Vec3 middle = Vec3::Zero();
    for (const int corner : surface.triangles[i]) middle += surface.rest[at(corner)] / 3.0;
    Eigen::Index axis = 0;
    EXPECT_NEAR(normal.cwiseAbs().maxCoeff(&axis), 1.0, 1e-9);
    const double face = normal[axis] > 0.0 ? config.shape.max()[axis] : config.shape.min()[axis];
    EXPECT_NEAR(middle[axis], face, 1e-12);
  }
}

TEST(Surface, EnclosesTheVolumeOfTheBlock) {
  TissueConfig config = blockOf(3, 4, 5);
  config.shape.min() += Vec3(10.0, -20.0, 30.0);
  config.shape.max() += Vec3(10.0, -20.0, 30.0);
  const Lattice lattice(config);
  const TissueSurface surface = extractSurface(lattice, lattice.restState());
  EXPECT_NEAR(enclosedVolume(surface, surface.rest), 60e-6, 1e-9 * 60e-6);
}

// Else a symmetric press would look lopsided.
TEST(Surface, IsItsOwnMirrorImageWhereTheLatticeIs) {
  const Lattice lattice(blockOf(4, 4, 2));
  const TissueSurface surface = extractSurface(lattice, lattice.restState());
  const auto nodesOfTriangle = [&](std::size_t i, bool mirrored) {
    std::set<int> nodes;
    for (const int vertex : surface.triangles[i]) {
      auto n = lattice.gridIndex(surface.carriers[at(vertex)][0].node);
      if (mirrored) n[0] = 4 - n[0];
      nodes.insert(lattice.node(n[0], n[1], n[2]));
    }
    return nodes;
  };
  std::set<std::set<int>> triangles;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    triangles.insert(nodesOfTriangle(i, false));
  }
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    EXPECT_EQ(triangles.count(nodesOfTriangle(i, true)), 1u);
  }
}

TEST(Surface, FollowsTheDisplacements) {
  const Lattice lattice(blockOf(3, 3, 3));
  const TissueSurface surface = extractSurface(lattice, lattice.restState());
  std::vector<Vec3> displacement, vertices;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    displacement.push_back(Vec3(0.5, 0.2, -0.4).cwiseProduct(lattice.restPosition(node)));
  }
  deform(surface, displacement, vertices);
  for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
    const Vec3 stretched = Vec3(1.5, 1.2, 0.6).cwiseProduct(surface.rest[vertex]);
    EXPECT_LT((vertices[vertex] - stretched).norm(), 1e-15);
  }
  EXPECT_NEAR(enclosedVolume(surface, vertices), 1.5 * 1.2 * 0.6 * 27e-6, 1e-15);
}

// 8 x 6 x 4 cells, cut at mid-cell, 3 cells wide, the lower 2 layers of cells left whole.
class PartlyCutSurface : public ::testing::Test {
 protected:
  static constexpr double kMiddle = 3.5 * kSpacing;
  PartlyCutSurface()
      : lattice_(blockOf(8, 6, 4)),
        state_(cutAcrossX(lattice_, kMiddle, 0.6 * kSpacing, 4.4 * kSpacing, 1.6 * kSpacing, 1.0)),
        surface_(extractSurface(lattice_, state_)) {}
  Lattice lattice_;
  LatticeState state_;
  TissueSurface surface_;
};

TEST_F(PartlyCutSurface, IsClosed) {
  ASSERT_EQ(state_.springs_cut, 4 * 3);
  ASSERT_EQ(state_.pieces, 1);
  EXPECT_GT(countOpened(surface_), 0);
  EXPECT_EQ(countOpenEdges(surface_), 0);
}

TEST_F(PartlyCutSurface, KeepsTheVolume) {
  EXPECT_NEAR(enclosedVolume(surface_, surface_.rest), 8 * 6 * 4 * 1e-6, 1e-14);
}

TEST_F(PartlyCutSurface, OpensBothSidesOfTheCellsThatAreCutThrough) {
  const double cut_area = 3 * 2 * kSpacing * kSpacing;  // 3 x 2 cells lost all four springs
  EXPECT_NEAR(openedArea(surface_, 0), 2.0 * cut_area, 1e-12);
}

TEST_F(PartlyCutSurface, CarriesEveryVertexWholly) {
  for (const CarrierRange carriers : surface_.carriers) {
    double sum = 0.0;
    for (const NodeWeight& carrier : carriers) sum += carrier.weight;
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST_F(PartlyCutSurface, GapsWhereTheSidesArePulledApart) {
  std::vector<Vec3> displacement(at(lattice_.nodeCount()), Vec3::Zero());
  for (int node = 0; node < lattice_.nodeCount(); ++node) {
    const auto& [i, j, k] = lattice_.gridIndex(node);
    if (j < 1 || j > 4 || k < 2 || k > 4) continue;
    if (i == 3 || i == 4) displacement[at(node)].x() = (i == 3 ? -0.1 : 0.1) * kSpacing;
  }
  std::vector<Vec3> vertices;
  deform(surface_, displacement, vertices);
  EXPECT_LT(enclosedVolume(surface_, vertices),
            enclosedVolume(surface_, surface_.rest) - 0.1 * 3 * 2 * std::pow(kSpacing, 3));
}

// Cut right through at mid-cell: two pieces, 3.5 and 4.5 cells long.
class PartedSurface : public ::testing::Test {
 protected:
  PartedSurface()
      : lattice_(blockOf(8, 3, 4)),
        state_(cutAcrossX(lattice_, 3.5 * kSpacing, -1.0, 1.0, -1.0, 1.0)),
        surface_(extractSurface(lattice_, state_)) {}
  bool isLeft(int vertex) const {
    return lattice_.gridIndex(surface_.carriers[at(vertex)][0].node)[0] <= 3;
  }
  Lattice lattice_;
  LatticeState state_;
  TissueSurface surface_;
};

TEST_F(PartedSurface, IsTwoClosedPieces) {
  EXPECT_EQ(state_.springs_cut, 4 * 5);
  EXPECT_EQ(state_.pieces, 2);
  EXPECT_EQ(countOpenEdges(surface_), 0);
  EXPECT_NEAR(openedArea(surface_, 0), 2.0 * 3 * 4 * kSpacing * kSpacing, 1e-12);
  EXPECT_NEAR(openedArea(surface_, 1) + openedArea(surface_, 2), 0.0, 1e-12);
  for (const auto& triangle : surface_.triangles) {
    EXPECT_EQ(isLeft(triangle[0]), isLeft(triangle[1]));
    EXPECT_EQ(isLeft(triangle[0]), isLeft(triangle[2]));
  }
}

TEST_F(PartedSurface, PartsAtTheBlade) {
  for (std::size_t vertex = 0; vertex < surface_.rest.size(); ++vertex) {
    const double x = surface_.rest[vertex].x();
    if (isLeft(static_cast<int>(vertex))) {
      EXPECT_LE(x, 3.5 * kSpacing + 1e-12);
    } else {
      EXPECT_GE(x, 3.5 * kSpacing - 1e-12);
    }
  }
  EXPECT_NEAR(enclosedVolume(surface_, surface_.rest), 8 * 3 * 4 * 1e-6, 1e-14);
}

TEST_F(PartedSurface, OneHalfMovesWithoutTheOther) {
  const Vec3 away(0.05, 0.01, -0.02);
  std::vector<Vec3> displacement(at(lattice_.nodeCount()), Vec3::Zero());
  for (int node = 0; node < lattice_.nodeCount(); ++node) {
    if (lattice_.gridIndex(node)[0] > 3) displacement[at(node)] = away;
  }
  std::vector<Vec3> vertices;
  deform(surface_, displacement, vertices);
  int left = 0, right = 0;
  for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
    if (isLeft(static_cast<int>(vertex))) {
      ++left;
      EXPECT_EQ(vertices[vertex], surface_.rest[vertex]);
    } else {
      ++right;
      EXPECT_LT((vertices[vertex] - surface_.rest[vertex] - away).norm(), 1e-15);
    }
  }
  EXPECT_GT(left, 0);
  EXPECT_GT(right, 0);
  EXPECT_NEAR(enclosedVolume(surface_, vertices), 8 * 3 * 4 * 1e-6, 1e-14);
}

const std::vector<std::vector<Vec3>> kObliqueAndCrossing = {
    {{0.011, -0.01, -0.01}, {0.047, 0.07, -0.01}, {0.047, 0.07, 0.05}, {0.011, -0.01, 0.05}},
    {{-0.01, 0.023, 0.013}, {0.07, 0.033, 0.021}, {0.07, 0.033, 0.06}, {-0.01, 0.023, 0.06}},
    {{0.02, 0.02, 0.012}, {0.055, 0.02, 0.031}, {0.055, 0.05, 0.031}, {0.02, 0.05, 0.012}}};

TEST(Surface, StaysClosedAfterObliqueAndCrossingCuts) {
  const Lattice lattice(blockOf(6, 6, 4));
  LatticeState state = lattice.restState();
  for (const auto& corners : kObliqueAndCrossing) {
    const auto crossing = springsAcross(lattice, state, corners);
    ASSERT_FALSE(crossing.empty());
    sever(lattice, crossing, state);
    const TissueSurface surface = extractSurface(lattice, state);
    EXPECT_EQ(countOpenEdges(surface), 0);
    EXPECT_GT(countOpened(surface), 0);
    EXPECT_EQ(surface.opened.size(), surface.triangles.size());
    EXPECT_NEAR(enclosedVolume(surface, surface.rest), 144e-6, 0.05 * 144e-6);
  }
}

// What the springs hold together is the same with ghosts; they change who carries the cut faces.
TEST(Surface, OfPartsWithGhostsIsClosedAndDeformsAsTheMaterial) {
  const Lattice lattice(blockOf(6, 6, 4));
  LatticeState state = lattice.restState(), without = state;
  Eigen::Matrix3d gradient;
  gradient << 1.2, 0.3, -0.1, -0.4, 0.9, 0.2, 0.1, 0.5, 1.1;
  for (const auto& corners : kObliqueAndCrossing) {
    const auto crossing = springsAcross(lattice, state, corners);
    sever(lattice, crossing, state, SplitCells::kParted);
    sever(lattice, crossing, without);
    const TissueSurface surface = extractSurface(lattice, state);
    EXPECT_EQ(countOpenEdges(surface), 0);
    const TissueSurface plain = extractSurface(lattice, without);
    EXPECT_NEAR(enclosedVolume(surface, surface.rest), enclosedVolume(plain, plain.rest), 1e-12);
    std::vector<Vec3> displacement, vertices;
    for (int node = 0; node < state.cells->nodeCount(); ++node) {
      const Vec3 rest = restPosition(lattice, *state.cells, node);
      displacement.push_back(gradient * rest - rest);
    }
    ASSERT_GT(displacement.size(), at(lattice.nodeCount()));
    deform(surface, displacement, vertices);
    for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
      EXPECT_LT((vertices[vertex] - gradient * surface.rest[vertex]).norm(), 1e-14);
    }
  }
}

// Two tetrahedra with one corner in common: no edge has more than two triangles, but around that
// corner there are two fans.
TEST(Hinges, WedgesThatMeetAtAPointGetVerticesOfTheirOwn) {
  const Lattice lattice(blockOf(2, 2, 2, kSpacing));
  const LatticeState state = lattice.restState();
  TissueSurface surface;
  const Vec3 shared(0.5, 0.5, 0.5);
  const Vec3 sides[3] = {Vec3(0.3, 0.0, 0.0), Vec3(0.0, 0.3, 0.0), Vec3(0.0, 0.0, 0.3)};
  std::vector<Vec3> places = {shared};
  for (const double sign : {1.0, -1.0}) {
    for (const Vec3& side : sides) places.emplace_back(shared + sign * side);
  }
  for (const Vec3& place : places) {
    surface.rest.push_back(0.5 * kSpacing * place);
    surface.carriers.push_back({{0, 1.0}});
    surface.node.push_back(-1);
  }
  surface.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3},
                       {0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}};
  surface.opened.assign(surface.triangles.size(), 1);
  const std::vector<Octant> owners(surface.triangles.size(), Octant{0, 0});
  separateHinges(OctantGrid(lattice, state), owners, places, surface);
  ASSERT_EQ(surface.rest.size(), 8u);
  EXPECT_EQ(surface.rest.back(), surface.rest.front());
  EXPECT_EQ(countOpenEdges(surface), 0);
  std::set<int> first, second;
  for (std::size_t i = 0; i < 4; ++i) {
    first.insert(surface.triangles[i].begin(), surface.triangles[i].end());
    second.insert(surface.triangles[i + 4].begin(), surface.triangles[i + 4].end());
  }
  for (const int vertex : second) EXPECT_EQ(first.count(vertex), 0u) << vertex;
}

}  // namespace
}  // namespace robot_tissue::test_surface
