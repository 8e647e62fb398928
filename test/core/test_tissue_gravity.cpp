// Tissue under its own weight: a column is a bar with a known answer. Six springs a node do not
// resist shear, so a soft standing column topples; a stiff one stands, and a soft one may hang.
#include <gtest/gtest.h>

#include <cmath>

#include "tissue_fixtures.h"

namespace robot_tissue::test_tissue_gravity {
namespace {

constexpr int kCells = 10;
constexpr double kGravity = 9.81;  // m/s^2

TissueConfig standingColumn(double young_modulus = 1e7) {
  TissueConfig config = withFixedBottom(blockOf(1, 1, kCells));
  config.material.young_modulus = young_modulus;
  config.gravity = Vec3(0.0, 0.0, -kGravity);
  return config;
}

TissueConfig hangingColumn() {
  TissueConfig config = blockOf(1, 1, kCells);
  config.fixed.push_back(nodeBox(config, {0, 0, kCells}, {1, 1, kCells}));
  config.gravity = Vec3(0.0, 0.0, -kGravity);
  return config;
}

double length(const TissueConfig& config) { return config.shape.max().z(); }

// rho g L^2 / (2 E) (m)
double topSinks(const TissueConfig& config) {
  return config.material.density * kGravity * std::pow(length(config), 2) /
         (2.0 * config.material.young_modulus);
}

double weight(const TissueConfig& config) {
  return config.material.density * kGravity * config.shape.max().prod();  // N
}

Vec3 reaction(const Tissue& tissue) {  // of the fixed nodes on the tissue (N)
  Vec3 force = Vec3::Zero();
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    if (tissue.lattice().isFixed(node)) force -= tissue.nodeForce(node);
  }
  return force;
}

TEST(Gravity, TopOfAColumnSinksByTheAnalyticLengthWithinTheTolerance) {
  const TissueConfig config = standingColumn();
  SolverConfig solver = paperSolver();
  solver.tolerance = 0.01;
  Tissue tissue(config, solver);
  const SolveReport report = tissue.settle();
  EXPECT_EQ(report.status, SolveStatus::kOk);
  for (int corner = 0; corner < 4; ++corner) {
    const int node = tissue.lattice().node(corner & 1, corner >> 1, kCells);
    const Vec3& moved = tissue.state().displacement[at(node)];
    // Each node may miss 1 % of its weight; the top one weighs half as much.
    EXPECT_NEAR(moved.z(), -topSinks(config), 0.012 * topSinks(config));
    EXPECT_LT(moved.head<2>().norm(), 1e-3 * topSinks(config));
  }
}

TEST(Gravity, SettledOnTheProfileIsTheAnalyticParabola) {
  const TissueConfig config = standingColumn();
  SolverConfig solver = paperSolver();
  solver.tolerance = 1e-3;
  Tissue tissue(config, solver);
  for (int i = 0; i < 4; ++i) tissue.settle();
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    const double z = tissue.lattice().restPosition(node).z(), L = length(config);
    const double expected = -topSinks(config) * (2.0 * z / L - z * z / (L * L));
    EXPECT_NEAR(tissue.state().displacement[at(node)].z(), expected, 2e-3 * topSinks(config));
  }
}

TEST(Gravity, GroundCarriesTheWeight) {
  const TissueConfig config = standingColumn();
  Tissue tissue(config, paperSolver());
  tissue.settle();
  EXPECT_NEAR(reaction(tissue).z(), weight(config), 0.01 * weight(config));
  EXPECT_LT(reaction(tissue).head<2>().norm(), 0.01 * weight(config));
}

TEST(Gravity, SoftHangingColumnGetsLongerByAsMuch) {
  const TissueConfig config = hangingColumn();  // by 5 % of its length
  Tissue tissue(config, paperSolver());
  ASSERT_EQ(tissue.settle().status, SolveStatus::kOk);
  for (const int node : tissue.lattice().nodesIn(nodeBox(config, {0, 0, 0}, {1, 1, 0}))) {
    const Vec3& moved = tissue.state().displacement[at(node)];
    EXPECT_NEAR(moved.z(), -topSinks(config), 0.012 * topSinks(config));
  }
  EXPECT_NEAR(reaction(tissue).z(), weight(config), 0.01 * weight(config));
}

TEST(Gravity, SoftStandingColumnTopplesAndIsNotCalledOk) {
  Tissue tissue(standingColumn(1e4), paperSolver());
  const SolveReport report = tissue.settle();
  EXPECT_NE(report.status, SolveStatus::kOk);
  for (const Vec3& moved : tissue.state().displacement) EXPECT_TRUE(moved.allFinite());
}

TEST(Gravity, ReleasedColumnSettlesToItsWeightAgain) {
  const TissueConfig config = standingColumn();
  Tissue tissue(config, paperSolver());
  tissue.settle();
  const std::vector<Vec3> settled = tissue.state().displacement;
  const std::vector<Vec3> vertices = tissue.vertices();
  tissue.load(loadOf({displacedPatch("top", nodeBox(config, {0, 0, kCells}, {1, 1, kCells}),
                                     Vec3(0.0, 0.0, 2e-5))}));
  ASSERT_NE(tissue.state().displacement, settled);
  const SolveReport report = tissue.release({"top"});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_EQ(tissue.state().displacement, settled);
  EXPECT_EQ(tissue.vertices(), vertices);
}

TEST(Gravity, WithoutItSettlingChangesNothing) {
  Tissue tissue(withFixedBottom(blockOf(3, 3, 3)), paperSolver());
  const SolveReport report = tissue.settle();
  EXPECT_EQ(report.status, SolveStatus::kOk);
  expectAtRest(tissue);
}

TEST(Gravity, SurfaceSinksWithTheColumn) {
  const TissueConfig config = standingColumn();
  Tissue tissue(config, paperSolver());
  const SolveReport report = tissue.settle();
  // The mean depth is the top's: volume ratio = 1 - sink / length.
  EXPECT_NEAR(report.volume_ratio, 1.0 - topSinks(config) / length(config),
              0.02 * topSinks(config) / length(config));
}

// Each balance begins nearer to the last one's end, down to rounding.
TEST(Gravity, SettlingAgainAndAgainCostsNothing) {
  TissueConfig config = withFixedBottom(blockOf(8, 6, 4, 0.01));
  config.model = "elastic";
  config.material.poisson_ratio = 0.3;
  config.gravity = Vec3(0.0, 0.0, -kGravity);
  Tissue tissue(config, {});
  ASSERT_EQ(tissue.settle().status, SolveStatus::kOk);
  for (int again = 0; again < 12; ++again) {
    const SolveReport report = tissue.settle();
    EXPECT_EQ(report.status, SolveStatus::kOk) << again;
    EXPECT_LE(report.iterations, 3) << again;
  }
}

}  // namespace
}  // namespace robot_tissue::test_tissue_gravity
