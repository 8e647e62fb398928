// Patches by force that may turn: force and moment balance, in method newton.
#include <gtest/gtest.h>

#include <cmath>

#include "robot_tissue/core/tissue.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_turning_patch {
namespace {

constexpr double kSpacing = 0.005;

// A bar of 4 x 4 x 24 cells along x, clamped at x = 0.
TissueConfig clampedBar() {
  TissueConfig config;
  config.model = "elastic";
  config.shape.max() = kSpacing * Vec3(24, 4, 4);
  config.spacing = kSpacing;
  config.material.young_modulus = 1e5;
  config.material.poisson_ratio = 0.3;
  config.fixed.push_back({Vec3::Zero(), Vec3(0.0, 1.0, 1.0)});
  return config;
}

PatchConfig endOf(const TissueConfig& config, const Vec3& force, bool turns) {
  PatchConfig end;
  end.name = "end";
  end.box = config.shape;
  end.box.min().x() = config.shape.max().x();
  end.force = force;
  end.turns = turns;
  return end;
}

struct Loaded {
  explicit Loaded(const TissueConfig& config) : tissue(config, exact()) {}
  static SolverConfig exact() {
    SolverConfig solver;
    solver.method = "newton";
    return solver;
  }
  SolveReport load(const PatchConfig& patch) {
    LoadStep step;
    step.patches.push_back(patch);
    SolveReport last;
    tissue.load(step, [&](int, int, const SolveReport& report) { last = report; });
    return last;
  }
  Tissue tissue;
};

// Euler and Bernoulli with shear (Timoshenko): F L^3 / 3 E I of an end that turns, F L^3 / 12 E I
// of one that does not; both less than 1 % from slender at this length but for the shear's share.
TEST(TurningPatch, EndOfABarBendsAsABeamDoes) {
  const TissueConfig config = clampedBar();
  const double thick = 4 * kSpacing, length = 24 * kSpacing, force = 1e-3;
  const double inertia = std::pow(thick, 4) / 12.0;
  const double bending = force * std::pow(length, 3) / (config.material.young_modulus * inertia);
  const double shear =
      force * length * 2.0 * 1.3 / (5.0 / 6.0 * config.material.young_modulus * thick * thick);
  for (const bool turns : {true, false}) {
    Loaded bar(config);
    const SolveReport report = bar.load(endOf(config, Vec3(0.0, 0.0, -force), turns));
    EXPECT_EQ(report.status, SolveStatus::kOk);
    const double expected = bending / (turns ? 3.0 : 12.0) + shear;
    EXPECT_NEAR(-report.patches.front().displacement.z(), expected, 0.03 * expected) << turns;
    EXPECT_NEAR(report.patches.front().force.z(), -force, 1e-9 * force);
  }
}

TEST(TurningPatch, NoMomentIsLeftAboutItsCenter) {
  const TissueConfig config = clampedBar();
  Loaded bar(config);
  bar.load(endOf(config, Vec3(0.0, 0.05, -0.1), true));
  const LoadingPatch& patch = bar.tissue.patches().front();
  const Vec3 center = patch.center + patch.place.displacement;
  Vec3 moment = Vec3::Zero(), force = Vec3::Zero();
  for (const int node : patch.nodes) {
    const Vec3 position =
        bar.tissue.lattice().restPosition(node) + bar.tissue.state().displacement[at(node)];
    const Vec3 pull = bar.tissue.nodeForce(node);
    force += pull;
    moment += (position - center).cross(pull);
  }
  EXPECT_LT((force + Vec3(0.0, 0.05, -0.1)).norm(), 1e-9);
  EXPECT_LT(moment.norm(), 1e-9 * 0.1 * config.shape.max().x());
  EXPECT_GT(Eigen::AngleAxisd(patch.place.rotation).angle(), 0.1) << "it has turned";
}

// What is hard stays hard: the patch's nodes keep their distances.
TEST(TurningPatch, KeepsItsShapeWhileItTurns) {
  const TissueConfig config = clampedBar();
  Loaded bar(config);
  bar.load(endOf(config, Vec3(0.0, 0.0, -0.3), true));
  const std::vector<int>& nodes = bar.tissue.patches().front().nodes;
  const auto place = [&](int node) -> Vec3 {
    return bar.tissue.lattice().restPosition(node) + bar.tissue.state().displacement[at(node)];
  };
  for (const int node : nodes) {
    const double rest =
        (bar.tissue.lattice().restPosition(node) - bar.tissue.lattice().restPosition(nodes.front()))
            .norm();
    EXPECT_NEAR((place(node) - place(nodes.front())).norm(), rest, 1e-12);
  }
}

// A punch off the middle of a block tilts; its rim's springs turn with it.
TEST(TurningPatch, PunchNearAnEdgeTiltsTowardsIt) {
  TissueConfig config;
  config.model = "elastic";
  config.shape.max() = Vec3(0.08, 0.06, 0.03);
  config.spacing = 0.005;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = 0.45;
  config.fixed.push_back({Vec3::Zero(), Vec3(1.0, 1.0, 0.0)});
  PatchConfig punch;
  punch.name = "punch";
  punch.box = {Vec3(0.06, 0.02, 0.03), Vec3(0.08, 0.04, 0.03)};
  punch.force = Vec3(0.0, 0.0, -0.3);
  double straight = 0.0;
  for (const bool turns : {false, true}) {
    punch.turns = turns;
    Loaded block(config);
    const SolveReport report = block.load(punch);
    ASSERT_EQ(report.status, SolveStatus::kOk);
    EXPECT_NEAR(report.patches.front().force.z(), -0.3, 1e-8);
    const LoadingPatch& patch = block.tissue.patches().front();
    EXPECT_FALSE(patch.rim.empty());
    const double depth = -report.patches.front().displacement.z();
    if (!turns) {
      straight = depth;
      continue;
    }
    EXPECT_GT(depth, straight) << "less is held, so it sinks deeper";
    // The soft side is that of the edge at larger x: it goes down, a turn about +y.
    EXPECT_GT(patch.place.rotation(0, 2), 0.01);
    EXPECT_NEAR(patch.place.rotation(1, 2), 0.0, 1e-9);
    block.tissue.release({"punch"});
    for (const Vec3& moved : block.tissue.state().displacement) EXPECT_EQ(moved, Vec3(0, 0, 0));
  }
}

TEST(TurningPatch, IsRefusedByMethodsThatKnowNoTurns) {
  TissueConfig config = clampedBar();
  config.model = "six_spring";
  SolverConfig paper;
  paper.method = "paper";
  Tissue tissue(config, paper);
  LoadStep step;
  step.patches.push_back(endOf(config, Vec3(0.0, 0.0, -0.1), true));
  const std::string line = inputErrorOf([&] { tissue.load(step); });
  EXPECT_TRUE(isOneLine(line));
  EXPECT_TRUE(mentions(line, "turns")) << line;
}

// About a line of nodes nothing would keep it from turning.
TEST(TurningPatch, IsRefusedOnALineOfNodes) {
  TissueConfig config;
  config.shape = {Vec3::Zero(), Vec3(0.1, 0.04, 0.02)};
  config.spacing = 0.01;
  config.material.young_modulus = 1e4;
  config.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  Tissue tissue(config, {});
  PatchConfig line;
  line.name = "line";
  line.force = Vec3(0.03, -0.006, -0.004);
  line.turns = true;
  for (const double end : {0.07, 0.1}) {
    line.box = {Vec3(0.07, 0.04, 0.02), Vec3(end, 0.04, 0.02)};
    LoadStep step;
    step.patches = {line};
    const std::string refused = inputErrorOf([&] { tissue.load(step); });
    EXPECT_TRUE(isOneLine(refused));
    EXPECT_TRUE(mentions(refused, "turns")) << refused;
    EXPECT_TRUE(mentions(refused, "allowed")) << refused;
  }
}

// A large turn of a small patch, which what is left of it goes on with by less than matters.
TEST(TurningPatch, AtTheDefaultToleranceEndsInBalance) {
  TissueConfig config = withFixedBottom(blockOf(4, 6, 6, 0.01));
  config.model = "elastic";
  config.material.poisson_ratio = 0.45;
  PatchConfig patch;
  patch.name = "edge";
  patch.box = {Vec3(0.01, 0.05, 0.06), Vec3(0.02, 0.06, 0.06)};
  patch.force = Vec3(0.29, 0.033, 0.229);
  patch.turns = true;
  std::vector<Vec3> displacement;
  for (const char* method : {"layered", "newton"}) {
    SolverConfig solver;
    solver.method = method;
    Tissue tissue(config, solver);
    for (const SolveReport& report : reportsOf(tissue, loadOf({patch}))) {
      EXPECT_EQ(report.status, SolveStatus::kOk) << method;
    }
    displacement.push_back(tissue.answerOf("edge", tissue.lastReport()).displacement);
  }
  EXPECT_LT((displacement[0] - displacement[1]).norm(), 0.01 * displacement[1].norm());
}

}  // namespace
}  // namespace robot_tissue::test_turning_patch
