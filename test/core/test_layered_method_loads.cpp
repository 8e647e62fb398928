// Method `layered` under all kinds of loads, against method `newton`.
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "cutting/cut.h"
#include "layered_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_layered_method_loads {
namespace {

class LayeredByForce : public testing::TestWithParam<std::tuple<double, bool>> {};

TEST_P(LayeredByForce, PatchFindsWhereItsForceAndMomentBalance) {
  const auto [poisson_ratio, turns] = GetParam();
  const TissueConfig config = pressBlock(poisson_ratio);
  LayeredBlock block(config, within(1e-4));
  ElasticBlock exact(config);
  const Vec3 full(0.8, 0.0, -1.2);
  LoadingPatch moved, right = punchByForce(block, config, full, turns);
  moved = right;
  SolveReport report;
  for (const double share : {0.25, 0.5, 0.75, 1.0}) {
    moved.force = right.force = share * full;
    report = block.solve({moved});
    moved = block.patches[0];
    std::vector<LoadingPatch> loads = {right};
    ASSERT_EQ(exact.method.solve(loads, {}, exact.state).status, SolveStatus::kOk);
    right = loads[0];
    expectHonest(block, report, exact, 1e-4, 20.0);
  }
  EXPECT_LT((report.patches[0].force - full).norm(), 1e-3 * full.norm());
  EXPECT_LT((moved.place.displacement - right.place.displacement).norm(),
            1e-3 * right.place.displacement.norm());
  const double angle = Eigen::AngleAxisd(moved.place.rotation).angle();
  const double right_angle = Eigen::AngleAxisd(right.place.rotation).angle();
  EXPECT_NEAR(angle, right_angle, 1e-3 * right_angle);
  EXPECT_EQ(turns, angle > 1e-3);
}

INSTANTIATE_TEST_SUITE_P(RatiosAndTurns, LayeredByForce,
                         testing::Combine(testing::Values(0.25, 0.45), testing::Bool()));

// As where a tool comes near: nothing but the time of the first solve changes.
TEST(LayeredLoads, WhatIsExpectedAnswersAlike) {
  for (const bool is_long : {false, true}) {
    const TissueConfig config = is_long ? withFixedBottom(elasticBlockOf(64, 6, 6, 0.45))
                                        : withFixedBottom(elasticBlockOf(24, 24, 12, 0.45));
    LayeredBlock expected(config), plain(config);
    expected.method.expect(expected.state);
    for (LayeredBlock* block : {&expected, &plain}) {
      LoadingPatch patch = punchByForce(*block, config, Vec3(0.0, 0.0, -0.2), false);
      ASSERT_EQ(block->solve({patch}).status, SolveStatus::kOk);
    }
    EXPECT_EQ(expected.state.displacement, plain.state.displacement);
  }
}

TEST(LayeredLoads, CutAtRestNeedsNoCycle) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(24, 24, 12, 0.45));
  const double h = config.spacing;
  LayeredBlock block(config);
  const std::vector<Crossing> crossing = springsAcross(block.lattice, block.state,
                                                       {{12.4 * h, 6.3 * h, 7.6 * h},
                                                        {12.4 * h, 18.7 * h, 7.6 * h},
                                                        {12.4 * h, 18.7 * h, 13.0 * h},
                                                        {12.4 * h, 6.3 * h, 13.0 * h}});
  ASSERT_FALSE(crossing.empty());
  sever(block.lattice, crossing, block.state, block.model.splitCells());
  const SolveReport report = block.solve({}, {block.lattice.springs()[at(crossing[0].spring)].a});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.error_estimate, 0.0);
}

// Displacements hide what is rough beside a patch, forces do not.
TEST(LayeredLoads, ForceOfAShearedBlockIsRightInEachStep) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(16, 16, 8, 0.25));
  LayeredBlock block(config, within(1e-2)), exact(config, within(1e-5));
  const std::vector<int> top = block.lattice.nodesIn(nodeBox(config, {0, 0, 8}, {16, 16, 8}));
  for (const double way : {0.004, 0.008, 0.012, 0.016}) {
    Vec3 forces[2];
    for (LayeredBlock* each : {&block, &exact}) {
      each->method.beginStep(each->state);
      const SolveReport report = each->solve({displaced(top, Vec3(way, 0.0, 0.0))});
      ASSERT_EQ(report.status, SolveStatus::kOk);
      forces[each == &exact] = report.patches[0].force;
    }
    EXPECT_LT((forces[0] - forces[1]).norm(), 0.02 * forces[1].norm());
  }
}

