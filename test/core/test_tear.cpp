// Tearing: what is stretched too far severs, the weakest first.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cutting/tear.h"
#include "mesh_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_tear {
namespace {

constexpr double kLength = 0.06, kWidth = 0.04, kThickness = 0.01;

// A strip along x, held at its lower end.
TissueConfig strip(double spacing, double tear_stretch, double tear_length = 0.0) {
  TissueConfig config;
  config.shape.max() = Vec3(kLength, kWidth, kThickness);
  config.spacing = spacing;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = 0.3;
  config.material.tear_stretch = tear_stretch;
  config.material.tear_length = tear_length;
  Box end = config.shape;
  end.max().x() = 0.0;
  config.fixed.push_back(end);
  return config;
}

LoadStep pulled(double way, int increments) {
  Box end;
  end.min() = Vec3(kLength, 0.0, 0.0);
  end.max() = Vec3(kLength, kWidth, kThickness);
  return loadOf({displacedPatch("grip", end, Vec3(way, 0.0, 0.0))}, increments);
}

// From the side, half way through, at the middle of its length.
void notch(Tissue& tissue) {
  const double x = 0.5 * kLength + 0.1 * tissue.lattice().spacing();
  const double y = 0.5 * kWidth;
  tissue.cut({{x, -0.01, -0.01}, {x, y, -0.01}, {x, y, 0.02}, {x, -0.01, 0.02}});
}

struct Pull {
  double greatest_force = 0.0;  // N
  double last_force = 0.0;      // N
  int torn = 0;
  int pieces = 1;
  SolveStatus worst = SolveStatus::kOk;
};

Pull pullOf(const TissueConfig& config, double way, int increments, bool notched) {
  Tissue tissue(config, SolverConfig());
  if (notched) notch(tissue);
  Pull pull;
  tissue.load(pulled(way, increments), [&](int, int, const SolveReport& report) {
    pull.last_force = report.patches.front().force.x();
    pull.greatest_force = std::max(pull.greatest_force, pull.last_force);
    pull.worst = std::max(pull.worst, report.status);
  });
  pull.torn = tissue.springsTorn();
  pull.pieces = tissue.state().pieces;
  return pull;
}

TEST(Tear, NothingTearsBelowTheStretchOrWithoutOne) {
  EXPECT_EQ(pullOf(strip(0.005, 1.5), 0.3 * kLength, 3, false).torn, 0);
  EXPECT_EQ(pullOf(strip(0.005, 0.0), 0.6 * kLength, 6, false).torn, 0);
}

// Where all springs are stretched alike, those of one section go.
TEST(Tear, OneSectionGoesOfAnEvenlyStretchedLattice) {
  const TissueConfig config = strip(0.005, 1.4);
  const Lattice lattice(config);
  LatticeState state = lattice.restState();
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    state.displacement[at(node)].x() = 0.5 * lattice.restPosition(node).x();
  }
  const std::vector<int> weakest = weakestSprings(lattice, state, tearStrains(lattice, config));
  EXPECT_EQ(weakest.size(), 9u * 3u);
  for (const int spring : weakest) {
    EXPECT_EQ(lattice.springs()[at(spring)].axis, 0);
    EXPECT_EQ(lattice.gridIndex(lattice.springs()[at(spring)].a)[0], 0);
  }
}

TEST(Tear, AStripParts) {
  const Pull pull = pullOf(strip(0.005, 1.4), 0.8 * kLength, 8, false);
  EXPECT_EQ(pull.pieces, 2);
  EXPECT_LT(pull.torn, 4 * 9 * 3);
  EXPECT_EQ(pull.worst, SolveStatus::kOk);
}

TEST(Tear, ANotchedStripGoesFromTheNotchOn) {
  Tissue tissue(strip(0.005, 1.3), SolverConfig());
  notch(tissue);
  const LatticeState before = tissue.state();
  tissue.load(pulled(0.25 * kLength, 20));
  EXPECT_EQ(tissue.state().pieces, 2);
  EXPECT_GT(tissue.springsTorn(), 0);
  const Lattice& lattice = tissue.lattice();
  for (std::size_t i = 0; i < lattice.springs().size(); ++i) {
    if (tissue.state().severed[i] == before.severed[i]) continue;
    const Spring torn = lattice.springs()[i];
    EXPECT_EQ(torn.axis, 0);
    EXPECT_EQ(lattice.gridIndex(torn.a)[0], 6);  // in the plane of the notch
  }
}

