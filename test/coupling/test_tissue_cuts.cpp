// Tissue of model elastic with cuts: ghosts from the cut to the reset, under loads and tools.
#include <gtest/gtest.h>

#include "core/tissue_fixtures.h"
#include "robot_tissue/coupling/sticking_contacts.h"

namespace robot_tissue::test_tissue_cuts {
namespace {

constexpr double kSpacing = 0.01;

TissueConfig elasticBlock() {
  TissueConfig config = withFixedBottom(blockOf(4, 3, 3, kSpacing));
  config.model = "elastic";
  config.material.poisson_ratio = 0.45;
  return config;
}

SolverConfig newton() {
  SolverConfig solver;
  solver.method = "newton";
  return solver;
}

// Upright across x, in spacings, from `height` up.
std::vector<Vec3> upright(double x, double height) {
  x *= kSpacing;
  height *= kSpacing;
  return {Vec3(x, -1, height), Vec3(x, 1, height), Vec3(x, 1, 1), Vec3(x, -1, 1)};
}

std::vector<Vec3> level(double height) {
  const double z = height * kSpacing;
  return {Vec3(-1, -1, z), Vec3(1, -1, z), Vec3(1, 1, z), Vec3(-1, 1, z)};
}

class CutTissue : public ::testing::Test {
 protected:
  int nodes() const { return tissue_.lattice().nodeCount(); }
  int ghosts() const { return static_cast<int>(tissue_.state().displacement.size()) - nodes(); }
  LoadStep pull(double way) const {
    return loadOf({displacedPatch("pull", nodeBox(config_, {0, 0, 3}, {1, 3, 3}),
                                  Vec3(-way, 0.0, 0.5 * way))});
  }
  TissueConfig config_ = elasticBlock();
  Tissue tissue_{config_, newton()};
};

TEST_F(CutTissue, AtRestStaysAtRest) {
  const CutReport cut = tissue_.cut(upright(1.5, 0.5));
  EXPECT_EQ(cut.solve.status, SolveStatus::kOk);
  EXPECT_EQ(ghosts(), 2 * 3 * 4);  // on both sides, those at the front, too
  EXPECT_NEAR(cut.solve.volume_ratio, 1.0, 1e-12);
  expectAtRest(tissue_);
}

TEST_F(CutTissue, OpensFreelyAndIsSofterForIt) {
  const double whole = reportsOf(tissue_, pull(0.004)).back().patches[0].force.norm();
  const SolveReport cut = tissue_.cut(upright(1.5, 0.5)).solve;
  ASSERT_EQ(cut.status, SolveStatus::kOk);
  EXPECT_LT(cut.patches[0].force.norm(), 0.9 * whole);
  EXPECT_GT(cut.patches[0].force.norm(), 0.1 * whole);
  // The right side lets go: it is nearer to its rest than the left one.
  const auto& moved = tissue_.state().displacement;
  const Lattice& lattice = tissue_.lattice();
  EXPECT_GT(moved[at(lattice.node(2, 1, 3))].x() - moved[at(lattice.node(1, 1, 3))].x(), 0.002);
}

TEST_F(CutTissue, PieceCutOffGoesWithoutForce) {
  ASSERT_EQ(tissue_.cut(level(1.5)).pieces, 2);
  const SolveReport report = reportsOf(tissue_, pull(0.02)).back();
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LT(report.patches[0].force.norm(), 1e-9);
  EXPECT_NEAR(report.volume_ratio, 1.0, 1e-9);
  EXPECT_EQ(report.inverted_cells, 0);
}

TEST_F(CutTissue, TakesUpAShapeFromBeforeTheCut) {
  reportsOf(tissue_, pull(0.004));
  const Tissue::Shape before = tissue_.shape();
  tissue_.cut(upright(1.5, 0.5));
  ASSERT_GT(ghosts(), 0);
  tissue_.restore(before);
  const LatticeState& state = tissue_.state();
  ASSERT_EQ(at(state.cells->nodeCount()), state.displacement.size());
  for (int node = 0; node < state.cells->nodeCount(); ++node) {
    EXPECT_EQ(state.displacement[at(node)],
              (*before.displacement)[at(state.cells->original(node))]);
  }
}

TEST_F(CutTissue, ResetMendsIt) {
  tissue_.cut(upright(1.5, 0.5));
  tissue_.cut(level(1.5));
  reportsOf(tissue_, pull(0.004));
  ASSERT_GT(ghosts(), 0);
  tissue_.reset();
  EXPECT_EQ(ghosts(), 0);
  expectAtRest(tissue_);
  const double again = reportsOf(tissue_, pull(0.004)).back().patches[0].force.norm();
  Tissue other(config_, newton());
  EXPECT_NEAR(again, reportsOf(other, pull(0.004)).back().patches[0].force.norm(), 1e-9 * again);
}

TEST_F(CutTissue, OfSpringsAloneHasNoGhosts) {
  config_.model = "six_spring";
  Tissue springs(config_, paperSolver());
  ASSERT_GT(springs.cut(upright(1.5, 0.5)).springs_cut, 0);
  EXPECT_EQ(springs.state().displacement.size(), at(nodes()));
}

// A contact at the edge of a cut moves the node beside the cut and the ghost behind it.
TEST_F(CutTissue, ToolAtTheCutsEdgeTakesGhostsAlong) {
  ASSERT_GT(tissue_.cut(upright(1.5, 0.5)).springs_cut, 0);
  StickingContacts patches(tissue_.lattice(), {"probe"});
  RobotPose pose;
  pose.links = {Pose::Identity()};
  const TissueSurface& surface = tissue_.surface();
  const int beside = tissue_.lattice().node(1, 1, 3);
  const auto isAtEdge = [&](int vertex) {
    const CarrierRange carriers = surface.carriers[at(vertex)];
    return carriers.size() == 2 && carriers[0].node == beside;
  };
  Contact contact;
  contact.normal = -Vec3::UnitZ();
  contact.depth_m = 1e-3;
  int edge = -1;
  for (std::size_t i = 0; i < surface.triangles.size() && edge < 0; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      if (!isAtEdge(surface.triangles[i][at(corner)])) continue;
      edge = surface.triangles[i][at(corner)];
      contact.place = {static_cast<int>(i), Vec3::Unit(corner)};
    }
  }
  ASSERT_GE(edge, 0);
  contact.point = tissue_.vertices()[at(edge)];
  ContactSet contacts;
  contacts.contacts = {contact};
  patches.ride(pose, tissue_);
  patches.pushOut(contacts, tissue_, pose);
  const std::vector<int> held = patches.nodes(0);
  ASSERT_EQ(held.size(), 2u);
  EXPECT_EQ(held[0], beside);
  EXPECT_TRUE(tissue_.state().cells->isGhost(held[1]));
  const SolveReport report = tissue_.follow({patches.loadingPatch(0, tissue_)}, {});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LT(report.patches[0].force.z(), -1e-3);
  EXPECT_NEAR(tissue_.vertices()[at(edge)].z(), contact.point.z() - 1e-3, 1e-6);

  // The tool goes on, another cut is made, a load put on: the ghost rides along.
  pose.links[0].translation().z() = -1e-3;
  ASSERT_GT(tissue_.cut(level(1.5)).springs_cut, 0);
  patches.ride(pose, tissue_);
  EXPECT_EQ(patches.nodes(0), held);
  EXPECT_EQ(tissue_.follow({patches.loadingPatch(0, tissue_)}, {}).status, SolveStatus::kOk);
  for (const int node : held) {
    EXPECT_LT(tissue_.state().displacement[at(node)].z(), -1.9e-3);
    EXPECT_NEAR(tissue_.nodePosition(node).z(),
                3.0 * kSpacing + tissue_.state().displacement[at(node)].z(), 1e-12);
  }
  const auto loaded =
      reportsOf(tissue_, loadOf({displacedPatch("pull", nodeBox(config_, {4, 0, 3}, {4, 3, 3}),
                                                Vec3(0.001, 0.0, 0.0))}));
  EXPECT_EQ(loaded.back().status, SolveStatus::kOk);
}

}  // namespace
}  // namespace robot_tissue::test_tissue_cuts
