// The spring of a point in contact: its force and stiffness come from one convex energy, it never
// pulls, and its drag has a bound.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <string>

#include "elastic_fixtures.h"
#include "robot_tissue/core/contact_spring.h"

namespace robot_tissue::test_contact_spring {
namespace {

constexpr double kStiffness = 50.0;      // N/m
constexpr double kDragStiffness = 30.0;  // N/m

struct Case {
  std::string name;
  double gap = 0.0;             // m
  double slip = 0.0;            // m, from the anchor
  double multiplier = 0.0;      // N
  double friction_bound = 0.0;  // N
  double friction_force = 0.0;  // N, at the anchor
};

// Three nodes carry the point; the plane slants.
class SpringInContact : public ::testing::TestWithParam<Case> {
 protected:
  SpringInContact() {
    const Case& given = GetParam();
    spring_.carriers = {{0, 0.2}, {2, 0.5}, {3, 0.3}};
    spring_.rest = Vec3(0.01, 0.02, 0.03);
    spring_.normal = Vec3(0.6, 0.0, -0.8);
    spring_.stiffness = kStiffness;
    spring_.multiplier = given.multiplier;
    spring_.friction_stiffness = kDragStiffness;
    spring_.friction_bound = given.friction_bound;
    spring_.friction_force = given.friction_force * Vec3(0.8, 0.0, 0.6);
    displacement_ = {Vec3(1e-3, 2e-3, -1e-3), Vec3(5.0, 6.0, 7.0), Vec3(-2e-3, 1e-3, 1e-3),
                     Vec3(3e-3, -1e-3, 2e-3)};
    const Vec3 point = pointOf(spring_, displacement_);
    spring_.plane_point = point - given.gap * spring_.normal + 0.01 * Vec3::UnitY();
    spring_.anchor = point - given.slip * Vec3(0.48, 0.8, 0.36) + 0.02 * spring_.normal;
  }

  // The point goes there when every node does.
  std::vector<Vec3> movedBy(const Vec3& motion) const {
    std::vector<Vec3> moved = displacement_;
    for (Vec3& displacement : moved) displacement += motion;
    return moved;
  }
  Vec3 dragOf(const std::vector<Vec3>& displacement) const {
    return forceOf(spring_, displacement) - normalForceOf(spring_, displacement) * spring_.normal;
  }

  ContactSpring spring_;
  std::vector<Vec3> displacement_;
};

// Shown in the tool's plane and drawn at its edge: that moves no node and pushes nothing.
TEST_P(SpringInContact, IsDrawnAside) {
  const Vec3 force = forceOf(spring_, displacement_);
  EXPECT_TRUE(drawnOff(spring_, displacement_).isZero(0.0));
  spring_.shown_compliance = spring_.drawn_compliance = 0.01;
  const Vec3 pressed = 0.01 * normalForceOf(spring_, displacement_) * spring_.normal;
  EXPECT_LT((shownOff(spring_, displacement_) - pressed).norm(), 1e-15);
  const Vec3 along(0.0, 1.0, 0.0), edge = pointOf(spring_, displacement_) + 0.002 * along;
  spring_.drawn_aside = along * along.transpose();
  spring_.drawn_at = edge + 0.001 * spring_.normal;  // along the normal it stays
  EXPECT_LT((drawnOff(spring_, displacement_) - pressed - 0.002 * along).norm(), 1e-15);
  EXPECT_LT((shownOff(spring_, displacement_) - pressed).norm(), 1e-15);
  EXPECT_EQ(forceOf(spring_, displacement_), force);
}

TEST_P(SpringInContact, GapIsThatOfItsPoint) {
  const Vec3 point =
      spring_.rest + 0.2 * displacement_[0] + 0.5 * displacement_[2] + 0.3 * displacement_[3];
  EXPECT_LT((pointOf(spring_, displacement_) - point).norm(), 1e-15);
  EXPECT_NEAR(gapOf(spring_, displacement_), GetParam().gap, 1e-15);
  EXPECT_NEAR(gapOf(spring_, movedBy(1e-3 * spring_.normal)), GetParam().gap + 1e-3, 1e-15);
}

TEST_P(SpringInContact, NormalForceNeverPulls) {
  const double wanted = std::max(0.0, GetParam().multiplier - kStiffness * GetParam().gap);
  EXPECT_NEAR(normalForceOf(spring_, displacement_), wanted, 1e-12);
  for (double away = -0.02; away <= 0.02; away += 0.001) {
    EXPECT_GE(forceOf(spring_, movedBy(away * spring_.normal)).dot(spring_.normal), -1e-15);
  }
}

TEST_P(SpringInContact, DragLiesAcrossTheNormalAndIsNeverLongerThanItsBound) {
  Shaker shaker(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 drag = dragOf(movedBy(shaker.displacement(0.02)));
    EXPECT_NEAR(drag.dot(spring_.normal), 0.0, 1e-15);
    EXPECT_LE(drag.norm(), spring_.friction_bound + 1e-15);
  }
}

TEST_P(SpringInContact, DragHoldsThePointBackFromItsSlip) {
  const Vec3 across(0.48, 0.8, 0.36);
  const double before = dragOf(movedBy(-1e-3 * across)).dot(across);
  const double after = dragOf(movedBy(1e-3 * across)).dot(across);
  EXPECT_LE(after, before + 1e-12);
  EXPECT_LT((dragOf(movedBy(1e-3 * spring_.normal)) - dragOf(displacement_)).norm(), 1e-15);
}

TEST_P(SpringInContact, ForceIsMinusTheEnergysSlope) {
  constexpr double kDifference = 1e-7;
  const Vec3 force = forceOf(spring_, displacement_);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = kDifference * Vec3::Unit(axis);
    const double slope = (energyOf(spring_, movedBy(step)) - energyOf(spring_, movedBy(-step))) /
                         (2.0 * kDifference);
    EXPECT_NEAR(force[axis], -slope, 1e-7);
  }
}

// As where rims bear all of a touch.
TEST_P(SpringInContact, ForceIsMinusTheEnergysSlopeAlsoWithoutStiffness) {
  constexpr double kDifference = 1e-7;
  spring_.stiffness = spring_.friction_stiffness = 0.0;
  const Vec3 force = forceOf(spring_, displacement_);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = kDifference * Vec3::Unit(axis);
    const double slope = (energyOf(spring_, movedBy(step)) - energyOf(spring_, movedBy(-step))) /
                         (2.0 * kDifference);
    EXPECT_NEAR(force[axis], -slope, 1e-7);
  }
}

