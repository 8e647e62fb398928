// Motion in time, against what mechanics says of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "elastic_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_time {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGravity = 9.81;

SolverConfig solverOf(const std::string& method, int threads = 1) {
  SolverConfig solver;
  solver.method = method;
  solver.threads = threads;
  return solver;
}

TissueConfig inTime(TissueConfig config, double damping_time = 0.0) {
  config.time = TimeConfig{damping_time};
  return config;
}

// A bar along x of 400 x 40 x 40 mm, clamped at one end.
TissueConfig bar(double damping_time, int cells = 4) {
  const double spacing = 0.04 / cells;
  TissueConfig config = inTime(blockOf(10 * cells, cells, cells, spacing), damping_time);
  config.model = "elastic";
  config.material.young_modulus = 1e7;
  config.material.poisson_ratio = 0.25;
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, cells, cells}));
  return config;
}

// Bends the bar by its free end, which then is let go.
void bendAndRelease(Tissue& tissue, double way) {
  PatchConfig end = displacedPatch(
      "end", {Vec3(0.4 - 1e-6, -1.0, -1.0), Vec3(0.4 + 1e-6, 1.0, 1.0)}, Vec3(0.0, 0.0, -way));
  end.displacement->at(0).reset();
  end.displacement->at(1).reset();
  tissue.load(loadOf({end}));
  tissue.release({"end"});
}

int tipOf(const Tissue& tissue) {
  return tissue.lattice()
      .nodesIn({Vec3(0.4 - 1e-6, 0.02 - 1e-6, 0.02 - 1e-6), Vec3(0.5, 0.02 + 1e-6, 0.02 + 1e-6)})
      .front();
}

struct Swing {
  std::vector<double> zeros;  // times (s)
  std::vector<double> peaks;  // between them (m)

  double frequency() const {
    return 0.5 * static_cast<double>(zeros.size() - 1) / (zeros.back() - zeros.front());
  }
  // From the logarithmic decrement, two peaks a period.
  double dampingRatio() const {
    return std::log(peaks.front() / peaks.back()) / (static_cast<double>(peaks.size() - 1) * kPi);
  }
};

Swing swingOf(Tissue& tissue, double duration, double interval) {
  const std::size_t tip = at(tipOf(tissue));
  Swing swing;
  double before = tissue.state().displacement[tip].z(), peak = 0.0;
  for (double time = interval; time <= duration; time += interval) {
    EXPECT_EQ(tissue.wait(interval).status, SolveStatus::kOk) << time;
    const double now = tissue.state().displacement[tip].z();
    peak = std::max(peak, std::abs(now));
    if (now * before < 0.0) {
      if (!swing.zeros.empty()) swing.peaks.push_back(peak);
      swing.zeros.push_back(time - interval * now / (now - before));
      peak = 0.0;
    }
    before = now;
  }
  return swing;
}

// Of a clamped bar's bending (Euler and Bernoulli), with its length, thickness, modulus, density.
double beamFrequency() {
  return 1.8751 * 1.8751 / (2.0 * kPi) * std::sqrt(1e7 * 0.04 * 0.04 / 12.0 / 1000.0) / (0.4 * 0.4);
}

TEST(Time, IsNotThereUnlessAsked) {
  const Tissue tissue(withFixedBottom(blockOf(4, 4, 4)), paperSolver());
  EXPECT_FALSE(tissue.hasTime());
  EXPECT_FALSE(tissue.isMoving());
}

TEST(Time, FreeFallIsThatOfGalilei) {
  for (const char* method : {"layered", "newton"}) {
    TissueConfig config = inTime(elasticBlockOf(6, 5, 4, 0.45));
    config.gravity = Vec3(0.0, 0.0, -kGravity);
    Tissue tissue(config, solverOf(method));
    EXPECT_EQ(tissue.wait(0.1).status, SolveStatus::kOk);
    const double fallen = 0.5 * kGravity * 0.1 * 0.1;
    for (const Vec3& displacement : tissue.state().displacement) {
      ASSERT_LT((displacement - Vec3(0.0, 0.0, -fallen)).norm(), 1e-6 * fallen) << method;
    }
  }
}

TEST(Time, BarSwingsAsABeamDoes) {
  Tissue tissue(bar(0.0), solverOf("layered"));
  bendAndRelease(tissue, 0.004);
  const Swing swing = swingOf(tissue, 1.0, 0.002);
  ASSERT_GE(swing.zeros.size(), 7U);
  EXPECT_NEAR(swing.frequency(), beamFrequency(), 0.02 * beamFrequency());
  EXPECT_NEAR(swing.dampingRatio(), 0.0, 0.002);
}

// A mode of the circular frequency w is damped by the ratio w damping_time / 2.
TEST(Time, DampingIsProportionalToStiffness) {
  Tissue tissue(bar(0.002), solverOf("layered"));
  bendAndRelease(tissue, 0.004);
  const Swing swing = swingOf(tissue, 1.0, 0.002);
  const double expected = kPi * swing.frequency() * 0.002;
  EXPECT_NEAR(swing.dampingRatio(), expected, 0.05 * expected);
}

