// Tissues with membranes: closed forms, methods that agree, cuts, refusals.
#include <gtest/gtest.h>

#include <cmath>

#include "membrane_fixtures.h"
#include "mesh_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_membranes {
namespace {

constexpr double kRadius = 0.03;  // m

SolverConfig solverOf(const std::string& method, double tolerance = 1e-3) {
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = tolerance;
  return solver;
}

// A ball that a membrane is around, off the grid, of a filling that is next to nothing.
TissueConfig ball(double ratio, double pressure) {
  TissueConfig config;
  config.model = "elastic";
  config.spacing = 0.01;
  config.material.young_modulus = 1.0;
  config.material.poisson_ratio = 0.25;
  config.mesh = std::make_shared<const TriangleMesh>(
      moved(sphereMesh(kRadius, 3), Vec3(0.0013, 0.0029, 0.0041)));
  config.membranes = {skin(1e-3, 1e5, ratio)};
  config.membranes[0].pressure = pressure;
  return config;
}

// The same with a wall and a cavity.
TissueConfig shell(double pressure) {
  TissueConfig config = ball(0.45, pressure);
  config.spacing = 0.005;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = 0.45;
  config.mesh = std::make_shared<const TriangleMesh>(
      joined(sphereMesh(kRadius, 3), insideOut(sphereMesh(0.75 * kRadius, 3))));
  config.membranes[0].side = MembraneConfig::Side::kInner;
  config.fixed = {{Vec3(-1, -1, -1), Vec3(1, 1, -0.02)}};
  return config;
}

double stretchOf(TissueConfig config, const std::string& method) {
  Tissue tissue(config, solverOf(method));
  const double rest = radiusOf(tissue);
  EXPECT_EQ(tissue.settle().status, SolveStatus::kOk);
  return radiusOf(tissue) / rest;
}

// p R (1 - nu) / (2 E t) is the strain of a thin sphere; far stretched, an incompressible one has
// p = 2 mu t / R (1 / L - 1 / L^7).
TEST(Membranes, BlownUpAsASphere) {
  for (const double ratio : {0.2, 0.45}) {
    const double strain = stretchOf(ball(ratio, 20.0), "newton") - 1.0;
    const double expected = 20.0 * kRadius * (1.0 - ratio) / (2.0 * 1e5 * 1e-3);
    EXPECT_NEAR(strain, expected, 0.02 * expected);
  }
  const double stretch = stretchOf(ball(0.5, 1200.0), "newton");
  EXPECT_GT(stretch, 1.15);
  const double pressure =
      2.0 * 1e5 / 3.0 * 1e-3 / kRadius * (1.0 / stretch - std::pow(stretch, -7.0));
  EXPECT_NEAR(pressure, 1200.0, 0.02 * 1200.0);
}

// Beyond 0.62 * 2 mu t / R such a balloon has no equilibrium: that is told, with numbers.
TEST(Membranes, BurstIsToldAndFinite) {
  TissueConfig config = ball(0.5, 1500.0);
  config.spacing = 0.02;
  for (const char* method : {"newton", "layered"}) {
    Tissue tissue(config, solverOf(method));
    const SolveReport report = tissue.settle();
    EXPECT_GE(report.status, SolveStatus::kUnconverged) << method;
    for (const Vec3& vertex : tissue.vertices()) ASSERT_TRUE(vertex.allFinite()) << method;
  }
}

// Pressed under a membrane that is firmer than its tissue, from a fixed bottom.
TissueConfig coveredBlock(int spacings) {
  TissueConfig config = withFixedBottom(blockOf(spacings, spacings, spacings / 2));
  config.model = "elastic";
  config.membranes = {skin(1e-3, 1e6)};
  return config;
}

LoadStep pressOn(const TissueConfig& config, int spacings) {
  const int middle = spacings / 2, top = spacings / 2;
  return loadOf({displacedPatch(
      "punch", nodeBox(config, {middle - 1, middle - 1, top}, {middle, middle, top}),
      Vec3(0, 0, -0.3 * config.spacing))});
}

TEST(Membranes, LayeredIsNewton) {
  for (const int spacings : {6, 9}) {
    const TissueConfig config = coveredBlock(spacings);
    Tissue exact(config, solverOf("newton")), tissue(config, solverOf("layered", 1e-4));
    exact.load(pressOn(config, spacings));
    tissue.load(pressOn(config, spacings));
    const Vec3 expected = exact.lastReport().patches.at(0).force;
    const Vec3 force = tissue.lastReport().patches.at(0).force;
    EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
    EXPECT_LT((force - expected).norm(), 2e-3 * expected.norm());
    TissueConfig bare = config;
    bare.membranes.clear();
    Tissue without(bare, solverOf("newton"));
    without.load(pressOn(bare, spacings));
    EXPECT_GT(expected.norm(), 1.1 * without.lastReport().patches.at(0).force.norm());
  }
}

// A capsule around a ball, off the grid, up to a thousand times as stiff as a layer of its cells.
TEST(Membranes, StiffOnesAreBalancedInFewCycles) {
  for (const double contrast : {100.0, 1000.0}) {
    TissueConfig config = shell(0.0);
    config.membranes[0].side = MembraneConfig::Side::kOuter;
    config.membranes[0].young_modulus =
        contrast * config.material.young_modulus * config.spacing / config.membranes[0].thickness;
    const LoadStep push =
        loadOf({displacedPatch("push", Box(Vec3(-1, -1, 0.9 * kRadius), Vec3(1, 1, 1)),
                               Vec3(0, 0, -0.002 * config.spacing))});
    Tissue exact(config, solverOf("newton")), tissue(config, solverOf("layered"));
    exact.load(push);
    tissue.load(push);
    const Vec3 expected = exact.lastReport().patches.at(0).force;
    const SolveReport& report = tissue.lastReport();
    EXPECT_EQ(report.status, SolveStatus::kOk) << contrast;
    EXPECT_LE(report.iterations, 24) << contrast;
    EXPECT_LT((report.patches.at(0).force - expected).norm(), 2e-3 * expected.norm()) << contrast;
  }
}

TEST(Membranes, AnyNumberOfThreadsFindsTheSame) {
  std::vector<Vec3> first;
  for (const int threads : {1, 2, 7}) {
    SolverConfig solver = solverOf("layered");
    solver.threads = threads;
    Tissue tissue(shell(300.0), solver);
    tissue.settle();
    if (first.empty()) first = tissue.state().displacement;
    EXPECT_EQ(tissue.state().displacement, first) << threads;
  }
  EXPECT_FALSE(first.empty());
}

// What holds the tissue holds it against what acts: a pressure inside has no net force.
TEST(Membranes, PressureHasNoNetForce) {
  Tissue tissue(shell(1000.0), solverOf("newton"));
  const double volume = enclosedVolume(tissue.surface(), tissue.surface().rest);
  ASSERT_EQ(tissue.settle().status, SolveStatus::kOk);
  EXPECT_TRUE(isDeformed(tissue));
  EXPECT_LT(tissue.forceOfFixedNodes().norm(), 1e-8 * 1000.0 * kRadius * kRadius);
  // The wall, nearly incompressible, keeps its volume as its cavity grows.
  EXPECT_NEAR(enclosedVolume(tissue.surface(), tissue.vertices()), volume, 0.05 * volume);
}

// A cut through the wall opens the cavity: no pressure is left, and only the membrane's own share
// of the shape with it; a reset mends it.
TEST(Membranes, CutLetsThePressureOut) {
  Tissue tissue(shell(300.0), solverOf("layered"));
  tissue.settle();
  const std::vector<Vec3> blown = tissue.state().displacement;
  double most = 0.0;
  for (const Vec3& motion : blown) most = std::max(most, motion.norm());
  ASSERT_GT(most, 1e-4);
  const CutReport cut = tissue.cut({Vec3(-0.002, -0.05, 0.012), Vec3(-0.002, 0.05, 0.012),
                                    Vec3(-0.002, 0.05, 0.05), Vec3(-0.002, -0.05, 0.05)});
  ASSERT_GT(cut.springs_cut, 0);
  double left = 0.0;
  for (const Vec3& motion : tissue.state().displacement) left = std::max(left, motion.norm());
  EXPECT_LT(left, 0.02 * most);
  tissue.reset();
  tissue.settle();
  EXPECT_EQ(tissue.state().displacement, blown);
}

// What the levels learned of the shape before is forgotten with it.
TEST(Membranes, AfterAResetAllIsAsTheFirstTime) {
  TissueConfig config = coveredBlock(6);
  config.material.poisson_ratio = 0.3;
  config.membranes[0].young_modulus = 1e5;
  const LoadStep pull = loadOf(
      {forcedPatch("pull", nodeBox(config, {3, 0, 3}, {4, 1, 3}), Vec3(-0.01, -0.02, -0.09))});
  Tissue tissue(config, solverOf("layered"));
  tissue.load(pull);
  const std::vector<Vec3> first = tissue.state().displacement;
  ASSERT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  tissue.reset();
  tissue.load(pull);
  EXPECT_EQ(tissue.state().displacement, first);
}

// Parted with the surface: a covered strip cut through is two, and nothing pulls across.
TEST(Membranes, CutPartsThem) {
  TissueConfig config = blockOf(8, 4, 2);
  config.model = "elastic";
  config.fixed = {{Vec3(-1, -1, -1), Vec3(1e-6, 1, 1)}};
  config.membranes = {skin(1e-3, 1e6)};
  Tissue tissue(config, solverOf("newton"));
  const double x = 4.5 * config.spacing;
  const CutReport cut =
      tissue.cut({Vec3(x, -1, -1), Vec3(x, 1, -1), Vec3(x, 1, 1), Vec3(x, -1, 1)});
  ASSERT_EQ(cut.pieces, 2);
  tissue.load(loadOf({displacedPatch("pull", nodeBox(config, {8, 0, 0}, {8, 4, 2}),
                                     Vec3(0.5 * config.spacing, 0, 0))}));
  const double pulled = tissue.lastReport().patches.at(0).force.norm();
  EXPECT_LT(pulled, 1e-9 * config.material.young_modulus * config.spacing * config.spacing);
}

// At rest there is nothing to do, to the last bit.
TEST(Membranes, RestIsAtRest) {
  for (const char* method : {"newton", "layered"}) {
    Tissue tissue(shell(0.0), solverOf(method));
    const SolveReport report = tissue.settle();
    EXPECT_EQ(report.status, SolveStatus::kOk) << method;
    EXPECT_EQ(report.iterations, 0) << method;
    expectAtRest(tissue);
  }
}

// Only what the boxes hold is covered.
TEST(Membranes, BoxesChoose) {
  const auto force = [](std::vector<Box> boxes, bool covered) {
    TissueConfig config = coveredBlock(6);
    config.membranes[0].boxes = std::move(boxes);
    if (!covered) config.membranes.clear();
    Tissue tissue(config, solverOf("newton"));
    tissue.load(pressOn(config, 6));
    return tissue.lastReport().patches.at(0).force.norm();
  };
  const double spacing = coveredBlock(6).spacing;
  const Box top(Vec3(-1, -1, 2.9 * spacing), Vec3(1, 1, 1));
  const Box sides(Vec3(-1, -1, -1), Vec3(1, 1, 2.9 * spacing));
  const double bare = force({}, false), all = force({}, true);
  EXPECT_GT(force({top}, true), 1.1 * bare);
  EXPECT_LT(force({sides}, true), force({top}, true));
  EXPECT_GT(all, force({top}, true));
  EXPECT_NEAR(force({top, sides}, true), all, 1e-6 * all);
}

// A state that was saved knows nothing of membranes: they are the scene's, and it is balanced anew
// where those differ.
TEST(Membranes, SavedStatesComeBack) {
  Tissue tissue(shell(300.0), solverOf("layered")), same(shell(300.0), solverOf("layered"));
  tissue.settle();
  same.loadState(*same.readState(tissue.savedState()));
  EXPECT_EQ(same.state().displacement, tissue.state().displacement);
  Tissue other(shell(600.0), solverOf("layered")), fresh(shell(600.0), solverOf("layered"));
  EXPECT_EQ(other.loadState(*other.readState(tissue.savedState())).status, SolveStatus::kOk);
  fresh.settle();
  double apart = 0.0, length = 0.0;
  for (std::size_t node = 0; node < fresh.state().displacement.size(); ++node) {
    apart += (other.state().displacement[node] - fresh.state().displacement[node]).squaredNorm();
    length += fresh.state().displacement[node].squaredNorm();
  }
  ASSERT_GT(length, 0.0);
  EXPECT_LT(std::sqrt(apart / length), 5e-3);
}

std::string refusalOf(const TissueConfig& config, const SolverConfig& solver) {
  try {
    Tissue tissue(config, solver);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Membranes, RefusesWhatNothingCanBeSaidOf) {
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos && text.find('\n') == std::string::npos;
  };
  TissueConfig no_cavity = ball(0.3, 10.0);
  no_cavity.membranes[0].side = MembraneConfig::Side::kInner;
  EXPECT_TRUE(has(refusalOf(no_cavity, solverOf("newton")), "tissue.membranes[0].side"));
  TissueConfig nowhere = ball(0.3, 0.0);
  nowhere.membranes[0].boxes = {{Vec3(1, 1, 1), Vec3(2, 2, 2)}};
  EXPECT_TRUE(has(refusalOf(nowhere, solverOf("newton")), "tissue.membranes[0].boxes"));
  TissueConfig open = ball(0.3, 10.0);
  open.membranes[0].boxes = {{Vec3(-1, -1, 0), Vec3(1, 1, 1)}};
  EXPECT_TRUE(has(refusalOf(open, solverOf("newton")), "tissue.membranes[0].pressure"));
  TissueConfig which = shell(10.0);
  which.membranes[0].side = MembraneConfig::Side::kAll;
  EXPECT_TRUE(has(refusalOf(which, solverOf("newton")), "side outer, or inner"));
  for (const char* method : {"vbd", "xpbd", "explicit"}) {
    EXPECT_TRUE(has(refusalOf(ball(0.3, 10.0), solverOf(method)), "layered, newton")) << method;
  }
  TissueConfig in_time = ball(0.3, 0.0);
  in_time.time = TimeConfig();
  EXPECT_TRUE(has(refusalOf(in_time, solverOf("layered")), "tissue.time"));
}

}  // namespace
}  // namespace robot_tissue::test_membranes
