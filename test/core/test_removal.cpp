// Tissue that is taken away: volume, closed surfaces, forces, and the way back.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "block_fixtures.h"
#include "cutting/cut.h"
#include "cutting/removal.h"
#include "cutting/split_cells.h"
#include "mesh_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_removal {
namespace {

constexpr double kSpacing = 0.01;

TissueConfig blockFor(const std::string& model) {
  TissueConfig config = withFixedBottom(blockOf(8, 6, 5, kSpacing));
  config.model = model;
  return config;
}

SolverConfig solverFor(const std::string& model) {
  SolverConfig solver;
  solver.method = model == "elastic" ? "layered" : "paper";
  return solver;
}

LoadStep pressOn(const TissueConfig& config) {
  return loadOf({displacedPatch("punch", nodeBox(config, {1, 1, 5}, {2, 2, 5}), {0, 0, -0.004})});
}

RemovedSpace boxOfCells(const TissueConfig& config, const Eigen::Array3d& low,
                        const Eigen::Array3d& high) {
  const Vec3 first = config.shape.min();
  return PlacedBox{Box(first + kSpacing * low.matrix(), first + kSpacing * high.matrix())};
}

// Edges that two triangles do not run along in opposite directions.
int countOpenEdges(const TissueSurface& surface) {
  std::map<std::pair<int, int>, int> edges;
  for (const MeshTriangle& triangle : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{triangle[i], triangle[(i + 1) % 3]}];
  }
  int open = 0;
  for (const auto& [edge, count] : edges) {
    const auto opposite = edges.find({edge.second, edge.first});
    if (count != 1 || opposite == edges.end() || opposite->second != 1) ++open;
  }
  return open;
}

double volumeOf(const TissueSurface& surface) { return enclosedVolume(surface, surface.rest); }

double volumeOfPieces(const Tissue& tissue) {
  double volume = 0.0;
  for (const TissuePiece& piece : tissue.pieces()) volume += piece.volume;
  return volume;
}

class RemovalFrom : public ::testing::TestWithParam<std::string> {
 protected:
  const TissueConfig config_ = blockFor(GetParam());
  Tissue tissue_{config_, solverFor(GetParam())};
  const double cell_ = std::pow(kSpacing, 3);
};

TEST_P(RemovalFrom, TakesTheCellsInABoxAndLeavesAClosedSurface) {
  const double before = volumeOf(tissue_.surface());
  const RemoveReport report = tissue_.remove(boxOfCells(config_, {3, 2, 3}, {6, 4, 5}));
  EXPECT_NEAR(report.volume, 12.0 * cell_, 1e-9 * cell_);
  EXPECT_EQ(report.pieces, 1);
  EXPECT_NEAR(volumeOf(tissue_.surface()), before - 12.0 * cell_, 1e-9 * cell_);
  EXPECT_NEAR(volumeOfPieces(tissue_), before - 12.0 * cell_, 1e-9 * cell_);
  EXPECT_EQ(countOpenEdges(tissue_.surface()), 0);
  expectAtRest(tissue_);
}

TEST_P(RemovalFrom, TakesNothingWhereNothingIs) {
  const Snapshot before(tissue_);
  const RemoveReport report = tissue_.remove(Sphere{Vec3(1.0, 1.0, 1.0), 0.05});
  EXPECT_EQ(report.volume, 0.0);
  expectUnchanged(tissue_, before);
  EXPECT_EQ(tissue_.undoable(), 0);
}

TEST_P(RemovalFrom, RefusesWhatLeavesNothing) {
  const Snapshot before(tissue_);
  for (const RemovedSpace& space :
       {RemovedSpace(Sphere{Vec3::Zero(), 10.0}), RemovedSpace(Sphere{Vec3::Zero(), 0.0}),
        RemovedSpace(Sphere{Vec3::Zero(), std::nan("")}),
        RemovedSpace(PlacedBox{Box(Vec3::Zero(), Vec3::Zero())})}) {
    const std::string refusal = inputErrorOf([&] { tissue_.remove(space); });
    EXPECT_NE(refusal.find("; allowed: "), std::string::npos) << refusal;
    EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
  }
  const Box flat(Vec3(0.01, 0.02, 0.05), Vec3(0.02, 0.03, 0.05));
  EXPECT_EQ(inputErrorOf([&] {
              tissue_.remove(PlacedBox{flat});
            }).rfind("box: (0.01, 0.02, 0.05) to (0.02, 0.03, 0.05) m; allowed: ", 0),
            0U);
  EXPECT_EQ(inputErrorOf([&] {
              tissue_.remove(Sphere{Vec3(1.0, 0.0, 0.0), -2.0});
            }).rfind("sphere: at (1, 0, 0) m, of radius -2; allowed: ", 0),
            0U);
  expectUnchanged(tissue_, before);
}