class LayeredUniaxial : public testing::TestWithParam<double> {};

TEST_P(LayeredUniaxial, FreeAxesGivePoissonsRatioBack) {
  constexpr double kStrain = 1e-4;
  const TissueConfig config = elasticBlockOf(4, 3, 5, GetParam());
  LayeredBlock block(config, within(1e-7));
  std::vector<LoadingPatch> faces;
  for (const int k : {0, 5}) {
    faces.push_back(displaced(block.lattice.nodesIn(nodeBox(config, {0, 0, k}, {4, 3, k})),
                              Vec3(0.0, 0.0, kStrain * 0.01 * k)));
    faces.back().free_axis = {{true, true, false}};
  }
  const SolveReport report = block.solve(faces);
  ASSERT_EQ(report.status, SolveStatus::kOk);
  const double force = 1e4 * 0.04 * 0.03 * kStrain;
  EXPECT_NEAR(report.patches[1].force.z(), force, 2e-3 * force);
  // Nothing keeps the block from turning about z: lengths tell.
  const int from = block.lattice.node(0, 1, 2), to = block.lattice.node(4, 1, 2);
  const double width =
      (Vec3(0.04, 0.0, 0.0) + block.state.displacement[at(to)] - block.state.displacement[at(from)])
          .norm();
  EXPECT_NEAR((0.04 - width) / (kStrain * 0.04), GetParam(), 2e-3 * GetParam());
}

INSTANTIATE_TEST_SUITE_P(Ratios, LayeredUniaxial, testing::Values(0.25, 0.45, 0.49));

TEST(LayeredLoads, SagsUnderGravityAsNewtonSays) {
  TissueConfig config = elasticBlockOf(10, 3, 3, 0.45);
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, 3, 3}));
  config.gravity = Vec3(0.0, 0.0, -3.0);
  LayeredBlock block(config, within(1e-3));
  ElasticBlock exact(config);
  const SolveReport report = block.solve({}, nodesOf(block.lattice));
  ASSERT_EQ(exact.solve({}).status, SolveStatus::kOk);
  EXPECT_LT(exact.state.displacement.back().z(), -0.02);
  expectHonest(block, report, exact, 1e-3, 50.0);
}

TEST(LayeredLoads, RegionsAHundredTimesStifferAndSofter) {
  for (const double factor : {100.0, 0.01}) {
    TissueConfig config = pressBlock(0.45);
    Region region;
    region.name = "tumour";
    region.box = nodeBox(config, {4, 2, 1}, {6, 6, 3});
    region.material = config.material;
    region.material.young_modulus *= factor;
    config.regions.push_back(region);
    LayeredBlock block(config, within(1e-3));
    ElasticBlock exact(config);
    for (const double depth : {0.004, 0.008}) {
      const LoadingPatch punch =
          punchOn(block.lattice, block.model, block.state, config, Vec3(0.002, 0, -depth));
      const SolveReport report = block.solve({punch});
      ASSERT_EQ(exact.solve({punch}).status, SolveStatus::kOk);
      expectHonest(block, report, exact, 1e-3, 20.0);
    }
  }
}