// The stress at a crack goes with one over the square root of the distance: so does tear_stretch.
TEST(Tear, ForceOfANotchedStripDoesNotHangOnTheSpacing) {
  const double length = 0.005;
  const Pull coarse = pullOf(strip(0.005, 1.15, length), 0.15 * kLength, 30, true);
  const Pull fine = pullOf(strip(0.0025, 1.15, length), 0.15 * kLength, 30, true);
  EXPECT_LT(coarse.last_force, 0.9 * coarse.greatest_force);
  EXPECT_LT(fine.last_force, 0.9 * fine.greatest_force);
  EXPECT_NEAR(fine.greatest_force / coarse.greatest_force, 1.0, 0.1);
}

TEST(Tear, StrainScalesWithTheSpacing) {
  Material material;
  EXPECT_EQ(tearStrain(material, 0.005), 0.0);
  material.tear_stretch = 1.5;
  EXPECT_DOUBLE_EQ(tearStrain(material, 0.001), 0.5);
  material.tear_length = 0.004;
  EXPECT_DOUBLE_EQ(tearStrain(material, 0.004), 0.5);
  EXPECT_DOUBLE_EQ(tearStrain(material, 0.001), 1.0);
}

// A part of the strip that alone tears: the springs that go are at these nodes along x or beyond.
void expectToTearAlone(Region weak, TissueConfig config, int first) {
  weak.material = config.material;
  weak.material.tear_stretch = 1.2;
  config.regions.push_back(weak);
  Tissue tissue(config, SolverConfig());
  tissue.load(pulled(0.5 * kLength, 10));
  EXPECT_EQ(tissue.state().pieces, 2);
  for (std::size_t i = 0; i < tissue.lattice().springs().size(); ++i) {
    if (tissue.state().severed[i] == 0) continue;
    EXPECT_GE(tissue.lattice().gridIndex(tissue.lattice().springs()[i].a)[0], first);
  }
}

TEST(Tear, ARegionTearsByItsOwnMaterial) {
  const TissueConfig config = strip(0.005, 0.0);
  Region weak;
  weak.box = config.shape;
  weak.box.min().x() = 0.04;
  expectToTearAlone(weak, config, 7);
}

// The same by a mesh that holds all of the strip beyond 41 mm, so of its springs those from 40 mm
// on.
TEST(Tear, ARegionByAMeshTearsByItsOwnMaterial) {
  const TissueConfig config = strip(0.005, 0.0);
  Region weak;
  const Vec3 far = config.shape.max() + Vec3::Constant(1.0);
  weak.mesh = std::make_shared<const TriangleMesh>(boxMesh(Vec3(0.041, -1.0, -1.0), far));
  expectToTearAlone(weak, config, 8);
}

TEST(Tear, ResetMendsIt) {
  Tissue tissue(strip(0.005, 1.4), SolverConfig());
  tissue.load(pulled(0.8 * kLength, 8));
  ASSERT_GT(tissue.springsTorn(), 0);
  tissue.reset();
  EXPECT_EQ(tissue.springsTorn(), 0);
  EXPECT_EQ(tissue.state().springs_cut, 0);
  expectAtRest(tissue);
}

TEST(Tear, WithoutTimeTheRestIsLate) {
  Tissue tissue(strip(0.005, 1.2), SolverConfig());
  notch(tissue);
  tissue.setDeadline(Deadline(0.0));
  tissue.load(pulled(0.2 * kLength, 1));
  EXPECT_TRUE(tissue.isLate());
  EXPECT_EQ(tissue.state().pieces, 1);
  tissue.setDeadline(std::nullopt);
  tissue.loadOn();
  tissue.settle();
  EXPECT_EQ(tissue.state().pieces, 2);
  EXPECT_FALSE(tissue.isLate());
}

}  // namespace
}  // namespace robot_tissue::test_tear