TEST(Time, MethodsSwingAlike) {
  std::vector<double> tips;
  for (const char* method : {"layered", "newton"}) {
    Tissue tissue(bar(0.002, 2), solverOf(method));
    bendAndRelease(tissue, 0.004);
    tissue.wait(0.1);
    tips.push_back(tissue.state().displacement[at(tipOf(tissue))].z());
  }
  EXPECT_NEAR(tips[0], tips[1], 0.01 * 0.004);
}

TEST(Time, SwingNeverGrowsWhateverTheSteps) {
  Tissue tissue(bar(0.0, 2), solverOf("layered"));
  bendAndRelease(tissue, 0.004);
  const std::size_t tip = at(tipOf(tissue));
  std::mt19937 random(1);
  for (int step = 0; step < 400; ++step) {
    tissue.wait(1e-4 * static_cast<double>(1 + random() % 200));
    ASSERT_LT(std::abs(tissue.state().displacement[tip].z()), 1.02 * 0.004) << step;
  }
}

TEST(Time, FloatingBlockKeepsItsCenterOfMass) {
  TissueConfig config = inTime(elasticBlockOf(6, 4, 4, 0.3));
  Tissue tissue(config, solverOf("layered"));
  const Vec3 squeeze(0.005, 0.0, 0.0);
  tissue.load(loadOf({displacedPatch("left", nodeBox(config, {0, 0, 0}, {0, 4, 4}), squeeze),
                      displacedPatch("right", nodeBox(config, {6, 0, 0}, {6, 4, 4}), -squeeze)}));
  const auto center = [&] {
    Vec3 sum = Vec3::Zero();
    double mass = 0.0;
    for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
      sum += tissue.lattice().mass(node) * tissue.nodePosition(node);
      mass += tissue.lattice().mass(node);
    }
    return Vec3(sum / mass);
  };
  tissue.release({"left", "right"});
  const Vec3 before = center();
  const Vec3 corner = tissue.state().displacement.front();
  double farthest = 0.0;
  for (int step = 0; step < 50; ++step) {
    tissue.wait(0.002);
    ASSERT_LT((center() - before).norm(), 1e-13);
    farthest = std::max(farthest, (tissue.state().displacement.front() - corner).norm());
  }
  EXPECT_GT(farthest, 0.005);  // it swings
}

TEST(Time, DampedSwingEndsInTheEquilibriumAndThenCostsNothing) {
  TissueConfig config = inTime(withFixedBottom(elasticBlockOf(4, 4, 4, 0.45)), 0.05);
  config.gravity = Vec3(0.0, 0.0, -kGravity);
  Tissue still(config, solverOf("newton"));
  still.settle();
  Tissue tissue(config, solverOf("layered"));
  for (int step = 0; step < 300 && (step == 0 || tissue.isMoving()); ++step) tissue.wait(0.02);
  ASSERT_FALSE(tissue.isMoving());
  double deepest = 0.0;
  for (const Vec3& moved : still.state().displacement) deepest = std::max(deepest, moved.norm());
  for (std::size_t node = 0; node < still.state().displacement.size(); ++node) {
    ASSERT_LT((tissue.state().displacement[node] - still.state().displacement[node]).norm(),
              0.01 * deepest);
  }
  const std::vector<Vec3> at_rest = tissue.state().displacement;
  EXPECT_EQ(tissue.wait(10.0).iterations, 0);
  EXPECT_EQ(tissue.state().displacement, at_rest);
}

TEST(Time, CutFreePieceFallsAndTheRestStays) {
  TissueConfig config = inTime(elasticBlockOf(4, 4, 6, 0.3), 0.01);
  config.gravity = Vec3(0.0, 0.0, -kGravity);
  config.fixed.push_back(nodeBox(config, {0, 0, 6}, {4, 4, 6}));
  Tissue tissue(config, solverOf("layered"));
  tissue.settle();
  const double before = tissue.nodePosition(0).z();
  const CutReport cut = tissue.cut({Vec3(-1.0, -1.0, 0.025), Vec3(1.0, -1.0, 0.025),
                                    Vec3(1.0, 1.0, 0.025), Vec3(-1.0, 1.0, 0.025)});
  ASSERT_EQ(cut.pieces, 2);
  EXPECT_NEAR(tissue.nodePosition(0).z(), before, 1e-12);  // a cut takes no time
  tissue.wait(0.1);
  EXPECT_NEAR(before - tissue.nodePosition(0).z(), 0.5 * kGravity * 0.01,
              0.03 * 0.5 * kGravity * 0.01);
  EXPECT_LT(tissue.state().displacement[at(tissue.lattice().node(0, 0, 6))].norm(), 1e-12);
}

TEST(Time, TheSameBitsWithAnyNumberOfThreads) {
  std::vector<std::vector<Vec3>> shapes;
  for (const int threads : {1, 2, 7}) {
    Tissue tissue(bar(0.002, 4), solverOf("layered", threads));
    bendAndRelease(tissue, 0.004);
    tissue.wait(0.05);
    shapes.push_back(tissue.state().displacement);
  }
  EXPECT_EQ(shapes[0], shapes[1]);
  EXPECT_EQ(shapes[0], shapes[2]);
}