// What hangs by one spring swings far under forces that are small beside those of a press.
TEST(LayeredLoads, BarThatHangsByOneSpringSwingsBackWhenLetGo) {
  TissueConfig config = elasticBlockOf(20, 4, 4, 0.45);
  const double h = config.spacing;
  config.fixed.push_back({Vec3(-1.0, -1.0, 3.21 * h), Vec3(1.0, 1.0, 1.0)});
  LayeredBlock block(config);
  const std::vector<std::vector<Vec3>> cuts = {{{-h, 1.5 * h, -h},
                                                {21 * h, 1.5 * h, -h},
                                                {21 * h, 1.5 * h, 1.5 * h},
                                                {-h, 1.5 * h, 1.5 * h}},
                                               {{0.5 * h, -h, 1.5 * h},
                                                {21 * h, -h, 1.5 * h},
                                                {21 * h, 1.5 * h, 1.5 * h},
                                                {0.5 * h, 1.5 * h, 1.5 * h}},
                                               {{-h, 0.5 * h, 1.5 * h},
                                                {0.5 * h, 0.5 * h, 1.5 * h},
                                                {0.5 * h, 1.5 * h, 1.5 * h},
                                                {-h, 1.5 * h, 1.5 * h}}};
  for (const std::vector<Vec3>& corners : cuts) {
    sever(block.lattice, springsAcross(block.lattice, block.state, corners), block.state,
          block.model.splitCells());
  }
  LoadingPatch end;
  end.name = "end";
  end.nodes = block.lattice.nodesIn({Vec3(20 * h, 0.0, 0.0), Vec3(20 * h, h, h)});
  end.displacement.assign(end.nodes.size(), Vec3(0.0, 0.0, -4.0 * h));
  ASSERT_EQ(block.solve({end}).status, SolveStatus::kOk);
  block.method.forget();
  // What hangs by an eighth of a cell swings so softly that no number of cycles here makes its
  // estimate small against a displacement that is gone; OK must not be said of a bar that hangs.
  block.solve({}, end.nodes);
  for (const Vec3& way : block.state.displacement) EXPECT_LT(way.norm(), 1e-3 * h);
}

TEST(LayeredLoads, TwoPatchesUnderGravityAddUp) {
  TissueConfig config = pressBlock(0.45);
  config.gravity = Vec3(0.0, 0.0, -9.81);
  LayeredBlock block(config, within(1e-6));
  LoadingPatch push =
      forced(block.lattice.nodesIn(nodeBox(config, {0, 3, 4}, {1, 5, 4})), Vec3(0.2, 0, -0.2));
  LoadingPatch pull =
      displaced(block.lattice.nodesIn(nodeBox(config, {6, 3, 4}, {7, 5, 4})), Vec3(0, 0, 0.003));
  pull.name = "pull";
  pull.free_axis[1] = true;
  const SolveReport report = block.solve({push, pull}, nodesOf(block.lattice));
  ASSERT_EQ(report.status, SolveStatus::kOk);
  EXPECT_EQ(report.patches[1].force.y(), 0.0);
  Vec3 total = report.patches[0].force + report.patches[1].force;
  double mass = 0.0;
  const std::vector<Vec3> forces = block.model.nodeForces(block.state);
  for (const int node : nodesOf(block.lattice)) {
    mass += block.lattice.mass(node);
    if (block.lattice.isFixed(node)) total -= forces[at(node)];
  }
  total += mass * config.gravity;
  EXPECT_LT(total.norm(), 1e-4);
  ASSERT_GT(mass * 9.81, 1.0);
}

TEST(LayeredLoads, FloatingTissueUnderAForceHasNoEquilibrium) {
  const TissueConfig config = elasticBlockOf(3, 3, 3, 0.45);
  LayeredBlock block(config);
  const SolveReport report = block.solve(
      {forced(block.lattice.nodesIn(nodeBox(config, {1, 1, 3}, {2, 2, 3})), Vec3(0, 0, -0.1))});
  EXPECT_NE(report.status, SolveStatus::kOk);
  for (const Vec3& moved : block.state.displacement) EXPECT_TRUE(moved.allFinite());
}

Tissue tissueOf(const TissueConfig& config, const std::string& method, double tolerance = 1e-3) {
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = tolerance;
  return Tissue(config, solver);
}

// Deep: half of the block's height; the load comes in increments of the method's own length.
TEST(LayeredTissue, DeepPressAgreesWithNewtonAndIsRestAfterRelease) {
  const TissueConfig config = pressBlock(0.45);
  Tissue layered = tissueOf(config, "layered"), newton = tissueOf(config, "newton");
  const LoadStep press = loadOf(
      {displacedPatch("punch", nodeBox(config, {3, 3, 4}, {5, 5, 4}), Vec3(0.0, 0.0, -0.02))});
  const std::vector<SolveReport> reports = reportsOf(layered, press);
  reportsOf(newton, press);
  for (const SolveReport& report : reports) EXPECT_EQ(report.status, SolveStatus::kOk);
  const double error = errorOf(layered.lattice(), layered.patches(), layered.state().displacement,
                               newton.state().displacement);
  EXPECT_LT(error, 2e-3);
  layered.release({"punch"});
  expectAtRest(layered);
}

