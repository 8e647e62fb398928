// The methods that `layered` is compared with, against method `newton`.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "layered_fixtures.h"
#include "tissue/registry.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_baselines {
namespace {

constexpr double kHonest = 2.0;  // times the tolerance is what the true error may be

// `xpbd` does not reach 1e-3.
SolverConfig solverOf(const std::string& method) {
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = method == "xpbd" ? 1e-2 : 1e-3;
  return solver;
}

// An elastic block with a baseline on it, next to the exact one.
struct Pair {
  Pair(const TissueConfig& tissue, const SolverConfig& solver)
      : config(tissue),
        tolerance(solver.tolerance),
        exact(tissue),
        method(makeMethod(solver, exact.lattice, exact.model)),
        state(exact.lattice.restState()) {}

  // Solves both, and expects the same shape and forces on patches.
  void expectSame(const std::vector<LoadingPatch>& loads) {
    patches = loads;
    const SolveReport report = method->solve(patches, nodesOf(exact.lattice), state);
    std::vector<LoadingPatch> exact_patches = loads;
    const SolveReport right = exact.method.solve(exact_patches, {}, exact.state);
    ASSERT_EQ(right.status, SolveStatus::kOk);
    EXPECT_EQ(report.status, SolveStatus::kOk);
    EXPECT_LE(report.error_estimate, tolerance);
    EXPECT_LE(error(), kHonest * tolerance);
    for (std::size_t patch = 0; patch < loads.size(); ++patch) {
      const Vec3 force = right.patches[patch].force;
      EXPECT_LT((report.patches[patch].force - force).norm(), 10.0 * tolerance * force.norm());
      EXPECT_LT(
          (patches[patch].place.displacement - exact_patches[patch].place.displacement).norm(),
          0.01 * exact_patches[patch].place.displacement.norm() + 1e-12);
    }
  }
  double error() const {
    return errorOf(exact.lattice, patches, state.displacement, exact.state.displacement);
  }
  LoadingPatch punch(const Vec3& displacement) const {
    return punchOn(exact.lattice, exact.model, exact.state, config, displacement);
  }

