// Blocks under springs in contact: both methods that find equilibria find the same one.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "layered_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_contact_equilibrium {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kDepth = 2e-3;  // of the plane below the top (m)

struct Press {
  std::string name;
  double poisson_ratio = 0.45;
  double friction_bound = 0.0;  // N, of each spring
  bool on_a_patch = false;      // some of the points are carried by a patch that a force moves
};

TissueConfig configOf(const Press& press) {
  return withFixedBottom(elasticBlockOf(6, 6, 3, press.poisson_ratio));
}

// Of a plane that was pressed into the top and drawn sideways: points at nodes and between them.
LoadingPatch planeOn(const Lattice& lattice, const TissueModel& model, double friction_bound) {
  LoadingPatch plane;
  plane.name = "plane";
  const LatticeState rest = lattice.restState();
  std::vector<ContactSpring> springs;
  for (int i = 2; i <= 4; ++i) {
    for (int j = 2; j <= 4; ++j) {
      ContactSpring spring;
      const int node = lattice.node(i, j, 3), next = lattice.node(i + 1, j, 3);
      const double share = 0.1 * j;
      spring.carriers = {{node, 1.0 - share}, {next, share}};
      spring.rest = (1.0 - share) * lattice.restPosition(node) + share * lattice.restPosition(next);
      spring.normal = -Vec3::UnitZ();
      spring.plane_point = spring.rest + kDepth * spring.normal;
      spring.anchor = spring.rest + Vec3(1e-3, 0.0, 0.0);
      spring.stiffness = 10.0 * model.nodeStiffness(rest, node).mean();
      spring.friction_stiffness = spring.stiffness;
      spring.friction_bound = friction_bound;
      springs.push_back(spring);
    }
  }
  plane.contacts = springs;
  return plane;
}

std::vector<LoadingPatch> loadsOf(const Press& press, const Lattice& lattice,
                                  const TissueModel& model) {
  std::vector<LoadingPatch> loads;
  if (press.on_a_patch) {
    const Box box = nodeBox(configOf(press), {4, 4, 3}, {6, 6, 3});
    LoadingPatch patch = forced(lattice.nodesIn(box), Vec3(0.02, 0.0, 0.05));
    patch.turns = true;
    for (const int node : patch.nodes) patch.center += lattice.restPosition(node) / 9.0;
    loads.push_back(patch);
  }
  loads.push_back(planeOn(lattice, model, press.friction_bound));
  return loads;
}

class PressedBySprings : public ::testing::TestWithParam<Press> {
 protected:
  PressedBySprings() : exact_(configOf(GetParam())), layered_(configOf(GetParam())) {}

  std::vector<LoadingPatch> loads() const {
    return loadsOf(GetParam(), exact_.lattice, exact_.model);
  }

  ElasticBlock exact_;
  LayeredBlock layered_;
};

TEST_P(PressedBySprings, BothMethodsFindTheSameShapeAndForce) {
  const SolveReport exact = exact_.solve(loads());
  const SolveReport layered = layered_.solve(loads());
  ASSERT_EQ(exact.status, SolveStatus::kOk);
  ASSERT_EQ(layered.status, SolveStatus::kOk);
  EXPECT_LT(errorOf(exact_.lattice, {}, layered_.state.displacement, exact_.state.displacement),
            0.01);
  const Vec3 force = exact.patches.back().force;
  ASSERT_LT(force.z(), -0.05);
  EXPECT_LT((layered.patches.back().force - force).norm(), 0.01 * force.norm());
  const Vec3 torque = exact.patches.back().torque;
  EXPECT_LT((layered.patches.back().torque - torque).norm(), 0.01 * torque.norm());
}

TEST_P(PressedBySprings, ForceIsTheSumOfItsSprings) {
  const SolveReport report = exact_.solve(loads());
  const LoadingPatch plane = loads().back();
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  for (const ContactSpring& spring : plane.contacts) {
    const Vec3 each = forceOf(spring, exact_.state.displacement);
    force += each;
    torque += pointOf(spring, exact_.state.displacement).cross(each);
  }
  EXPECT_LT((report.patches.back().force - force).norm(), 1e-9 * force.norm());
  EXPECT_LT((report.patches.back().torque - torque).norm(), 1e-9 * torque.norm());
}

// Each node's weight in a spring takes its share of the spring's force.
TEST_P(PressedBySprings, EveryFreeNodeBalances) {
  const std::vector<LoadingPatch> loads_now = loads();
  exact_.solve(loads_now);
  std::vector<Vec3> forces = exact_.model.nodeForces(exact_.state);
  const double greatest = greatestForce(forces);
  addContactForces(loads_now.back(), exact_.state.displacement, forces);
  for (int node = 0; node < exact_.lattice.nodeCount(); ++node) {
    const std::vector<int>& carried = loads_now.front().nodes;
    const bool loaded = std::find(carried.begin(), carried.end(), node) != carried.end();
    if (exact_.lattice.isFixed(node) || loaded) continue;
    EXPECT_LT(forces[at(node)].norm(), 1e-6 * greatest) << "node " << node;
  }
}

