// The law `fung`: derivatives, closed forms, and every method against `newton`.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <memory>
#include <string>

#include "layered_fixtures.h"
#include "material/elastic_law.h"
#include "tissue/registry.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_fung {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kShear = 3448.0, kBulk = 33333.0;  // Pa: 10 kPa, Poisson's ratio 0.45

using Corners = ElasticCell::Corners;
using Column = Eigen::Matrix<double, 3 * kCorners, 1>;

Moduli moduliWith(double stiffening) { return {kShear, kBulk, stiffening}; }

Corners deformedBy(const Eigen::Matrix3d& gradient) {
  Corners displacement;
  for (int c = 0; c < kCorners; ++c) {
    const Vec3 rest = kSpacing * Vec3(c & 1, c >> 1 & 1, c >> 2 & 1);
    displacement[at(c)] = gradient * rest - rest;
  }
  return displacement;
}

Corners shaken(Corners displacement, double size, unsigned seed) {
  Shaker shaker(seed);
  for (Vec3& corner : displacement) corner += shaker.displacement(size);
  return displacement;
}

Column gradientOf(const ElasticCell& cell) {
  Column gradient;
  for (int c = 0; c < kCorners; ++c) gradient.segment<3>(3 * c) = cell.gradient(c);
  return gradient;
}

TEST(FungLaw, IsSmoothAndConvexAlsoWhereItWouldOverflow) {
  constexpr double b = 8.0, last = elastic_law::kMostExponent / b;
  for (const double x : {-0.5, -1e-3, 1e-9, 0.01, 0.5, last - 1e-4, last + 1e-4, 4.0, 1e6}) {
    const double step = 1e-5 * std::max(1e-3, std::abs(x));
    const auto before = elastic_law::stiffeningAt(b, x - step);
    const auto here = elastic_law::stiffeningAt(b, x);
    const auto after = elastic_law::stiffeningAt(b, x + step);
    ASSERT_TRUE(std::isfinite(here.value) && std::isfinite(here.slope));
    EXPECT_NEAR((after.value - before.value) / (2.0 * step), here.slope, 1e-4 * here.slope) << x;
    EXPECT_GE(after.slope, before.slope) << x;
    EXPECT_GE(here.curvature, 0.0) << x;
  }
  for (const double x : {0.0, last}) {  // where one form ends and the next begins
    const auto low = elastic_law::stiffeningAt(b, x - 1e-12);
    const auto high = elastic_law::stiffeningAt(b, x + 1e-12);
    EXPECT_NEAR(low.value, high.value, 1e-9 * (1.0 + high.value));
    EXPECT_NEAR(low.slope, high.slope, 1e-9 * high.slope);
  }
}

struct Strained {
  double height;
  double stiffening;  // 300: beyond kMostExponent
};

// Stretched, mild, squeezed so that the barrier rises, flatter than 0.1, turned inside out.
class FungDerivatives : public testing::TestWithParam<Strained> {
 protected:
  FungDerivatives() {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
    gradient(2, 2) = GetParam().height;
    gradient(0, 2) = 0.2;
    shape_ = shaken(deformedBy(gradient), 0.1 * kSpacing, 7);
  }
  ElasticCell cellAt(const Corners& shape) const {
    return {moduliWith(GetParam().stiffening), kSpacing, shape};
  }
  Corners movedBy(int component, double step) const {
    Corners shape = shape_;
    shape[at(component / 3)][component % 3] += step;
    return shape;
  }

  Corners shape_;
};

TEST_P(FungDerivatives, GradientIsTheEnergysSlope) {
  constexpr double kStep = 1e-5 * kSpacing;
  const Column gradient = gradientOf(cellAt(shape_));
  Column slope;
  for (int i = 0; i < slope.size(); ++i) {
    slope[i] =
        (cellAt(movedBy(i, kStep)).energy() - cellAt(movedBy(i, -kStep)).energy()) / (2.0 * kStep);
  }
  ASSERT_GT(slope.norm(), 1e-3 * kShear * kSpacing * kSpacing);
  EXPECT_LT((gradient - slope).norm(), 1e-6 * slope.norm());
}