  TissueConfig config;
  double tolerance;
  ElasticBlock exact;
  std::unique_ptr<SolverMethod> method;
  LatticeState state;
  std::vector<LoadingPatch> patches;
};

class Baseline : public testing::TestWithParam<std::string> {
 protected:
  SolverConfig solver() const { return solverOf(GetParam()); }
  Tissue tissue(const TissueConfig& config) const { return Tissue(config, solver()); }
};

TEST_P(Baseline, PressAndDragAgreeWithNewton) {
  for (const double poisson_ratio : {0.25, 0.45}) {
    Pair pair(pressBlock(poisson_ratio), solver());
    for (const Vec3& place :
         {Vec3(0, 0, -0.004), Vec3(0, 0, -0.008), Vec3(0.003, 0, -0.008), Vec3(0.001, 0, -0.002)}) {
      pair.expectSame({pair.punch(place)});
    }
  }
}

// Half of the block's height: corners of cells are squeezed below 0.3 of their volume.
TEST_P(Baseline, DeepPressAgreesWithNewton) {
  Pair pair(pressBlock(0.3), solver());
  for (const double depth : {0.005, 0.01, 0.015, 0.02}) {
    pair.expectSame({pair.punch(Vec3(0, 0, -depth))});
  }
}

TEST_P(Baseline, PatchByForceFindsWhereItBalances) {
  for (const bool turns : {false, true}) {
    const TissueConfig config = pressBlock(0.45);
    Pair pair(config, solver());
    LoadingPatch punch = punchByForce(LayeredBlock(config), config, Vec3(0.2, 0, -0.3), turns);
    pair.expectSame({punch});
    EXPECT_EQ(turns, Eigen::AngleAxisd(pair.patches[0].place.rotation).angle() > 1e-3);
  }
}

TEST_P(Baseline, PlateSlidesAlongItsFreeAxes) {
  const TissueConfig config = pressBlock(0.45);
  Pair pair(config, solver());
  LoadingPatch plate = displaced(pair.exact.lattice.nodesIn(nodeBox(config, {0, 0, 4}, {8, 8, 4})),
                                 Vec3(0.0, 0.0, -0.004));
  plate.free_axis = {{true, true, false}};
  pair.expectSame({plate});
  for (const int node : plate.nodes) EXPECT_EQ(pair.state.displacement[at(node)].z(), -0.004);
}

TEST_P(Baseline, RegionTenTimesStiffer) {
  TissueConfig config = pressBlock(0.45);
  Region region;
  region.name = "tumour";
  region.box = nodeBox(config, {4, 2, 1}, {6, 6, 3});
  region.material = config.material;
  region.material.young_modulus *= 10.0;
  config.regions.push_back(region);
  Pair pair(config, solver());
  pair.expectSame({pair.punch(Vec3(0.002, 0, -0.004))});
}

TEST_P(Baseline, SagsUnderItsWeight) {
  TissueConfig config = pressBlock(0.45);
  config.gravity = Vec3(0.0, 2.0, -9.81);
  Pair pair(config, solver());
  pair.expectSame({});
}

TEST_P(Baseline, SpringsInContactPushAndDrag) {
  const TissueConfig config = pressBlock(0.45);
  Pair pair(config, solver());
  LoadingPatch plane;
  plane.name = "plane";
  const Lattice& lattice = pair.exact.lattice;
  std::vector<ContactSpring> springs;
  for (int i = 2; i <= 5; ++i) {
    ContactSpring spring;
    const int node = lattice.node(i, 4, 4), next = lattice.node(i + 1, 4, 4);
    spring.carriers = {{node, 0.7}, {next, 0.3}};
    spring.rest = 0.7 * lattice.restPosition(node) + 0.3 * lattice.restPosition(next);
    spring.normal = -Vec3::UnitZ();
    spring.plane_point = spring.rest + 0.002 * spring.normal;
    spring.anchor = spring.rest + Vec3(1e-3, 0.0, 0.0);
    spring.stiffness = 10.0 * pair.exact.model.nodeStiffness(pair.state, node).mean();
    spring.friction_stiffness = spring.stiffness;
    spring.friction_bound = 0.02;
    springs.push_back(spring);
  }
  plane.contacts = springs;
  pair.expectSame({plane});
  EXPECT_LT(pair.state.displacement[at(lattice.node(4, 4, 4))].z(), -0.001);
}

TEST_P(Baseline, CutTissueAgreesWithNewton) {
  const TissueConfig config = pressBlock(0.45);
  Tissue cut = tissue(config), exact(config, solverOf("newton"));
  for (Tissue* each : {&cut, &exact}) {
    reportsOf(*each, loadOf({displacedPatch("punch", nodeBox(config, {5, 3, 4}, {7, 5, 4}),
                                            Vec3(0.003, 0.0, -0.006))}));
    const CutReport report = each->cut(
        {Vec3(0.035, -1, 0.015), Vec3(0.035, 1, 0.015), Vec3(0.035, 1, 0.1), Vec3(0.035, -1, 0.1)});
    ASSERT_GT(report.springs_cut, 0);
    EXPECT_EQ(report.solve.status, SolveStatus::kOk);
  }
  EXPECT_LT(
      errorOf(cut.lattice(), cut.patches(), cut.state().displacement, exact.state().displacement),
      kHonest * solver().tolerance);
}

TEST_P(Baseline, ReleasedTissueIsAtRest) {
  const TissueConfig config = pressBlock(0.45);
  Tissue pressed = tissue(config);
  reportsOf(pressed, loadOf({displacedPatch("punch", nodeBox(config, {3, 3, 4}, {5, 5, 4}),
                                            Vec3(0.0, 0.0, -0.01))}));
  ASSERT_TRUE(isDeformed(pressed));
  EXPECT_EQ(pressed.release({"punch"}).status, SolveStatus::kOk);
  expectAtRest(pressed);
}

TEST_P(Baseline, GoesBackToRestByItself) {
  Pair pair(pressBlock(0.45), solver());
  pair.expectSame({pair.punch(Vec3(0, 0, -0.008))});
  const double deepest = greatestForce(pair.state.displacement);
  std::vector<LoadingPatch> none;
  for (int solve = 0; solve < 3; ++solve) pair.method->solve(none, {}, pair.state);
  EXPECT_LT(greatestForce(pair.state.displacement), 1e-2 * deepest);
}

TEST_P(Baseline, RestStaysAtRest) {
  Pair pair(pressBlock(0.49), solver());
  std::vector<LoadingPatch> none;
  const SolveReport report = pair.method->solve(none, {}, pair.state);
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_EQ(report.iterations, 0);
  for (const Vec3& moved : pair.state.displacement) EXPECT_EQ(moved, Vec3(Vec3::Zero()));
}

TEST_P(Baseline, SolveInBalanceIsOneCheck) {
  Pair pair(pressBlock(0.45), solver());
  pair.expectSame({pair.punch(Vec3(0, 0, -0.004))});
  const std::vector<Vec3> before = pair.state.displacement;
  const SolveReport again = pair.method->solve(pair.patches, {}, pair.state);
  EXPECT_EQ(again.status, SolveStatus::kOk);
  EXPECT_EQ(again.iterations, 0);
  EXPECT_EQ(pair.state.displacement, before);
}

TEST_P(Baseline, TwoRunsAreEqualBitForBit) {
  Pair first(pressBlock(0.45), solver()), second(pressBlock(0.45), solver());
  for (const double depth : {0.003, 0.006, 0.002}) {
    for (Pair* pair : {&first, &second}) {
      pair->patches = {pair->punch(Vec3(0.0005, 0, -depth))};
      pair->method->solve(pair->patches, {}, pair->state);
    }
    ASSERT_EQ(first.state.displacement, second.state.displacement);
  }
}

TEST_P(Baseline, BudgetThatIsTooShortIsLateAndIsCarriedOn) {
  SolverConfig hurried = solver();
  hurried.max_ms = 1e-6;
  Pair pair(pressBlock(0.45), hurried);
  pair.patches = {pair.punch(Vec3(0, 0, -0.004))};
  SolveReport report = pair.method->solve(pair.patches, {}, pair.state);
  ASSERT_EQ(report.status, SolveStatus::kLate);
  EXPECT_GT(report.error_estimate, hurried.tolerance);
  EXPECT_EQ(report.iterations, 1);
  for (const Vec3& moved : pair.state.displacement) ASSERT_TRUE(moved.allFinite());
  for (int solve = 0; solve < 2000; ++solve) {
    pair.method->solve(pair.patches, {}, pair.state);
  }
  ASSERT_EQ(pair.exact.solve(pair.patches).status, SolveStatus::kOk);
  EXPECT_LT(pair.error(), 0.05);
}

TEST_P(Baseline, TakesNoMoreIterationsThanItMay) {
  Pair pair(pressBlock(0.45), solver());
  pair.patches = {pair.punch(Vec3(0, 0, -0.004))};
  pair.method->limitIterations(7);
  const SolveReport report = pair.method->solve(pair.patches, {}, pair.state);
  EXPECT_EQ(report.status, SolveStatus::kUnconverged);
  EXPECT_EQ(report.iterations, 7);
}

TEST_P(Baseline, FloatingTissueUnderAForceHasNoEquilibrium) {
  const TissueConfig config = elasticBlockOf(3, 3, 3, 0.45);
  Pair pair(config, solver());
  pair.patches = {
      forced(pair.exact.lattice.nodesIn(nodeBox(config, {1, 1, 3}, {2, 2, 3})), Vec3(0, 0, -0.1))};
  const SolveReport report = pair.method->solve(pair.patches, {}, pair.state);
  EXPECT_NE(report.status, SolveStatus::kOk);
  for (const Vec3& moved : pair.state.displacement) EXPECT_TRUE(moved.allFinite());
}

// Corners thrown about by up to more than a spacing: cells pressed flat and turned inside out.
TEST_P(Baseline, CrushedCellsLeaveNoNumberUnfinite) {
  const TissueConfig config = pressBlock(0.3);
  Pair pair(config, solver());
  for (const int node : pair.exact.lattice.nodesIn(nodeBox(config, {2, 2, 2}, {6, 6, 4}))) {
    Shaker shaker(static_cast<unsigned>(node));
    pair.state.displacement[at(node)] = shaker.displacement(0.012);
  }
  std::vector<LoadingPatch> none;
  const SolveReport report = pair.method->solve(none, {}, pair.state);
  EXPECT_TRUE(std::isfinite(report.error_estimate) && std::isfinite(report.residual));
  for (const Vec3& moved : pair.state.displacement) ASSERT_TRUE(moved.allFinite());
}

TEST_P(Baseline, IsRefusedForTheSixSpringLattice) {
  TissueConfig config = pressBlock(0.45);
  config.model = "six_spring";
  const std::string line = inputErrorOf([&] { tissue(config); });
  EXPECT_TRUE(isOneLine(line) && mentions(line, "solver.method") && mentions(line, GetParam()) &&
              mentions(line, "allowed: paper"))
      << line;
}

INSTANTIATE_TEST_SUITE_P(Methods, Baseline, testing::Values("vbd", "xpbd", "explicit"),
                         [](const auto& method) { return method.param; });

}  // namespace
}  // namespace robot_tissue::test_baselines