// Solves after the first go on the way of the last one: not with what a sliding plate holds.
TEST(LayeredTissue, SlidingPlateIsWhereItIsHeldAfterManyIncrements) {
  const TissueConfig config = pressBlock(0.25);
  Tissue layered = tissueOf(config, "layered"), newton = tissueOf(config, "newton");
  PatchConfig plate =
      displacedPatch("plate", nodeBox(config, {0, 0, 4}, {8, 8, 4}), Vec3(0.0, 0.0, -0.004));
  plate.displacement = {{std::nullopt, std::nullopt, -0.004}};
  LoadStep press = loadOf({plate});
  press.increments = 4;
  const SolveReport last = reportsOf(layered, press).back();
  const SolveReport exact = reportsOf(newton, press).back();
  for (const int node : layered.patches().front().nodes) {
    EXPECT_EQ(layered.state().displacement[at(node)].z(), -0.004);
  }
  EXPECT_EQ(last.status, SolveStatus::kOk);
  EXPECT_NEAR(last.patches.front().force.z() / exact.patches.front().force.z(), 1.0, 5e-3);
}

TEST(LayeredTissue, CutTissueAgreesWithNewton) {
  const TissueConfig config = pressBlock(0.45);
  Tissue layered = tissueOf(config, "layered"), newton = tissueOf(config, "newton");
  const LoadStep press = loadOf(
      {displacedPatch("punch", nodeBox(config, {5, 3, 4}, {7, 5, 4}), Vec3(0.003, 0.0, -0.006))});
  for (Tissue* tissue : {&layered, &newton}) {
    reportsOf(*tissue, press);
    const CutReport cut = tissue->cut(
        {Vec3(0.035, -1, 0.015), Vec3(0.035, 1, 0.015), Vec3(0.035, 1, 0.1), Vec3(0.035, -1, 0.1)});
    ASSERT_GT(cut.springs_cut, 0);
    EXPECT_EQ(cut.solve.status, SolveStatus::kOk);
  }
  const double error = errorOf(layered.lattice(), layered.patches(), layered.state().displacement,
                               newton.state().displacement);
  EXPECT_LE(error, 2.0 * layered.lastReport().error_estimate);
  EXPECT_GE(10.0 * error, layered.lastReport().error_estimate);
}

TEST(LayeredTissue, PieceCutOffStaysWhereItIs) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(3, 3, 5, 0.45));
  Tissue tissue = tissueOf(config, "layered");
  const CutReport cut =
      tissue.cut({Vec3(-1, -1, 0.025), Vec3(1, -1, 0.025), Vec3(1, 1, 0.025), Vec3(-1, 1, 0.025)});
  ASSERT_EQ(cut.pieces, 2);
  const SolveReport report =
      reportsOf(tissue, loadOf({displacedPatch("punch", nodeBox(config, {1, 1, 2}, {2, 2, 2}),
                                               Vec3(0.0, 0.0, -0.004))}))
          .back();
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_GT(report.patches[0].force.norm(), 0.01);
  for (const int node : tissue.lattice().nodesIn(nodeBox(config, {0, 0, 3}, {3, 3, 5}))) {
    EXPECT_EQ(tissue.state().displacement[at(node)], Vec3(Vec3::Zero()));
  }
}

TEST(LayeredTissue, IsRefusedForTheSixSpringLattice) {
  TissueConfig config = pressBlock(0.45);
  config.model = "six_spring";
  const std::string line = inputErrorOf([&] { tissueOf(config, "layered"); });
  EXPECT_TRUE(isOneLine(line) && mentions(line, "solver.method") && mentions(line, "layered") &&
              mentions(line, "allowed: paper"))
      << line;
}