TEST_P(FungDerivatives, HessianIsTheGradientsSlope) {
  constexpr double kStep = 1e-6 * kSpacing;
  const CellHessian hessian = cellAt(shape_).hessian();
  for (int column = 0; column < 3 * kCorners; ++column) {
    const Column slope =
        (gradientOf(cellAt(movedBy(column, kStep))) - gradientOf(cellAt(movedBy(column, -kStep)))) /
        (2.0 * kStep);
    ASSERT_GT(slope.norm(), 0.1 * kShear * kSpacing);
    EXPECT_LT((hessian.col(column) - slope).norm(), 1e-6 * slope.norm()) << column;
  }
  for (int c = 0; c < kCorners; ++c) {
    const Eigen::Matrix3d block = hessian.block<3, 3>(3 * c, 3 * c);
    EXPECT_LT((cellAt(shape_).block(c) - block).norm(), 1e-12 * block.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, FungDerivatives,
                         testing::Values(Strained{1.4, 3.0}, Strained{0.9, 1.0},
                                         Strained{0.9, 20.0}, Strained{0.35, 5.0},
                                         Strained{0.07, 0.5}, Strained{-0.3, 1.0},
                                         Strained{0.7, 300.0}));

TEST(FungCell, WithoutStiffeningIsNeoHookeanBitForBit) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Corners shape = shaken(deformedBy(Eigen::Matrix3d::Identity()), 0.6 * kSpacing, seed);
    const ElasticCell fung(moduliWith(0.0), kSpacing, shape);
    const ElasticCell plain({kShear, kBulk}, kSpacing, shape);
    ASSERT_EQ(fung.energy(), plain.energy());
    ASSERT_EQ(gradientOf(fung), gradientOf(plain));
    ASSERT_EQ(fung.hessian(), plain.hessian());
  }
}

TEST(FungCell, AtSmallStrainIsNeoHookean) {
  const Corners rest = deformedBy(Eigen::Matrix3d::Identity());
  const CellHessian stiff = ElasticCell(moduliWith(50.0), kSpacing, rest).hessian();
  const CellHessian plain = ElasticCell(moduliWith(0.0), kSpacing, rest).hessian();
  EXPECT_LT((stiff - plain).norm(), 1e-12 * plain.norm());
  const Corners near = shaken(rest, 1e-4 * kSpacing, 3);
  const double energy = ElasticCell(moduliWith(0.0), kSpacing, near).energy();
  EXPECT_NEAR(ElasticCell(moduliWith(50.0), kSpacing, near).energy(), energy, 1e-5 * energy);
}

// Methods that relax a node at a time lower the energy, as with the neo-Hookean law.
TEST(FungCell, BlockIsPositiveDefiniteInAnyShapeThatIsNotFlat) {
  double softest = std::numeric_limits<double>::max();
  int distorted = 0;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    const Corners shape = shaken(deformedBy(Eigen::Matrix3d::Identity()), 1.2 * kSpacing, seed);
    Eigen::Matrix3d mean = Eigen::Matrix3d::Identity();
    for (int c = 0; c < kCorners; ++c) {
      for (int axis = 0; axis < 3; ++axis) {
        mean.col(axis) += ((c >> axis & 1) != 0 ? 0.25 : -0.25) / kSpacing * shape[at(c)];
      }
    }
    if (mean.determinant() < 0.1) continue;
    ++distorted;
    const ElasticCell cell(moduliWith(4.0), kSpacing, shape);
    for (int c = 0; c < kCorners; ++c) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(cell.block(c));
      softest = std::min(softest, solver.eigenvalues().minCoeff());
    }
  }
  ASSERT_GT(distorted, 500);
  EXPECT_GT(softest, 1e-3 * kShear * kSpacing);
}

TissueConfig fung(TissueConfig config, double stiffening) {
  config.material.law = Material::Law::kFung;
  config.material.stiffening = stiffening;
  return config;
}

// Energy per volume of a bar that is stretched along x and as wide as w across (Pa).
double barEnergy(const Moduli& moduli, double stretch, double w) {
  const double j = stretch * w * w;
  const double x = std::pow(j, -2.0 / 3.0) * (stretch * stretch + 2.0 * w * w) - 3.0;
  return moduli.shear / (2.0 * moduli.stiffening) * std::expm1(moduli.stiffening * x) +
         0.5 * moduli.bulk * (j - 1.0) * (j - 1.0);
}

