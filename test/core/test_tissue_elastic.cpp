// Tissue of model `elastic` behind its one door: rims, what is shown, standing patches.
#include <gtest/gtest.h>

#include "robot_tissue/core/tissue.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_tissue_elastic {
namespace {

class ElasticTissue : public ::testing::Test {
 protected:
  static TissueConfig config() {
    TissueConfig config;
    config.model = "elastic";
    config.shape.max() = Vec3(0.08, 0.08, 0.04);
    config.spacing = 0.01;
    config.material.young_modulus = 1e4;
    config.material.poisson_ratio = 0.4;
    config.fixed.push_back({Vec3::Zero(), Vec3(1.0, 1.0, 0.0)});
    return config;
  }
  static SolverConfig exact() {
    SolverConfig solver;
    solver.method = "newton";
    return solver;
  }
  static PatchConfig pressed(const std::string& name, double x0, double x1, double depth) {
    PatchConfig patch;
    patch.name = name;
    patch.box = {Vec3(x0, 0.03, 0.04), Vec3(x1, 0.05, 0.04)};
    patch.displacement = {{0.0, 0.0, -depth}};
    return patch;
  }
  SolveReport load(const std::vector<PatchConfig>& patches) {
    LoadStep step;
    step.patches = patches;
    SolveReport last;
    tissue_.load(step, [&](int, int, const SolveReport& report) { last = report; });
    return last;
  }

  Tissue tissue_{config(), exact()};
};

TEST_F(ElasticTissue, ShowsThePatchWhereItIsThoughItsRimSlips) {
  const SolveReport report = load({pressed("punch", 0.03, 0.05, 0.003)});
  const std::vector<Vec3> shown = tissue_.shownDisplacement();
  double slipped = 0.0;
  for (const int node : tissue_.patches().front().nodes) {
    EXPECT_EQ(shown[at(node)], Vec3(0.0, 0.0, -0.003));
    slipped = std::max(slipped, (tissue_.state().displacement[at(node)] - shown[at(node)]).norm());
  }
  EXPECT_GT(slipped, 1e-4);
  EXPECT_EQ(report.patches.front().displacement, Vec3(0.0, 0.0, -0.003));
  const auto& surface = tissue_.surface();
  for (std::size_t vertex = 0; vertex < surface.rest.size(); ++vertex) {
    const CarrierRange carriers = surface.carriers[vertex];
    if (carriers.size() != 1) continue;
    const Vec3 expected = surface.rest[vertex] + shown[at(carriers.front().node)];
    EXPECT_EQ(tissue_.vertices()[vertex], expected);
  }
}

// The force is what the springs under it and at its rim answer; it is the fixed nodes' too.
TEST_F(ElasticTissue, PatchAndFixedNodesBalance) {
  const SolveReport report = load({pressed("punch", 0.03, 0.05, 0.003)});
  Vec3 held = Vec3::Zero();
  for (int node = 0; node < tissue_.lattice().nodeCount(); ++node) {
    if (tissue_.lattice().isFixed(node)) held += tissue_.nodeForce(node);
  }
  EXPECT_LT(report.patches.front().force.z(), -0.1);
  EXPECT_LT((report.patches.front().force - held).norm(), 1e-9 * held.norm());
}

TEST_F(ElasticTissue, ForceAndDisplacementGiveTheSame) {
  const SolveReport pressed_report = load({pressed("punch", 0.03, 0.05, 0.003)});
  tissue_.release({"punch"});
  PatchConfig pushed = pressed("punch", 0.03, 0.05, 0.0);
  pushed.displacement.reset();
  pushed.force = pressed_report.patches.front().force;
  const SolveReport report = load({pushed});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LT((report.patches.front().displacement - Vec3(0.0, 0.0, -0.003)).norm(), 1e-9);
}

TEST_F(ElasticTissue, StandingPatchGoesOnFromWhereItIs) {
  load({pressed("punch", 0.03, 0.05, 0.002)});
  const SolveReport in_two = load({pressed("punch", 0.03, 0.05, 0.004)});
  Tissue other(config(), exact());
  LoadStep step;
  step.patches.push_back(pressed("punch", 0.03, 0.05, 0.004));
  SolveReport in_one;
  other.load(step, [&](int, int, const SolveReport& report) { in_one = report; });
  EXPECT_LT((in_two.patches.front().force - in_one.patches.front().force).norm(), 1e-8);
}

// Side by side, a node between them belongs to neither rim of the other's own nodes.
TEST_F(ElasticTissue, NeighboringPatchesKeepTheirOwnNodes) {
  const SolveReport both =
      load({pressed("left", 0.02, 0.034, 0.002), pressed("right", 0.04, 0.06, 0.002)});
  EXPECT_EQ(both.status, SolveStatus::kOk);
  const auto& patches = tissue_.patches();
  ASSERT_EQ(patches.size(), 2u);
  for (std::size_t one = 0; one < 2; ++one) {
    const auto& others = patches[1 - one].nodes;
    for (const RimSpring& spring : patches[one].rim) {
      EXPECT_EQ(std::count(others.begin(), others.end(), spring.node), 0);
    }
  }
  tissue_.release({"left", "right"});
  for (const Vec3& moved : tissue_.state().displacement) EXPECT_EQ(moved, Vec3(0, 0, 0));
}

TEST_F(ElasticTissue, FreeAxesOfARimSlide) {
  PatchConfig plate = pressed("plate", 0.03, 0.05, 0.003);
  plate.displacement = {{std::nullopt, std::nullopt, -0.003}};
  const SolveReport sliding = load({plate});
  EXPECT_NEAR(sliding.patches.front().force.x(), 0.0, 1e-12);
  tissue_.reset();
  const SolveReport bonded = load({pressed("plate", 0.03, 0.05, 0.003)});
  EXPECT_LT(-sliding.patches.front().force.z(), -bonded.patches.front().force.z());
}

TEST_F(ElasticTissue, SettlesUnderItsWeightAndCarriesIt) {
  TissueConfig heavy = config();
  heavy.gravity = Vec3(0.0, 0.0, -9.81);
  Tissue tissue(heavy, exact());
  EXPECT_EQ(tissue.settle().status, SolveStatus::kOk);
  Vec3 held = Vec3::Zero();
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    if (tissue.lattice().isFixed(node)) held += tissue.nodeForce(node);
  }
  const double weight = 9.81 * 1000.0 * 0.08 * 0.08 * 0.04;
  EXPECT_NEAR(held.z(), -weight, 1e-9 * weight);
}

}  // namespace
}  // namespace robot_tissue::test_tissue_elastic