TEST_P(SpringInContact, ForceOnTheNodesIsMinusTheEnergysSlope) {
  constexpr double kDifference = 1e-7;
  LoadingPatch patch;
  patch.contacts = {spring_, spring_};
  std::vector<Vec3> forces(displacement_.size(), Vec3::Zero());
  addContactForces(patch, displacement_, forces);
  EXPECT_EQ(forces[1], Vec3::Zero());  // it carries no share of the point
  for (std::size_t node = 0; node < forces.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<Vec3> before = displacement_, after = displacement_;
      before[node][axis] -= kDifference;
      after[node][axis] += kDifference;
      const double slope =
          (contactEnergy(patch, after) - contactEnergy(patch, before)) / (2.0 * kDifference);
      EXPECT_NEAR(forces[node][axis], -slope, 2e-7);
    }
  }
}

TEST_P(SpringInContact, StiffnessIsMinusTheForcesSlope) {
  constexpr double kDifference = 1e-7;
  const Eigen::Matrix3d stiffness = stiffnessOf(spring_, displacement_);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = kDifference * Vec3::Unit(axis);
    const Vec3 slope =
        (forceOf(spring_, movedBy(step)) - forceOf(spring_, movedBy(-step))) / (2.0 * kDifference);
    EXPECT_LT((stiffness.col(axis) + slope).norm(), 1e-5 * kStiffness);
  }
}

// What holds a point back from where its normal was looked for is part of the energy.
TEST_P(SpringInContact, TurningHoldsBackByItsStiffness) {
  constexpr double kDifference = 1e-7;
  const ContactSpring fixed = spring_;
  spring_.turning = Vec3(20.0, 5.0, 0.0).asDiagonal();
  spring_.turned_from = pointOf(spring_, displacement_) - Vec3(2e-3, 1e-3, 4e-3);
  EXPECT_LT((turningForceOf(spring_, displacement_) - Vec3(-0.04, -0.005, 0.0)).norm(), 1e-12);
  const Vec3 force = forceOf(spring_, displacement_);
  EXPECT_LT((force - forceOf(fixed, displacement_) - Vec3(-0.04, -0.005, 0.0)).norm(), 1e-12);
  const Eigen::Matrix3d stiffer =
      stiffnessOf(spring_, displacement_) - stiffnessOf(fixed, displacement_);
  EXPECT_LT((stiffer - spring_.turning).norm(), 1e-12);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = kDifference * Vec3::Unit(axis);
    const double slope = (energyOf(spring_, movedBy(step)) - energyOf(spring_, movedBy(-step))) /
                         (2.0 * kDifference);
    EXPECT_NEAR(force[axis], -slope, 1e-7);
  }
}

