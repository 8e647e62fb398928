// Where a cut ends inside: the lattice opens as far as the blade went, and holds together beyond.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "cutting/cut.h"
#include "cutting/cut_front.h"
#include "elastic_fixtures.h"
#include "robot_tissue/core/tissue.h"
#include "tissue/front_ties.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_cut_front {
namespace {

constexpr double kSpacing = 0.005;
constexpr std::array<int, 3> kCells = {8, 2, 6};

TissueConfig block() {
  TissueConfig config = blockOf(kCells[0], kCells[1], kCells[2], kSpacing);
  config.model = "elastic";
  config.material.poisson_ratio = 0.45;
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, kCells[1], kCells[2]}));
  return config;
}

// From above, across x at 4.25 spacings, that many spacings deep.
std::vector<Vec3> slit(double depth) {
  const double x = 4.25 * kSpacing, z = (kCells[2] - depth) * kSpacing;
  return {{x, -1.0, z}, {x, 1.0, z}, {x, 1.0, 1.0}, {x, -1.0, 1.0}};
}

// The strip of that slit between two depths.
std::vector<CutTriangle> strip(double from, double to) {
  const std::vector<Vec3> upper = slit(from), lower = slit(to);
  return {{lower[0], lower[1], upper[1]}, {lower[0], upper[1], upper[0]}};
}

LoadStep drawnBy(const TissueConfig& config, double way) {
  const Box end = nodeBox(config, {kCells[0], 0, 0}, kCells);
  return loadOf({displacedPatch("end", end, {way, 0, 0})});
}

double forceOf(Tissue& tissue, const TissueConfig& config) {
  const SolveReport report = reportsOf(tissue, drawnBy(config, 0.0004)).back();
  EXPECT_EQ(report.status, SolveStatus::kOk);
  return report.patches[0].force.x();
}

double forceAt(double depth, const std::string& method = "newton", double tolerance = 1e-4) {
  const TissueConfig config = block();
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = tolerance;
  Tissue tissue(config, solver);
  tissue.cut(slit(depth));
  return forceOf(tissue, config);
}

TEST(CutFront, ForceFallsEvenlyAsTheBladeGoesThroughACell) {
  const double whole = forceAt(2.0), parted = forceAt(3.0);
  const double step = (whole - parted) / 5.0;
  double before = whole;
  for (const double depth : {2.2, 2.4, 2.6, 2.8, 3.0}) {
    const double force = forceAt(depth);
    EXPECT_GT(before - force, 0.5 * step) << depth;
    EXPECT_LT(before - force, 1.5 * step) << depth;
    before = force;
  }
}

// Leaning by a quarter, 2.46 spacings deep, its end at this place along x (spacings).
double forceLeaningAt(double place) {
  const double lean = 0.25, z = (kCells[2] - 2.46) * kSpacing, top = 8.0 * kSpacing;
  const double low = place * kSpacing, high = low + lean * (top - z);
  const TissueConfig config = block();
  SolverConfig solver;
  solver.method = "newton";
  Tissue tissue(config, solver);
  tissue.cut({{low, -1.0, z}, {low, 1.0, z}, {high, 1.0, top}, {high, -1.0, top}});
  return forceOf(tissue, config);
}

// Also where the blade's surface goes on through springs across it.
TEST(CutFront, HoldsAsMuchWhereverALeaningCutIsBetweenTheNodes) {
  const double force = forceLeaningAt(4.4);
  for (const double place : {4.04, 4.1, 4.2, 4.7}) {
    EXPECT_NEAR(forceLeaningAt(place), force, 0.03 * force) << place;
  }
}

TEST(CutFront, AllMethodsFindTheSame) {
  const double force = forceAt(2.4);
  for (const char* method : {"layered", "explicit"}) {
    EXPECT_NEAR(forceAt(2.4, method), force, 3e-3 * force) << method;
  }
  // Rounding, which hangs on how it is compiled, ends its sweeps near 1e-4.
  EXPECT_NEAR(forceAt(2.4, "vbd", 5e-4), force, 3e-3 * force);
}