// Force of the bar over its section at rest: nothing pulls across, so the width makes the energy
// least (golden section).
double barStress(const Moduli& moduli, double stretch) {
  const auto least = [&](double along) {
    double low = 0.5, high = 1.5;
    const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
    for (int i = 0; i < 100; ++i) {
      const double a = high - ratio * (high - low), b = low + ratio * (high - low);
      (barEnergy(moduli, along, a) < barEnergy(moduli, along, b) ? high : low) =
          barEnergy(moduli, along, a) < barEnergy(moduli, along, b) ? b : a;
    }
    return barEnergy(moduli, along, 0.5 * (low + high));
  };
  constexpr double kStep = 1e-4;
  return (least(stretch + kStep) - least(stretch - kStep)) / (2.0 * kStep);
}

// Between plates that it slides along.
class FungBar : public testing::TestWithParam<std::string> {};

TEST_P(FungBar, PullsAsTheClosedForm) {
  const TissueConfig config = fung(elasticBlockOf(4, 3, 3, 0.45), 6.0);
  SolverConfig solver;
  solver.method = GetParam();
  solver.tolerance = 1e-3;
  const Moduli moduli = moduliOf(config.material);
  for (const double stretch : {0.7, 0.85, 1.1, 1.3, 1.5}) {
    Tissue tissue(config, solver);
    PatchConfig left = displacedPatch("left", nodeBox(config, {0, 0, 0}, {0, 3, 3}), Vec3::Zero());
    PatchConfig right = displacedPatch("right", nodeBox(config, {4, 0, 0}, {4, 3, 3}),
                                       Vec3(0.04 * (stretch - 1.0), 0.0, 0.0));
    for (PatchConfig* plate : {&left, &right}) {
      plate->displacement->at(1).reset();
      plate->displacement->at(2).reset();
    }
    // One corner line stays where it is, so that the bar does not slide away.
    const std::vector<SolveReport> reports = reportsOf(tissue, loadOf({left, right}));
    ASSERT_EQ(reports.back().status, SolveStatus::kOk) << stretch;
    const double stress = reports.back().patches[1].force.x() / (0.03 * 0.03);
    EXPECT_NEAR(stress, barStress(moduli, stretch), 0.01 * std::abs(stress)) << stretch;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, FungBar, testing::Values("newton", "layered"));

// All of its outside is sheared by u = gamma z; the forces' work is that of the stress
// mu gamma exp(b gamma^2) on the volume.
TEST(FungBlock, ShearsAsTheClosedForm) {
  const TissueConfig config = fung(elasticBlockOf(4, 3, 3, 0.45), 6.0);
  for (const double gamma : {0.05, 0.2, 0.5}) {
    ElasticBlock block(config);
    LoadingPatch outside = displaced({}, Vec3::Zero());
    for (const int node : nodesOf(block.lattice)) {
      const auto place = block.lattice.gridIndex(node);
      const bool inside = place[0] % 4 != 0 && place[1] % 3 != 0 && place[2] % 3 != 0;
      if (inside) continue;
      outside.nodes.push_back(node);
      outside.displacement.emplace_back(gamma * block.lattice.restPosition(node).z(), 0.0, 0.0);
    }
    ASSERT_EQ(block.solve({outside}).status, SolveStatus::kOk);
    double work = 0.0;
    const std::vector<Vec3> forces = block.model.nodeForces(block.state);
    for (const int node : outside.nodes) {
      work -= forces[at(node)].x() * block.lattice.restPosition(node).z();
    }
    const double volume = 0.04 * 0.03 * 0.03;
    const double shear = moduliOf(config.material).shear;
    const double expected = volume * shear * gamma * std::exp(6.0 * gamma * gamma);
    EXPECT_NEAR(work, expected, 1e-6 * expected) << gamma;
  }
}

// A method's shapes and forces on patches are those of `newton`.
struct FungPress {
  std::string method;
  double stiffening;
  double tolerance;
};

class FungPresses : public testing::TestWithParam<FungPress> {
 protected:
  void expectSame(const TissueConfig& config, double depth, int increments) {
    ElasticBlock exact(config);
    SolverConfig solver;
    solver.method = GetParam().method;
    solver.tolerance = GetParam().tolerance;
    const auto method = makeMethod(solver, exact.lattice, exact.model);
    LatticeState state = exact.lattice.restState();
    for (int i = 1; i <= increments; ++i) {
      const Vec3 way(0.0, 0.0, -depth * i / increments);
      std::vector<LoadingPatch> patches = {
          punchOn(exact.lattice, exact.model, exact.state, config, way)};
      const std::vector<LoadingPatch> loads = patches;
      const SolveReport report = method->solve(patches, nodesOf(exact.lattice), state);
      const SolveReport right = exact.solve(loads);
      ASSERT_EQ(right.status, SolveStatus::kOk);
      EXPECT_EQ(report.status, SolveStatus::kOk) << i;
      EXPECT_LE(errorOf(exact.lattice, loads, state.displacement, exact.state.displacement),
                2.0 * solver.tolerance);
      const Vec3 force = right.patches[0].force;
      EXPECT_LT((report.patches[0].force - force).norm(), 10.0 * solver.tolerance * force.norm());
    }
  }
};

TEST_P(FungPresses, ByThirtyPercentOfTheHeight) {
  expectSame(fung(pressBlock(0.45), GetParam().stiffening), 0.012, 3);
}

TEST_P(FungPresses, WithARegionOfTheOtherLaw) {
  TissueConfig config = pressBlock(0.4);
  Region region;
  region.name = "scar";
  region.box = nodeBox(config, {3, 2, 1}, {7, 6, 3});
  region.material = fung(config, GetParam().stiffening).material;
  region.material.young_modulus *= 3.0;
  config.regions.push_back(region);
  expectSame(config, 0.008, 2);
}

INSTANTIATE_TEST_SUITE_P(Methods, FungPresses,
                         testing::Values(FungPress{"layered", 2.0, 1e-3},
                                         FungPress{"layered", 15.0, 1e-2},
                                         FungPress{"vbd", 2.0, 1e-3}, FungPress{"vbd", 15.0, 1e-2},
                                         FungPress{"xpbd", 2.0, 1e-2},
                                         FungPress{"explicit", 2.0, 1e-3},
                                         FungPress{"explicit", 15.0, 1e-2}));

SolverConfig solverOf(const std::string& method, int threads) {
  SolverConfig solver;
  solver.method = method;
  solver.threads = threads;
  return solver;
}

void press(const TissueConfig& config, Tissue& tissue) {
  const Vec3 high = config.shape.max();
  const Box top{Vec3(0.4 * high.x(), 0.4 * high.y(), high.z()),
                Vec3(0.6 * high.x(), 0.6 * high.y(), high.z())};
  tissue.load(loadOf({displacedPatch("punch", top, Vec3(0.0, 0.0, -0.3 * high.z()))}, 4));
}

// Large enough for the threads to share it.
TEST(FungThreads, AnyNumberGivesTheSameBits) {
  const TissueConfig config = fung(withFixedBottom(elasticBlockOf(24, 24, 14, 0.45)), 4.0);
  Tissue one(config, solverOf("layered", 1)), two(config, solverOf("layered", 2));
  press(config, one);
  press(config, two);
  ASSERT_TRUE(isDeformed(one));
  EXPECT_EQ(one.state().displacement, two.state().displacement);
}

class FungOverflow : public testing::TestWithParam<std::string> {};

// Told, and no number that is none; what follows is solved again.
TEST_P(FungOverflow, IsToldAndStaysFinite) {
  const TissueConfig config = fung(withFixedBottom(elasticBlockOf(10, 10, 6, 0.45)), 1000.0);
  Tissue tissue(config, solverOf(GetParam(), 1));
  press(config, tissue);
  EXPECT_GT(tissue.cellsBeyondLaw(), 0);
  for (const Vec3& moved : tissue.state().displacement) ASSERT_TRUE(moved.allFinite());
  for (const PatchAnswer& answer : tissue.lastReport().patches) {
    EXPECT_TRUE(answer.force.allFinite());
  }
  tissue.release({"punch"});
  EXPECT_EQ(tissue.cellsBeyondLaw(), 0);
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
}

INSTANTIATE_TEST_SUITE_P(Methods, FungOverflow,
                         testing::Values("newton", "layered", "vbd", "xpbd", "explicit"));

TEST(FungOverflow, OtherLawsHaveNone) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(10, 10, 6, 0.45));
  Tissue tissue(config, solverOf("layered", 1));
  press(config, tissue);
  EXPECT_EQ(tissue.cellsBeyondLaw(), 0);
}

}  // namespace
}  // namespace robot_tissue::test_fung
