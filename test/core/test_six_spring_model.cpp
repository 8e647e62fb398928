// The paper's springs: F = -k x, energy, invariances, gravity.
#include <gtest/gtest.h>

#include <cmath>

#include "block_fixtures.h"

namespace robot_tissue::test_six_spring_model {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kStiffness = 50.0;  // N/m
const Vec3 kNoGravity = Vec3::Zero();

TissueConfig softBlock(int cells_x, int cells_y, int cells_z) {
  TissueConfig config = blockOf(cells_x, cells_y, cells_z, kSpacing);
  config.material.spring_stiffness = kStiffness;
  return config;
}

// Repeatable displacements of up to `reach` along each axis, unlike for every node.
void displaceAll(LatticeState& state, double reach) {
  int step = 0;
  for (Vec3& moved : state.displacement) {
    for (int axis = 0; axis < 3; ++axis) moved[axis] = reach * std::sin(1.7 * ++step);
  }
}

double energyOf(const Lattice& lattice, const LatticeState& state) {
  double energy = 0.0;
  for (std::size_t index = 0; index < lattice.springs().size(); ++index) {
    if (state.severed[index] != 0) continue;
    const Spring& spring = lattice.springs()[index];
    const Vec3 a = lattice.restPosition(spring.a) + state.displacement[at(spring.a)];
    const Vec3 b = lattice.restPosition(spring.b) + state.displacement[at(spring.b)];
    energy +=
        0.5 * lattice.springStiffness(spring) * std::pow((b - a).norm() - lattice.spacing(), 2);
  }
  return energy;
}

// One column of nodes along z; the top of it is moved, the springs beside it stay at rest length
// to first order only, so the neighbors are moved along.
TEST(SixSpringModel, StretchedSpringPullsBackByStiffnessTimesStretch) {
  const Lattice lattice(softBlock(1, 1, 1));
  const SixSpringModel model(lattice, kNoGravity);
  for (const double stretch : {1e-3, -1e-3}) {
    LatticeState state = lattice.restState();
    for (int corner = 4; corner < 8; ++corner) state.displacement[at(corner)].z() = stretch;
    const Vec3 top = model.nodeForce(state, 4);
    const Vec3 bottom = model.nodeForce(state, 0);
    EXPECT_NEAR(top.z(), -kStiffness * stretch, 1e-12);  // stretched: down, compressed: up
    EXPECT_NEAR(bottom.z(), kStiffness * stretch, 1e-12);
    EXPECT_NEAR(top.head<2>().norm(), 0.0, 1e-15);
  }
}

TEST(SixSpringModel, ForceIsTheNegativeGradientOfTheEnergy) {
  const Lattice lattice(softBlock(2, 2, 2));
  const SixSpringModel model(lattice, kNoGravity);
  LatticeState state = lattice.restState();
  displaceAll(state, 0.3 * kSpacing);
  state.severed[5] = 1;
  const double step = 1e-7;
  double gradient_squared = 0.0;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 force = model.nodeForce(state, node);
    for (int axis = 0; axis < 3; ++axis) {
      double& coordinate = state.displacement[at(node)][axis];
      const double here = coordinate;
      coordinate = here + step;
      const double above = energyOf(lattice, state);
      coordinate = here - step;
      const double below = energyOf(lattice, state);
      coordinate = here;
      const double slope = (above - below) / (2.0 * step);
      gradient_squared += slope * slope;
      EXPECT_NEAR(force[axis], -slope, 1e-7);
    }
  }
  EXPECT_GT(std::sqrt(gradient_squared), 0.1);  // N; else nothing was compared
}

TEST(SixSpringModel, StiffnessIsTheSlopeOfTheForceAtRest) {
  const Lattice lattice(blockOf(2, 3, 2));
  const SixSpringModel model(lattice, kNoGravity);
  LatticeState state = lattice.restState();
  state.severed[7] = 1;
  const double step = 1e-8;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 stiffness = model.nodeStiffness(state, node);
    for (int axis = 0; axis < 3; ++axis) {
      state.displacement[at(node)][axis] = step;
      EXPECT_NEAR(model.nodeForce(state, node)[axis], -stiffness[axis] * step,
                  1e-4 * stiffness.maxCoeff() * step);
      state.displacement[at(node)].setZero();
    }
  }
}