TEST_P(SpringInContact, EnergyIsConvex) {
  Shaker shaker(5);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<Vec3> a = movedBy(shaker.displacement(0.01));
    const std::vector<Vec3> b = movedBy(shaker.displacement(0.01));
    const Eigen::Matrix3d stiffness = stiffnessOf(spring_, a);
    EXPECT_LT((stiffness - stiffness.transpose()).norm(), 1e-12 * kStiffness);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(stiffness);
    EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-12 * kStiffness);
    std::vector<Vec3> middle = a;
    for (std::size_t node = 0; node < middle.size(); ++node)
      middle[node] = 0.5 * (a[node] + b[node]);
    EXPECT_LE(energyOf(spring_, middle),
              0.5 * (energyOf(spring_, a) + energyOf(spring_, b)) + 1e-15);
    EXPECT_GE(energyOf(spring_, a), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    State, SpringInContact,
    ::testing::Values(Case{"Open", 2e-3, 0.0, 0.0, 0.0, 0.0},
                      Case{"PressedWithoutFriction", -2e-3, 1e-3, 0.0, 0.0, 0.0},
                      Case{"Stuck", -2e-3, 1e-3, 0.0, 0.05, 0.0},
                      Case{"StuckWithDrag", -2e-3, 1e-3, 0.0, 0.08, -0.04},
                      Case{"Sliding", -2e-3, 6e-3, 0.0, 0.05, 0.0},
                      Case{"SlidingWithDrag", -2e-3, 6e-3, 0.0, 0.05, 0.04},
                      Case{"WithMultiplier", 1e-3, 1e-3, 0.2, 0.06, 0.01},
                      Case{"OpenInSpiteOfMultiplier", 6e-3, 1e-3, 0.2, 0.06, 0.01}),
    [](const auto& row) { return row.param.name; });

// At the gap where the force begins, and at the slip where the point begins to slide.
TEST(ContactSpringsKinks, EnergyAndForceAreContinuous) {
  ContactSpring spring;
  spring.carriers = {{0, 1.0}};
  spring.normal = Vec3::UnitZ();
  spring.stiffness = kStiffness;
  spring.multiplier = 0.1;
  spring.friction_stiffness = kDragStiffness;
  spring.friction_bound = 0.06;
  const double opens = 0.1 / kStiffness, slides = 0.06 / kDragStiffness;
  constexpr double kHair = 1e-9;
  for (const auto& [kink, way] : {std::pair<Vec3, Vec3>{{0.5e-3, 0.0, opens}, Vec3::UnitZ()},
                                  std::pair<Vec3, Vec3>{{slides, 0.0, -1e-3}, Vec3::UnitX()}}) {
    const std::vector<Vec3> before = {kink - kHair * way}, after = {kink + kHair * way};
    EXPECT_NEAR(energyOf(spring, before), energyOf(spring, after), 1e-9);
    EXPECT_LT((forceOf(spring, before) - forceOf(spring, after)).norm(), 1e-6);
    const Eigen::Matrix3d jump = stiffnessOf(spring, before) - stiffnessOf(spring, after);
    EXPECT_GT(jump.norm(), 1.0);  // or it is no kink
  }
}

TEST(ContactSpring, WithoutMultiplierStandsWhereItsPointIsOnThePlane) {
  ContactSpring spring;
  spring.carriers = {{0, 1.0}};
  spring.normal = Vec3::UnitZ();
  spring.stiffness = kStiffness;
  EXPECT_EQ(forceOf(spring, {Vec3::Zero()}), Vec3::Zero());
  EXPECT_EQ(energyOf(spring, {Vec3::Zero()}), 0.0);
  EXPECT_NEAR(forceOf(spring, {Vec3(0.0, 0.0, -1e-3)}).z(), 1e-3 * kStiffness, 1e-15);
  EXPECT_NEAR(energyOf(spring, {Vec3(0.0, 0.0, -1e-3)}), 0.5e-6 * kStiffness, 1e-15);
}

TEST(ContactSprings, CopiesHaveTheSameSpringsAlsoWhenTheFirstIsGone) {
  LoadingPatch kept;
  EXPECT_TRUE(kept.contacts.empty());
  EXPECT_EQ(kept.contacts.begin(), kept.contacts.end());
  const ContactSpring* first = nullptr;
  {
    LoadingPatch patch;
    ContactSpring spring;
    spring.multiplier = 2.0;
    patch.contacts = {ContactSpring(), spring};
    first = patch.contacts.begin();
    kept = patch;
    patch.contacts = {};
  }
  ASSERT_EQ(kept.contacts.size(), 2U);
  EXPECT_EQ(kept.contacts.begin(), first);
  EXPECT_EQ(kept.contacts[1].multiplier, 2.0);
}

}  // namespace
}  // namespace robot_tissue::test_contact_spring
