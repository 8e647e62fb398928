// Point loads on the lattice, and what a ball's contact is recessed by that is narrower than that
// tells apart.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "loads/narrow_contact.h"
#include "loads/point_loads.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_narrow_contact {
namespace {

constexpr double kSpacing = 0.005;    // m
constexpr double kPoisson = 0.4;      // between two of the table
constexpr double kShear = 1e4 / 2.8;  // Pa, of 1e4 Pa
constexpr int kCells = 24, kMiddle = kCells / 2;

TissueConfig cube() {
  TissueConfig config;
  config.model = "elastic";
  config.shape.max() = kSpacing * Vec3(kCells, kCells, kMiddle);
  config.spacing = kSpacing;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = kPoisson;
  Box bottom = config.shape;
  bottom.max().z() = 0.0;
  config.fixed.push_back(bottom);
  return config;
}

SolverConfig exact() {
  SolverConfig solver;
  solver.tolerance = 1e-5;
  return solver;
}

Vec3 topAt(double i, double j) { return kSpacing * Vec3(kMiddle + i, kMiddle + j, kMiddle); }

// Nodes near to each other go by differences that no ground takes part in.
TEST(PointLoads, NodesNearAForceGoAsTheTableHasIt) {
  Tissue tissue(cube(), exact());
  PatchConfig patch;
  patch.name = "point";
  const Vec3 place = topAt(0, 0), reach = Vec3::Constant(1e-4);
  patch.box = {place - reach, place + reach};
  patch.displacement = {0.0, 0.0, -1e-5};
  LoadStep step;
  step.increments = 1;
  step.patches.push_back(patch);
  tissue.load(step);
  const double force = std::abs(tissue.lastReport().patches.front().force.z());
  const auto wayOf = [&](int i, int j) {
    const int node = tissue.lattice().node(kMiddle + i, kMiddle + j, kMiddle);
    return -tissue.state().displacement[at(node)].z() * kShear * kSpacing / force;
  };
  const double of_force = pointCompliance(kPoisson, 0.0);
  for (const auto& [i, j] :
       std::vector<std::array<int, 2>>{{1, 0}, {1, 1}, {2, 0}, {2, 1}, {3, 0}}) {
    const double told = of_force - pointCompliance(kPoisson, i * i + j * j);
    EXPECT_NEAR(wayOf(0, 0) - wayOf(i, j), told, 0.01 * told) << i << ", " << j;
  }
}

TEST(PointLoads, FarOffTheyAreAHalfSpaces) {
  for (const double ratio : {0.25, 0.4, 0.49}) {
    EXPECT_DOUBLE_EQ(pointCompliance(ratio, 16.0), (1.0 - ratio) / (8.0 * M_PI));
    EXPECT_NEAR(pointCompliance(ratio, 9.0), (1.0 - ratio) / (6.0 * M_PI), 0.012);
  }
}

// A force on one node: what is missing to a half-space's dent is the recess.
TEST(NarrowContact, WithItsRecessABallIsAsDeepAsInAHalfSpace) {
  const Lattice lattice(cube());
  const SurfaceModuli moduli{kShear, kPoisson};
  BallPress press;
  press.radius = 0.02;
  press.force = 0.005;
  press.shares = {{lattice.node(kMiddle, kMiddle, kMiddle), 1.0}};
  const double plane_modulus = 2.0 * kShear / (1.0 - kPoisson);
  const double contact = std::cbrt(0.75 * press.force * press.radius / plane_modulus);
  const double of_lattice = press.force * pointCompliance(kPoisson, 0.0) / (kShear * kSpacing);
  const double depth = contact * contact / press.radius;
  const Recess alone = recessUnder(press, lattice, moduli);
  EXPECT_NEAR(alone.depth + of_lattice, depth, 1e-12);
  press.height = 1e-4;
  EXPECT_NEAR(recessUnder(press, lattice, moduli).depth, alone.depth - 1e-4, 1e-12);
  press.height = 0.0;
  press.force = 0.0;
  press.depth = depth;
  EXPECT_NEAR(recessUnder(press, lattice, moduli).depth, alone.depth, 1e-12) << "by its depth";
}

TEST(NarrowContact, WideOnesHaveNone) {
  const Lattice lattice(cube());
  BallPress press;
  press.radius = 0.02;
  press.shares = {{lattice.node(kMiddle, kMiddle, kMiddle), 1.0}};
  const double plane_modulus = 2.0 * kShear / (1.0 - kPoisson);
  double last = 0.0;
  for (const double width : {1.2, 1.3, 1.4, 1.499}) {
    press.force = 4.0 / 3.0 * plane_modulus * std::pow(width * kSpacing, 3) / press.radius;
    const double depth = recessUnder(press, lattice, {kShear, kPoisson}).depth;
    EXPECT_LT(depth, 0.0) << "one node alone goes deeper than a half-space";
    if (width > 1.3) {
      EXPECT_GT(depth, last) << "it fades out";
    }
    last = depth;
  }
  press.force *= 1.01;
  EXPECT_EQ(recessUnder(press, lattice, {kShear, kPoisson}).depth, 0.0);
}

TEST(NarrowContact, BallsThinnerThanASpacingHaveNone) {
  const Lattice lattice(cube());
  BallPress press;
  press.depth = 1e-4;
  press.shares = {{lattice.node(kMiddle, kMiddle, kMiddle), 1.0}};
  press.radius = 0.51 * kSpacing;
  EXPECT_NE(recessUnder(press, lattice, {kShear, kPoisson}).depth, 0.0);
  press.radius = 0.49 * kSpacing;
  EXPECT_EQ(recessUnder(press, lattice, {kShear, kPoisson}).depth, 0.0);
}

TEST(NarrowContact, ATissueTellsItOfItsFlatSurfaceAlone) {
  Tissue tissue(cube(), exact());
  const auto under = [&](int i, int j, int k) {
    BallPress press;
    press.radius = 0.02;
    press.force = 0.005;
    press.shares = {{tissue.lattice().node(i, j, k), 1.0}};
    return tissue.recessUnder(press);
  };
  EXPECT_TRUE(under(kMiddle, kMiddle, kMiddle));
  EXPECT_TRUE(under(0, kMiddle, kMiddle / 2)) << "a side";
  EXPECT_FALSE(under(0, kMiddle, kMiddle)) << "an edge";
  EXPECT_FALSE(under(kMiddle, kMiddle, 3)) << "inside";
  const double x = topAt(0.5, 0.0).x(), low = topAt(0, 0).z() - 2.2 * kSpacing;
  EXPECT_GT(tissue.cut({{x, -1.0, low}, {x, 1.0, low}, {x, 1.0, 1.0}, {x, -1.0, 1.0}}).springs_cut,
            0);
  EXPECT_FALSE(under(kMiddle, kMiddle, kMiddle)) << "beside a cut";
  EXPECT_TRUE(under(kMiddle - 1, kMiddle, kMiddle));
}

}  // namespace
}  // namespace robot_tissue::test_narrow_contact