TEST_P(RemovalFrom, PartsABlockInTwoWithoutAForceBetweenThem) {
  tissue_.remove(boxOfCells(config_, {4, 0, 0}, {5, 6, 5}));
  ASSERT_EQ(tissue_.state().pieces, 2);
  const std::vector<TissuePiece> pieces = tissue_.pieces();
  EXPECT_NEAR(pieces[0].volume, 4 * 6 * 5 * cell_, 1e-9 * cell_);
  EXPECT_NEAR(pieces[1].volume, 3 * 6 * 5 * cell_, 1e-9 * cell_);
  EXPECT_TRUE(pieces[0].fixed && pieces[1].fixed);
  EXPECT_LT(pieces[0].center.x(), pieces[1].center.x());
  tissue_.load(pressOn(config_));
  EXPECT_TRUE(isDeformed(tissue_));
  const std::vector<int> piece_of = tissue_.pieceOfNodes();
  for (int node = 0; node < tissue_.lattice().nodeCount(); ++node) {
    if (piece_of[at(node)] != 1) continue;
    ASSERT_EQ(tissue_.state().displacement[at(node)], Vec3(Vec3::Zero()));
  }
}

TEST_P(RemovalFrom, ComesBackBitForBit) {
  tissue_.load(pressOn(config_));
  const std::string before = tissue_.savedState();
  tissue_.remove(boxOfCells(config_, {4, 2, 2}, {7, 5, 5}));
  tissue_.cut({{0.025, -1, 0.02}, {0.025, 1, 0.02}, {0.025, 1, 1}, {0.025, -1, 1}});
  tissue_.remove(Sphere{config_.shape.min() + Vec3(0.0, 0.06, 0.05), 0.025});
  const std::string after = tissue_.savedState();
  EXPECT_EQ(countOpenEdges(tissue_.surface()), 0);
  ASSERT_EQ(tissue_.undoable(), 3);
  Tissue other(config_, solverFor(GetParam()));
  other.loadState(*other.readState(after));
  EXPECT_EQ(other.savedState(), after);
  EXPECT_EQ(other.vertices(), tissue_.vertices());
  EXPECT_EQ(other.surface().triangles, tissue_.surface().triangles);
  tissue_.undo(1);
  EXPECT_EQ(tissue_.undoable(), 2);
  tissue_.undo(2);
  EXPECT_EQ(tissue_.savedState(), before);
  EXPECT_EQ(tissue_.undoable(), 0);
  EXPECT_NE(inputErrorOf([&] { tissue_.undo(1); }), "");
}

TEST_P(RemovalFrom, ResetsToTheRestShape) {
  const std::string at_rest = tissue_.savedState();
  tissue_.remove(boxOfCells(config_, {4, 2, 2}, {7, 5, 5}));
  tissue_.load(pressOn(config_));
  tissue_.reset();
  EXPECT_EQ(tissue_.savedState(), at_rest);
  expectAtRest(tissue_);
}

INSTANTIATE_TEST_SUITE_P(Models, RemovalFrom, ::testing::Values("elastic", "six_spring"));

TEST(Removal, TakesWhatIsInTheSpaceAsTheShapeIsNow) {
  const TissueConfig config = blockFor("elastic");
  Tissue tissue(config, {});
  tissue.load(loadOf({displacedPatch("top", nodeBox(config, {0, 0, 5}, {8, 6, 5}), {0.02, 0, 0})}));
  // The top layer's cells have moved by nearly two spacings.
  const RemoveReport report = tissue.remove(boxOfCells(config, {8.1, 0, 4}, {20, 6, 5}));
  EXPECT_NEAR(report.volume, 2 * 6 * std::pow(kSpacing, 3), 1e-12);
}

// The two sides of a cut stand apart.
TEST(Removal, WhatComesBackGoesWhereItsSideOfACutWent) {
  TissueConfig config = blockOf(8, 6, 5, kSpacing);
  config.model = "elastic";
  const Lattice lattice(config);
  const double blade_at = 0.043, apart = 0.002;
  LatticeState whole = lattice.restState();
  sever(lattice,
        springsAcross(lattice, whole,
                      {{blade_at, -1, -1}, {blade_at, 1, -1}, {blade_at, 1, 1}, {blade_at, -1, 1}}),
        whole, SplitCells::kParted);
  LatticeState state = whole;
  const RemovedSpace ball = Sphere{Vec3(0.04, 0.03, 0.05), 0.022};
  removeCells(lattice, cellsWithin(lattice, state, ball), SplitCells::kParted, state);
  // Ghosts are of the other side than their originals.
  const auto wayOf = [&](const CellSet& cells, int node) {
    const bool is_low = lattice.restPosition(cells.original(node)).x() < blade_at;
    return is_low != cells.isGhost(node) ? -apart : apart;
  };
  for (int node = 0; node < state.cells->nodeCount(); ++node) {
    state.displacement[at(node)] = Vec3(wayOf(*state.cells, node), 0.0, 0.0);
  }
  restRemoved(state);
  whole.displacement = carriedOver(*state.cells, state.displacement, *whole.cells);
  moveWithNeighbors(lattice, state, whole);
  for (int node = 0; node < whole.cells->nodeCount(); ++node) {
    EXPECT_NEAR(whole.displacement[at(node)].x(), wayOf(*whole.cells, node), 1e-12) << node;
  }
}