TEST_P(PressedBySprings, SameSolveGivesTheSameBits) {
  ElasticBlock exact(configOf(GetParam()));
  LayeredBlock layered(configOf(GetParam()));
  exact.solve(loads());
  exact_.solve(loads());
  EXPECT_EQ(exact.state.displacement, exact_.state.displacement);
  layered.solve(loads());
  layered_.solve(loads());
  EXPECT_EQ(layered.state.displacement, layered_.state.displacement);
}

TEST_P(PressedBySprings, FixedNodesTakeWhatSpringsGive) {
  for (const std::string method : {"newton", "layered"}) {
    SolverConfig solver;
    solver.method = method;
    Tissue tissue(configOf(GetParam()), solver);
    const SolveReport report = tissue.follow(loads(), {});
    ASSERT_EQ(report.status, SolveStatus::kOk);
    Vec3 left = tissue.forceOfFixedNodes();
    for (const PatchAnswer& answer : report.patches) left += answer.force;
    const double force = report.patches.back().force.norm();
    EXPECT_LT(left.norm(), (method == "newton" ? 1e-6 : 0.02) * force) << method;
  }
}

INSTANTIATE_TEST_SUITE_P(Plane, PressedBySprings,
                         ::testing::Values(Press{"Smooth", 0.3, 0.0},
                                           Press{"SmoothAndNearlyIncompressible", 0.49, 0.0},
                                           Press{"Sticking", 0.45, 1.0},
                                           Press{"Sliding", 0.45, 2e-3},
                                           Press{"AgainstAPatchByForce", 0.45, 2e-3, true}),
                         [](const auto& row) { return row.param.name; });

// A solve that overflows, as in a jam of tools, leaves nothing behind: the next one is as of a
// method that had none.
TEST(ASolveThatOverflows, LeavesNothingBehind) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(6, 6, 4, 0.45));
  LayeredBlock fresh(config);
  const std::vector<LoadingPatch> loads = {planeOn(fresh.lattice, fresh.model, 0.01)};
  ASSERT_EQ(fresh.solve(loads).status, SolveStatus::kOk);
  for (int digits = 0; digits < 30; ++digits) {
    LayeredBlock block(config);
    const int moved = block.lattice.node(3, 3, 2);
    block.state.displacement[at(moved)] = Vec3(0.3, 0.2, 1.0) * kSpacing * std::pow(10.0, digits);
    block.solve(loads);
    block.state = block.lattice.restState();
    block.method.forget();
    EXPECT_EQ(block.solve(loads).status, SolveStatus::kOk) << digits;
    EXPECT_EQ(block.state.displacement, fresh.state.displacement) << digits;
  }
}

// Levels that are to be made anew are, also where there is no time for more.
TEST(ASolveThatOverflows, IsFollowedByOneInNoTime) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(6, 6, 4, 0.45));
  LayeredOptions hurried;
  hurried.max_ms = 1e-6;
  for (int digits = 0; digits < 30; ++digits) {
    LayeredBlock block(config, hurried);
    const std::vector<LoadingPatch> loads = {planeOn(block.lattice, block.model, 0.01)};
    const int moved = block.lattice.node(3, 3, 2);
    block.state.displacement[at(moved)] = Vec3(0.3, 0.2, 1.0) * kSpacing * std::pow(10.0, digits);
    block.solve(loads);
    block.state = block.lattice.restState();
    for (int solve = 0; solve < 2; ++solve) {
      EXPECT_EQ(block.solve(loads).status, SolveStatus::kLate) << digits;
      for (const Vec3& u : block.state.displacement) ASSERT_TRUE(u.allFinite()) << digits;
    }
  }
}

// Also a point that fixed nodes carry in part hands its share to them.
TEST(SpringOnAFixedNode, IsPartOfWhatTheFixedNodesHold) {
  SolverConfig solver;
  solver.method = "newton";
  Tissue tissue(withFixedBottom(elasticBlockOf(3, 3, 2, 0.4)), solver);
  const Lattice& lattice = tissue.lattice();
  LoadingPatch tool;
  tool.name = "tool";
  ContactSpring spring;
  spring.carriers = {{lattice.node(0, 1, 0), 0.6}, {lattice.node(0, 1, 1), 0.4}};
  spring.rest = lattice.restPosition(lattice.node(0, 1, 0)) + 0.4 * kSpacing * Vec3::UnitZ();
  spring.normal = Vec3::UnitX();
  spring.plane_point = spring.rest + 1e-3 * Vec3::UnitX();
  spring.stiffness = 100.0;
  tool.contacts = {spring};
  const SolveReport report = tissue.follow({tool}, {});
  const double force = report.patches.front().force.x();
  EXPECT_GT(force, 1e-3);
  EXPECT_LT((tissue.forceOfFixedNodes() + report.patches.front().force).norm(), 1e-6 * force);
}

}  // namespace
}  // namespace robot_tissue::test_contact_equilibrium