TEST(Time, ResetAndSettleEndTheMotion) {
  Tissue tissue(bar(0.002, 2), solverOf("layered"));
  bendAndRelease(tissue, 0.004);
  tissue.wait(0.01);
  EXPECT_TRUE(tissue.isMoving());
  tissue.settle();
  EXPECT_FALSE(tissue.isMoving());
  EXPECT_LT(tissue.state().displacement[at(tipOf(tissue))].norm(), 0.01 * 0.004);
  bendAndRelease(tissue, 0.004);
  tissue.wait(0.01);
  tissue.reset();
  expectAtRest(tissue);
  EXPECT_EQ(tissue.wait(1.0).iterations, 0);
  expectAtRest(tissue);
}

TEST(Time, ForceOfAStepIsItsEnergysNegativeSlope) {
  constexpr double kSpacing = 0.01;
  TissueConfig config = inTime(elasticBlockOf(2, 2, 2, 0.4), 0.01);
  config.gravity = Vec3(1.0, 2.0, -9.81);
  ElasticBlock block(config);
  shake(block.state, 0.2 * kSpacing);
  InertialTerm term;
  term.elastic_scale = 3.0;
  term.per_mass = 2e4;
  term.force.assign(block.state.displacement.size(), Vec3(0.01, -0.02, 0.03));
  block.model.setInertia(&term);
  const std::vector<Vec3> forces = block.model.nodeForces(block.state);
  constexpr double kStep = 1e-5 * kSpacing;
  for (int node = 0; node < block.lattice.nodeCount(); ++node) {
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      LatticeState ahead = block.state, behind = block.state;
      ahead.displacement[at(node)][axis] += kStep;
      behind.displacement[at(node)][axis] -= kStep;
      slope[axis] = (block.model.energy(ahead) - block.model.energy(behind)) / (2.0 * kStep);
      const Vec3 turned =
          (block.model.nodeForce(behind, node) - block.model.nodeForce(ahead, node)) /
          (2.0 * kStep);
      const Vec3 column = block.model.nodeBlock(block.state, node).col(axis);
      EXPECT_LT((turned - column).norm(), 1e-5 * column.norm()) << node;
    }
    EXPECT_LT((forces[at(node)] + slope).norm(), 1e-6 * slope.norm()) << node;
    EXPECT_LT((block.model.nodeForce(block.state, node) - forces[at(node)]).norm(),
              1e-12 * slope.norm());
  }
}

// Nodes that a cut makes have no part in the time step before it.
TEST(Time, WhatHoldsTheTissueIsToldAfterACutAsOfTheTissueAlone) {
  TissueConfig config = bar(0.002, 2);
  config.fixed.assign(1, nodeBox(config, {0, 0, 0}, {20, 0, 2}));
  config.gravity = Vec3(0.0, 0.0, -kGravity);
  Tissue tissue(config, solverOf("layered"));
  tissue.wait(0.01);
  ASSERT_GT(tissue.cut({{0.21, -1, -1}, {0.21, 1, -1}, {0.21, 1, 1}, {0.21, -1, 1}}).springs_cut,
            0);
  const CellSet& cells = *tissue.state().cells;
  bool any_made = false;
  for (int node = tissue.lattice().nodeCount(); node < cells.nodeCount(); ++node) {
    any_made = any_made || isFixed(tissue.lattice(), cells, node);
  }
  ASSERT_TRUE(any_made);
  const Vec3 told = tissue.forceOfFixedNodes();
  tissue.restore(tissue.shape());  // of which no time step is under way
  const double weight = 1000.0 * kGravity * 0.4 * 0.04 * 0.04;
  EXPECT_LT((told - tissue.forceOfFixedNodes()).norm(), 1e-9 * weight);
  EXPECT_GT(told.z(), 0.0);
  EXPECT_LT(told.norm(), 2.0 * weight);
}

TEST(Time, ARefusedLoadLeavesItMoving) {
  Tissue tissue(bar(0.0, 2), solverOf("layered"));
  bendAndRelease(tissue, 0.004);
  tissue.wait(0.01);
  const std::vector<Vec3> there = tissue.state().displacement;
  const PatchConfig far = displacedPatch(
      "end", {Vec3(0.4 - 1e-6, -1.0, -1.0), Vec3(0.4 + 1e-6, 1.0, 1.0)}, Vec3(0.0, 0.0, -0.1));
  EXPECT_THROW(tissue.load(loadOf({far}), {}, 2), InputError);
  EXPECT_TRUE(tissue.isMoving());
  EXPECT_EQ(tissue.state().displacement, there);
  Tissue other(bar(0.0, 2), solverOf("layered"));
  bendAndRelease(other, 0.004);
  other.wait(0.01);
  tissue.wait(0.01);
  other.wait(0.01);
  EXPECT_EQ(tissue.state().displacement, other.state().displacement);
}

}  // namespace
}  // namespace robot_tissue::test_time