// Its nodes on the coarse lattice are on a line, about which nothing keeps them from turning there.
TEST(TurningStrip, AlongAnEdgeOfTheBlockFindsItsBalance) {
  TissueConfig config;
  config.spacing = 0.01;
  config.shape = {Vec3::Zero(), Vec3(0.06, 0.06, 0.03)};
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = 0.45;
  config.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  PatchConfig strip;
  strip.name = "strip";
  strip.turns = true;
  for (const double width : {0.01, 0.02, 0.03}) {
    strip.box = {Vec3(-1.0, -1.0, 0.03), Vec3(width, 1.0, 1.0)};
    for (const Vec3& force : {Vec3(0.0, 0.0, 0.05), Vec3(0.01, 0.0, 0.0), Vec3(0.0, 0.3, -0.2)}) {
      strip.force = force;
      LoadStep step;
      step.patches = {strip};
      SolverConfig newton;
      newton.method = "newton";
      Tissue tissue(config, {}), exact(config, newton);
      tissue.load(step);
      exact.load(step);
      const SolveReport &report = tissue.lastReport(), &right = exact.lastReport();
      ASSERT_EQ(right.status, SolveStatus::kOk);
      EXPECT_EQ(report.status, SolveStatus::kOk) << width << ", " << force.transpose();
      EXPECT_LT((report.patches.front().force - force).norm(), 0.03 * force.norm());
      const Vec3 way = right.patches.front().displacement;
      EXPECT_LT((report.patches.front().displacement - way).norm(), 0.02 * way.norm())
          << width << ", " << force.transpose();
    }
  }
}

// Of at most two cells along each axis: the coarse lattice is as fine there, and tells the error.
TEST(TinyBlock, AnswersAForceOnANodeByEveryMethod) {
  for (const int cells : {1, 2}) {
    TissueConfig config;
    config.spacing = 0.01;
    config.shape = {Vec3::Zero(), Vec3::Constant(config.spacing * cells)};
    config.material.young_modulus = 1e4;
    config.material.poisson_ratio = 0.45;
    config.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
    PatchConfig push;
    push.name = "push";
    const Vec3 place(0.01, 0.01, config.shape.max().z());
    push.box = {place, place};
    push.force = Vec3(0.0, 0.0, -0.01);
    LoadStep step;
    step.patches = {push};
    std::optional<Vec3> exact;
    for (const std::string method : {"newton", "layered", "vbd", "xpbd", "explicit"}) {
      SolverConfig solver;
      solver.method = method;
      Tissue tissue(config, solver);
      tissue.load(step);
      const SolveReport& report = tissue.lastReport();
      EXPECT_EQ(report.status, SolveStatus::kOk) << method << ' ' << cells;
      const Vec3 moved = report.patches.front().displacement;
      if (!exact) exact = moved;
      EXPECT_LT(moved.z(), -1e-4);
      EXPECT_LT((moved - *exact).norm(), 0.02 * exact->norm()) << method << ' ' << cells;
      EXPECT_NEAR(report.patches.front().force.z(), -0.01, 0.0002) << method << ' ' << cells;
    }
  }
}

// It turns about the corner as a whole, by forces that are next to nothing.
class HeldByACorner : public testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(HeldByACorner, IsAsExactAsItTells) {
  const auto [cells, poisson_ratio] = GetParam();
  TissueConfig config = elasticBlockOf(cells, 12, 6, poisson_ratio);
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {1, 1, 1}));
  LayeredBlock block(config, within(0.01));
  ElasticBlock exact(config);
  const std::vector<int> corner =
      block.lattice.nodesIn(nodeBox(config, {cells - 2, 10, 6}, {cells, 12, 6}));
  const LoadingPatch patch = displaced(corner, Vec3(0.003, -0.0002, -0.002));
  const SolveReport report = block.solve({patch});
  ASSERT_EQ(exact.solve({patch}).status, SolveStatus::kOk);
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LT(
      errorOf(block.lattice, block.patches, block.state.displacement, exact.state.displacement),
      0.015);
}

INSTANTIATE_TEST_SUITE_P(CellsAndRatios, HeldByACorner,
                         testing::Combine(testing::Values(6, 20), testing::Values(0.3, 0.49)));

}  // namespace
}  // namespace robot_tissue::test_layered_method_loads