TEST(Removal, LoadsLoseTheNodesThatGo) {
  const TissueConfig config = blockFor("elastic");
  Tissue tissue(config, {});
  tissue.load(loadOf({displacedPatch("far", nodeBox(config, {0, 0, 5}, {1, 6, 5}), {0, 0, -0.002}),
                      forcedPatch("near", nodeBox(config, {7, 0, 5}, {8, 6, 5}), {0, 0, -0.2})}));
  const RemoveReport report = tissue.remove(boxOfCells(config, {6, -1, 3}, {9, 7, 9}));
  EXPECT_EQ(report.loads, std::vector<std::string>{"near"});
  ASSERT_EQ(tissue.namedPatches(), 1U);
  EXPECT_EQ(tissue.patches()[0].name, "far");
  EXPECT_EQ(report.solve.status, SolveStatus::kOk);
  tissue.undo(1);
  EXPECT_EQ(tissue.namedPatches(), 2U);
}

// A bar pulled along x: half of its cross section is as stiff as half a bar.
TEST(Removal, LeavesABarHalfAsStiff) {
  TissueConfig config = blockOf(6, 2, 2, kSpacing);
  config.model = "elastic";
  config.material.poisson_ratio = 0.25;
  const Vec3 low = config.shape.min();
  config.fixed = {nodeBox(config, {0, 0, 0}, {0, 2, 2})};
  SolverConfig solver;
  solver.tolerance = 1e-4;
  const LoadStep pull =
      loadOf({displacedPatch("end", nodeBox(config, {6, 0, 0}, {6, 2, 2}), {0.0006, 0, 0})});
  const auto force = [&](bool halved) {
    Tissue tissue(config, solver);
    if (halved) tissue.remove(PlacedBox{Box(low, low + Vec3(0.06, 0.02, 0.01))});
    return reportsOf(tissue, pull).back().patches[0].force.x();
  };
  TissueConfig thin = blockOf(6, 2, 1, kSpacing);
  thin.model = "elastic";
  thin.material = config.material;
  thin.fixed = {nodeBox(thin, {0, 0, 0}, {0, 2, 1})};
  Tissue other(thin, solver);
  const double alone =
      reportsOf(
          other,
          loadOf({displacedPatch("end", nodeBox(thin, {6, 0, 0}, {6, 2, 1}), {0.0006, 0, 0})}))
          .back()
          .patches[0]
          .force.x();
  EXPECT_NEAR(force(true) / alone, 1.0, 2e-3);
  EXPECT_LT(force(true), 0.6 * force(false));
}

TEST(Removal, WeighsWhatIsLeft) {
  TissueConfig config = blockFor("elastic");
  config.gravity = {0, 0, -9.81};
  Tissue tissue(config, {});
  tissue.settle();
  tissue.remove(boxOfCells(config, {0, 0, 3}, {8, 6, 5}));
  EXPECT_NEAR(tissue.weight().z(), -9.81 * 1000.0 * 0.08 * 0.06 * 0.03, 1e-9);
  EXPECT_NEAR((tissue.forceOfFixedNodes() + tissue.weight()).norm(), 0.0,
              0.02 * tissue.weight().norm());
}

TEST(Removal, OpensAMeshAlongItsCells) {
  TissueConfig config;
  config.spacing = kSpacing;
  config.mesh = std::make_shared<const TriangleMesh>(sphereMesh(0.035, 3));
  config.fixed = {Box(Vec3(-1, -1, -1), Vec3(1, 1, -0.02))};
  config.material.young_modulus = 1e4;
  Tissue tissue(config, {});
  const double before = volumeOf(tissue.surface());
  const RemoveReport report = tissue.remove(Sphere{Vec3(0, 0, 0.035), 0.02});
  EXPECT_GT(report.volume, 0.0);
  EXPECT_EQ(countOpenEdges(tissue.surface()), 0);
  EXPECT_NEAR(volumeOf(tissue.surface()), before - report.volume, 1e-6 * before);
  tissue.cut({{0.003, -1, -1}, {0.003, 1, -1}, {0.003, 1, 1}, {0.003, -1, 1}});
  EXPECT_EQ(countOpenEdges(tissue.surface()), 0);
  tissue.remove(PlacedBox{Box(Vec3(0.003, -1, -0.01), Vec3(1, 1, 1))});
  EXPECT_EQ(countOpenEdges(tissue.surface()), 0);
  // Pieces end at the blade; the wound of a mesh is shown half way between nodes, so by up to half
  // a spacing beside it.
  const double section = M_PI * 0.035 * 0.035;
  EXPECT_NEAR(volumeOf(tissue.surface()), volumeOfPieces(tissue), 0.5 * kSpacing * section);
}

}  // namespace
}  // namespace robot_tissue::test_removal