TEST(SixSpringModel, InternalForcesSumToZero) {
  const Lattice lattice(softBlock(3, 2, 4));
  const SixSpringModel model(lattice, kNoGravity);
  LatticeState state = lattice.restState();
  displaceAll(state, 0.4 * kSpacing);
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  double greatest = 0.0;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 force = model.nodeForce(state, node);
    sum += force;
    torque += (lattice.restPosition(node) + state.displacement[at(node)]).cross(force);
    greatest = std::max(greatest, force.norm());
  }
  EXPECT_GT(greatest, 0.1);
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_LT(torque.norm(), 1e-13);
}

TEST(SixSpringModel, RigidMotionMeetsNoForce) {
  const Lattice lattice(softBlock(2, 2, 3));
  const SixSpringModel model(lattice, kNoGravity);
  LatticeState state = lattice.restState();
  Pose motion = Pose::Identity();
  motion.linear() = Eigen::AngleAxisd(2.1, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  motion.translation() = Vec3(0.3, -0.2, 0.1);
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 rest = lattice.restPosition(node);
    state.displacement[at(node)] = motion * rest - rest;
  }
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    EXPECT_LT(model.nodeForce(state, node).norm(), 1e-12);
  }
}

TEST(SixSpringModel, CoincidentNodesArePushedApartByFiniteForces) {
  const Lattice lattice(softBlock(1, 1, 2));
  const SixSpringModel model(lattice, kNoGravity);
  LatticeState state = lattice.restState();
  const int lower = lattice.node(0, 0, 1), upper = lattice.node(0, 0, 2);
  state.displacement[at(upper)].z() =
      lattice.restPosition(lower).z() - lattice.restPosition(upper).z();
  ASSERT_EQ(lattice.restPosition(lower),
            lattice.restPosition(upper) + state.displacement[at(upper)]);
  for (const int node : {lower, upper}) EXPECT_TRUE(model.nodeForce(state, node).allFinite());
  // Of the collapsed spring alone: k L, along its rest direction. The upper node has no other
  // spring along z.
  EXPECT_NEAR(model.nodeForce(state, lower).z(), -kStiffness * kSpacing, 1e-12);
  EXPECT_GT(model.nodeForce(state, upper).z(), 0.5 * kStiffness * kSpacing);
}

TEST(SixSpringModel, SeveredSpringGivesNoForce) {
  const Lattice lattice(softBlock(1, 1, 1));
  const SixSpringModel model(lattice, kNoGravity);
  LatticeState state = lattice.restState();
  for (int corner = 4; corner < 8; ++corner) state.displacement[at(corner)].z() = 1e-3;
  ASSERT_GT(model.nodeForce(state, 4).norm(), 0.0);
  state.severed[at(lattice.springOf(0, 5))] = 1;
  EXPECT_TRUE(model.nodeForce(state, 4).isZero(0.0));
  EXPECT_TRUE(model.nodeForce(state, 0).isZero(0.0));
  EXPECT_GT(model.nodeForce(state, 5).norm(), 0.0);
  EXPECT_EQ(model.nodeStiffness(state, 4).z(), 0.0);
}

TEST(SixSpringModel, GravityAddsTheNodesWeight) {
  const Lattice lattice(softBlock(2, 2, 2));
  const Vec3 gravity(0.5, -1.0, -9.81);
  const SixSpringModel model(lattice, gravity);
  const SixSpringModel weightless(lattice, kNoGravity);
  LatticeState state = lattice.restState();
  displaceAll(state, 0.2 * kSpacing);
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 added = model.nodeForce(state, node) - weightless.nodeForce(state, node);
    EXPECT_LT((added - lattice.mass(node) * gravity).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace robot_tissue::test_six_spring_model