TEST(CutFront, NothingPullsInALinearDeformationOrATurn) {
  ElasticBlock slitted(block());
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
  gradient(0, 0) = 1.02;
  gradient(0, 2) = 0.01;
  deformBy(slitted.lattice, gradient, slitted.state);
  const double energy = slitted.model.energy(slitted.state);
  const auto crossings = springsAcross(slitted.lattice, slitted.state, slit(2.4));
  const BladeSurface blade = BladeSurface::of(slit(2.4), kSpacing);
  sever(slitted.lattice, crossings, blade, slitted.state, SplitCells::kParted);
  const auto ties = tiesOfFronts(slitted.lattice, slitted.state, slitted.model);
  ASSERT_FALSE(ties.empty());
  EXPECT_NEAR(slitted.model.energy(slitted.state), energy, 1e-12 * energy);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).matrix();
  for (int node = 0; node < slitted.state.cells->nodeCount(); ++node) {
    const Vec3 rest = restPosition(slitted.lattice, *slitted.state.cells, node);
    slitted.state.displacement[at(node)] = turn * rest - rest;
  }
  EXPECT_LT(greatestForce(slitted.model.nodeForces(slitted.state)), 1e-12);
  for (const ContactSpring& tie : ties) {
    EXPECT_LT(robot_tissue::forceOf(tie, slitted.state.displacement).norm(), 1e-12);
  }
}

TEST(CutFront, OneStrokeIsAsTwo) {
  const TissueConfig config = block();
  SolverConfig solver;
  solver.method = "newton";
  Tissue at_once(config, solver), by_strips(config, solver);
  at_once.cutAlong(strip(-1.0, 2.75));
  by_strips.cutAlong(strip(-1.0, 2.25));
  by_strips.cutAlong(strip(2.25, 2.5), Stroke::kGoesOn);
  by_strips.cutAlong(strip(2.5, 2.75), Stroke::kGoesOn);
  EXPECT_EQ(by_strips.undoable(), 1);
  const double force = forceOf(at_once, config);
  EXPECT_NEAR(forceOf(by_strips, config), force, 1e-6 * force);
}

TEST(CutFront, ACutThatEndsBelowTheLastNodesHoldsAtThese) {
  const TissueConfig config = block();
  Tissue tissue(config, {});
  const CutReport report = tissue.cut(slit(kCells[2] - 0.1));
  EXPECT_EQ(report.pieces, 1);
  const CellSet& cells = *tissue.state().cells;
  for (const Cell& cell : cells.all()) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const int node = cell.nodes[at(corner)];
      const bool is_lowest = tissue.lattice().gridIndex(cells.original(node))[2] == 0;
      EXPECT_FALSE(is_lowest && cells.isGhost(node));
    }
  }
}

TEST(CutFront, ComesBackWithUndoAndSavedStates) {
  const TissueConfig config = block();
  Tissue tissue(config, {});
  tissue.load(drawnBy(config, 0.0004));
  const std::string whole = tissue.savedState();
  tissue.cut(slit(2.3));
  const std::string slitted = tissue.savedState();
  tissue.cut(slit(3.6));
  tissue.undo(1);
  EXPECT_EQ(tissue.savedState(), slitted);
  tissue.undo(1);
  EXPECT_EQ(tissue.savedState(), whole);
  Tissue other(config, {});
  other.loadState(*other.readState(slitted));
  EXPECT_EQ(other.savedState(), slitted);
  EXPECT_EQ(other.state().ahead.size(), 3u);
}

TEST(CutFront, IsGoneOnceTheCutGoesThrough) {
  Tissue tissue(block(), {});
  tissue.cut(slit(2.3));
  EXPECT_FALSE(tissue.state().ahead.empty());
  EXPECT_EQ(tissue.cut(slit(10.0)).pieces, 2);
  EXPECT_TRUE(tissue.state().ahead.empty());
  tissue.reset();
  tissue.cut(slit(2.3));
  tissue.reset();
  EXPECT_TRUE(tissue.state().ahead.empty());
}

// What tears next is told by the strain at the springs that tore or were cut last.
TEST(CutFront, IsNotKeptInTissueThatTears) {
  TissueConfig config = block();
  config.material.tear_stretch = 1.5;
  Tissue tissue(config, {});
  tissue.cut(slit(2.3));
  EXPECT_TRUE(tissue.state().ahead.empty());
}

}  // namespace
}  // namespace robot_tissue::test_cut_front
