// Potential, unbalanced forces and second derivative of a loaded shape agree by differences.
#include <gtest/gtest.h>

#include <string>

#include "elastic_fixtures.h"
#include "loads/patch_rim.h"
#include "solvers/newton/equilibrium.h"

namespace robot_tissue::test_equilibrium {
namespace {

constexpr double kSpacing = 0.01;

struct Loads {
  std::string name;
  bool turns = false;
  bool contacts = false;          // springs in contact beside the patch
  bool contact_on_patch = false;  // one of them on a node that is hard in it
};

// A shaken block with a patch of 3 x 3 nodes on top that was pushed and turned.
class ShakenBlock : public ::testing::TestWithParam<Loads> {
 protected:
  ShakenBlock()
      : lattice_(withFixedBottom(elasticBlockOf(4, 4, 2, 0.4))), model_(lattice_, config()) {
    shape_.state = lattice_.restState();
    LoadingPatch patch = forced(lattice_.nodesIn(box()), Vec3(0.01, -0.02, -0.1));
    patch.turns = GetParam().turns;
    if (!GetParam().contact_on_patch) {  // or only its middle node is hard
      patch.rim = rimOf(lattice_, model_, shape_.state, box(), patch.nodes);
    }
    for (const int node : patch.nodes) patch.center += lattice_.restPosition(node) / 9.0;
    shape_.patches.push_back(patch);
    const DofMap unknowns(lattice_, model_, shape_);
    for (int node = 0; node < lattice_.nodeCount(); ++node) {
      if (!lattice_.isFixed(node))
        shape_.state.displacement[at(node)] = shaker_.displacement(0.1 * kSpacing);
    }
    movePatch(lattice_, shape_.patches.front(), Vec3(0.1, 0.2, -0.3) * kSpacing,
              GetParam().turns ? Vec3(0.2, -0.1, 0.3) : Vec3(0.0, 0.0, 0.0), shape_.state);
    if (GetParam().contacts) touch();
  }

  // Springs at points of the side x = 0, with one fixed carrier each: stuck, sliding and open.
  void touch() {
    LoadingPatch tool;
    tool.name = "tool";
    std::vector<ContactSpring> springs;
    for (int j = 0; j < 4; ++j) {
      springs.push_back(springAt({{lattice_.node(0, j, 0), 0.2},
                                  {lattice_.node(0, j, 1), 0.3},
                                  {lattice_.node(0, j + 1, 2), 0.5}},
                                 j == 3 ? 2e-3 : -1e-3));
      springs.back().friction_bound = 0.1 * j;
      springs.back().multiplier = 0.01 * j;
    }
    if (GetParam().contact_on_patch) {
      springs.push_back(
          springAt({{lattice_.node(3, 1, 2), 0.6}, {lattice_.node(3, 0, 2), 0.4}}, -4e-3));
    }
    tool.contacts = springs;
    shape_.patches.push_back(tool);
  }

  ContactSpring springAt(const std::vector<NodeWeight>& carriers, double gap) const {
    ContactSpring spring;
    spring.carriers = carriers;
    for (const NodeWeight& carrier : carriers) {
      spring.rest += carrier.weight * lattice_.restPosition(carrier.node);
    }
    spring.normal = Vec3(0.8, 0.36, -0.48);
    const Vec3 point = pointOf(spring, shape_.state.displacement);
    spring.plane_point = point - gap * spring.normal;
    spring.stiffness = 200.0;
    spring.friction_stiffness = 100.0;
    spring.anchor = point + Vec3(-1e-3, 1e-3, 1e-3);
    return spring;
  }

  static TissueConfig config() { return withFixedBottom(elasticBlockOf(4, 4, 2, 0.4)); }
  static Box box() { return {Vec3(0.009, 0.01, 0.02), Vec3(0.033, 0.03, 0.02)}; }

  ConstrainedState movedBy(const DofMap& unknowns, const Eigen::VectorXd& step,
                           double share) const {
    ConstrainedState moved = shape_;
    unknowns.move(moved, step, share);
    return moved;
  }

  Eigen::VectorXd anyStep(const DofMap& unknowns) {
    Eigen::VectorXd step(unknowns.count());
    for (int i = 0; i < step.size(); ++i) step[i] = shaker_.displacement(1.0).x();
    return step;
  }

  Lattice lattice_;
  ElasticModel model_;
  ConstrainedState shape_;
  Shaker shaker_{7};
};

TEST_P(ShakenBlock, UnbalancedForceIsThePotentialsSlope) {
  const DofMap unknowns(lattice_, model_, shape_);
  const Eigen::VectorXd unbalanced = balanceOf(model_, unknowns, shape_).unbalanced;
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::VectorXd step = anyStep(unknowns);
    constexpr double kDifference = 1e-7;
    const double slope = (potentialOf(model_, movedBy(unknowns, step, kDifference)) -
                          potentialOf(model_, movedBy(unknowns, step, -kDifference))) /
                         (2.0 * kDifference);
    EXPECT_NEAR(-unbalanced.dot(step), slope, 1e-5 * unbalanced.norm() * step.norm());
  }
}

TEST_P(ShakenBlock, MatrixIsTheUnbalancedForcesSlope) {
  const DofMap unknowns(lattice_, model_, shape_);
  const std::vector<Vec3> unmoved(shape_.state.displacement.size(), Vec3::Zero());
  const TangentStiffness curvature = tangentStiffnessOf(model_, unknowns, shape_, unmoved, false);
  const Eigen::MatrixXd lower(curvature.matrix);
  const Eigen::MatrixXd matrix = lower.selfadjointView<Eigen::Lower>();
  for (int trial = 0; trial < 5; ++trial) {
    // Along one straight step, as turns in a row do not commute.
    const Eigen::VectorXd step = anyStep(unknowns);
    constexpr double kDifference = 1e-6;
    const double before = potentialOf(model_, movedBy(unknowns, step, -kDifference));
    const double middle = potentialOf(model_, shape_);
    const double after = potentialOf(model_, movedBy(unknowns, step, kDifference));
    const double second = (after - 2.0 * middle + before) / (kDifference * kDifference);
    EXPECT_NEAR(step.dot(matrix * step), second, 1e-3 * std::abs(second));
  }
}

INSTANTIATE_TEST_SUITE_P(Patch, ShakenBlock,
                         ::testing::Values(Loads{"Straight"}, Loads{"Turning", true},
                                           Loads{"StraightWithContacts", false, true},
                                           Loads{"TurningWithContacts", true, true},
                                           Loads{"StraightInContact", false, true, true},
                                           Loads{"TurningInContact", true, true, true}),
                         [](const auto& row) { return row.param.name; });

}  // namespace
}  // namespace robot_tissue::test_equilibrium
