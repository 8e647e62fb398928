// Contacts -> springs in contact: a plane pressed on an elastic block, its contacts made by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/tissue_fixtures.h"
#include "robot_tissue/coupling/sliding_contacts.h"

namespace robot_tissue::test_sliding_contacts {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kNear = 0.25 * kSpacing;
constexpr double kThick = 1.0;                // of the plane (m)
constexpr double kSettled = 0.06 * kSpacing;  // a gap that is none

TissueConfig softBlock() {
  TissueConfig config = withFixedBottom(blockOf(4, 4, 3, kSpacing));
  config.model = "elastic";
  config.material.poisson_ratio = 0.4;
  return config;
}

// Tool 0, link 0: solid above the plane through its origin. `patch` as the pipeline makes it.
class PlaneOnABlock : public ::testing::Test, public ContactUpdate {
 protected:
  PlaneOnABlock() { make(0.0); }

  // No friction: the tissue sticks to it. Of two tools the other one is elsewhere.
  void make(std::optional<double> friction) {
    contacts_ = SlidingContacts({friction, 0.0}, {{{kThick}, is_uneven_, {}}});
    SolverConfig solver;
    solver.method = "newton";
    tissue_ = std::make_unique<Tissue>(softBlock(), solver);
    tissue_->setContactUpdate(this);
    held_.assign(at(tissue_->lattice().nodeCount()), 0);
    for (int node = 0; node < tissue_->lattice().nodeCount(); ++node) {
      held_[at(node)] = tissue_->lattice().isFixed(node) ? 1 : 0;
    }
    goTo(Vec3(0.02, 0.02, 0.03 + 0.02));
  }

  void goTo(const Vec3& origin, double tilt = 0.0) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(tilt, Vec3::UnitY()).toRotationMatrix();
    pose.translation() = origin;
    pose_.links = {pose};
  }

  Vec3 normal() const { return -pose_.links[0].linear().col(2); }
  double depthOf(const Vec3& point) const {
    return -normal().dot(point - pose_.links[0].translation());
  }

  // Of vertices, each found once.
  virtual ContactSet contacts() const {
    ContactSet set;
    const TissueSurface& surface = tissue_->surface();
    std::vector<char> seen(surface.rest.size(), 0);
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        const int vertex = surface.triangles[i][at(corner)];
        const Vec3 point = tissue_->vertices()[at(vertex)];
        if (seen[at(vertex)] != 0 || depthOf(point) <= -kNear) continue;
        seen[at(vertex)] = 1;
        set.contacts.push_back({0,
                                0,
                                0,
                                {static_cast<int>(i), Vec3::Unit(corner)},
                                point,
                                normal(),
                                depthOf(point),
                                {},
                                {}});
      }
    }
    return set;
  }

  std::vector<std::optional<Contact>> tracked() const {
    std::vector<std::optional<Contact>> tracked;
    for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
      Contact contact = touch.contact;
      contact.point = pointOf(touch.spring, tissue_->state().displacement);
      contact.normal = normal();
      contact.depth_m = depthOf(contact.point);
      tracked.push_back(contact);
    }
    return tracked;
  }

  LoadingPatch patch() const {
    LoadingPatch patch;
    patch.name = "plane";
    patch.contacts = contacts_.springsOf(0);
    return patch;
  }

  std::vector<double> longestWays() override { return {}; }
  double shareOfWay(const std::vector<Vec3>&) override { return 1.0; }
  bool renew(std::vector<LoadingPatch>& patches, Shape shape, Round round) override {
    ++rounds_;
    const bool settled = contacts_.update(tracked(), contacts(), pose_, *tissue_, held_, shape);
    if (settled || round == Round::kLast) return false;
    patches = {patch()};
    return true;
  }

  // One load step to where the plane is now.
  void follow() {
    contacts_.ride(pose_, *tissue_);
    contacts_.meet(contacts(), pose_, *tissue_, held_);
    rounds_ = 0;
    report_ = tissue_->follow({patch()}, {}, Bedding::kSupports);
    contacts_.commit(pose_, *tissue_);
  }

  void press(double depth, double step = 5e-4) {
    for (double gone = step; gone < depth + 1e-9; gone += step) {
      goTo(Vec3(0.02, 0.02, 0.03 - gone));
      follow();
    }
  }
  void drag(const Vec3& way, int steps) {
    const Vec3 from = pose_.links[0].translation();
    for (int i = 1; i <= steps; ++i) {
      goTo(from + way * i / steps);
      follow();
    }
  }

  Vec3 dragOf(const SlidingContacts::ContactConstraint& touch) const {
    const auto& displacement = tissue_->state().displacement;
    const ContactSpring& spring = touch.spring;
    return forceOf(spring, displacement) - normalForceOf(spring, displacement) * spring.normal;
  }
  double normalForce(const SlidingContacts::ContactConstraint& touch) const {
    return normalForceOf(touch.spring, tissue_->state().displacement);
  }
  Vec3 force() const { return report_.patches.back().force; }

  SlidingContacts contacts_{{}, {}};
  std::unique_ptr<Tissue> tissue_;
  RobotPose pose_;
  std::vector<std::uint8_t> held_;
  SolveReport report_;
  int rounds_ = 0;
  bool is_uneven_ = false;
};

// The link presses one triangle by two points at the plane's height; found is the deeper one.
class TwoBumpsOnABlock : public PlaneOnABlock {
 protected:
  TwoBumpsOnABlock() { make(0.0); }

  ContactSet contacts() const override {
    const Contact a = bump(Vec3(0.45, 0.35, 0.2)), b = bump(Vec3(0.25, 0.35, 0.4));
    return {{a.depth_m > b.depth_m ? a : b}};
  }
  Contact bump(const Vec3& weights) const {
    const TissueSurface& surface = tissue_->surface();
    int top = 0;
    while (middleAtRest(surface.triangles[at(top)]).z() < 0.03 - 1e-9) ++top;
    const SurfacePoint place{top, weights};
    const Corners corners = cornersOf(surface.triangles[at(top)], tissue_->vertices());
    const Vec3 point = pointOf(corners, weights);
    return {0, 0, 0, place, point, normal(), depthOf(point), {}, {}};
  }
  Vec3 middleAtRest(const MeshTriangle& triangle) const {
    return pointOf(cornersOf(triangle, tissue_->surface().rest), Vec3::Constant(1.0 / 3.0));
  }
  static Corners cornersOf(const MeshTriangle& triangle, const std::vector<Vec3>& vertices) {
    return {vertices[at(triangle[0])], vertices[at(triangle[1])], vertices[at(triangle[2])]};
  }
};

TEST_F(PlaneOnABlock, FarAwayItTouchesNothing) {
  contacts_.ride(pose_, *tissue_);
  contacts_.meet(contacts(), pose_, *tissue_, held_);
  EXPECT_TRUE(contacts_.touches().empty());
  EXPECT_FALSE(contacts_.pushes(0, *tissue_));
  EXPECT_TRUE(contacts_.springsOf(0).empty());
}

TEST_F(PlaneOnABlock, EveryVertexUnderItBecomesOneTouch) {
  goTo(Vec3(0.02, 0.02, 0.03 - 5e-4));
  contacts_.ride(pose_, *tissue_);
  for (int time = 0; time < 2; ++time) {
    contacts_.meet(contacts(), pose_, *tissue_, held_);
    ASSERT_EQ(contacts_.touches().size(), 25u);
  }
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    EXPECT_GE(touch.vertex, 0);
    EXPECT_NEAR(gapOf(touch.spring, tissue_->state().displacement), -5e-4, 1e-15);
    EXPECT_LT((touch.spring.normal + Vec3::UnitZ()).norm(), 1e-15);
    EXPECT_GT(touch.spring.stiffness, 0.0);
    EXPECT_EQ(dragOf(touch), Vec3::Zero());
  }
}

TEST_F(PlaneOnABlock, MultipliersTakeTheGapsToZero) {
  press(2e-3);
  EXPECT_EQ(report_.status, SolveStatus::kOk);
  double greatest = 0.0;
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    EXPECT_GT(normalForce(touch), 0.0);
    greatest = std::max(greatest, std::abs(gapOf(touch.spring, tissue_->state().displacement)));
  }
  EXPECT_LT(greatest, kSettled);
  for (int time = 0; time < 4; ++time) follow();  // the plane stands
  greatest = 0.0;
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    greatest = std::max(greatest, std::abs(gapOf(touch.spring, tissue_->state().displacement)));
  }
  EXPECT_LT(greatest, 0.1 * kSettled);
}

// A frictionless plate on the whole top: the block is held at its bottom and so is stiffer than
// E A / L, but not by the factor of one that cannot widen at all.
TEST_F(PlaneOnABlock, ForceIsThatOfAPressedBlock) {
  press(1e-3);
  const double free = 1e4 * 0.04 * 0.04 * 1e-3 / 0.03;
  const double confined = free * (1.0 - 0.4) / ((1.0 + 0.4) * (1.0 - 2.0 * 0.4));
  EXPECT_GT(-force().z(), free);
  EXPECT_LT(-force().z(), confined);
  EXPECT_LT(force().head<2>().norm(), 1e-6 * -force().z());
  EXPECT_LT((force() + tissue_->forceOfFixedNodes()).norm(), 1e-6 * force().norm());
}

TEST_F(PlaneOnABlock, TouchesRideWithTheLink) {
  press(1e-3);
  const std::vector<SlidingContacts::ContactConstraint> before = contacts_.touches();
  const Pose from = pose_.links[0];
  goTo(Vec3(0.023, 0.019, 0.0285), 0.1);
  const Pose motion = pose_.links[0] * from.inverse();
  for (int time = 0; time < 2; ++time) {
    SlidingContacts riding = contacts_;
    riding.ride(pose_, *tissue_);
    ASSERT_EQ(riding.touches().size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const ContactSpring& spring = riding.touches()[i].spring;
      EXPECT_LT((spring.plane_point - motion * before[i].spring.plane_point).norm(), 1e-12);
      EXPECT_LT((spring.normal - motion.linear() * before[i].spring.normal).norm(), 1e-12);
      const Vec3 stuck = pointOf(before[i].spring, tissue_->state().displacement);
      EXPECT_LT((spring.anchor - motion * stuck).norm(), 1e-12);
    }
  }
}

// On the way of a slip no solve is whole, but what goes into the link meets more and more force.
TEST_F(PlaneOnABlock, WhatGoesIntoItOnTheWayIsPressedOut) {
  press(0.002);
  const ContactSprings before = contacts_.springsOf(0);
  goTo(pose_.links[0].translation() - Vec3(0.0, 0.0, 0.001));
  contacts_.update(tracked(), contacts(), pose_, *tissue_, held_, Shape::kOnItsWay);
  const ContactSprings deeper = contacts_.springsOf(0);
  contacts_.update(tracked(), contacts(), pose_, *tissue_, held_, Shape::kOnItsWay);
  const ContactSprings still_deeper = contacts_.springsOf(0);
  goTo(pose_.links[0].translation() + Vec3(0.0, 0.0, 0.003));
  contacts_.update(tracked(), contacts(), pose_, *tissue_, held_, Shape::kOnItsWay);
  const ContactSprings off = contacts_.springsOf(0);
  contacts_.update(tracked(), contacts(), pose_, *tissue_, held_, Shape::kOnItsWay);
  const ContactSprings still_off = contacts_.springsOf(0);
  ASSERT_EQ(before.size(), still_off.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_GE(deeper[i].multiplier, before[i].multiplier);
    EXPECT_GT(still_deeper[i].multiplier, deeper[i].multiplier);
    EXPECT_EQ(still_off[i].multiplier, off[i].multiplier);
  }
}

TEST_F(PlaneOnABlock, ForgetsTouchesThatItHasLeft) {
  press(1e-3);
  ASSERT_EQ(contacts_.touches().size(), 25u);
  goTo(Vec3(0.02, 0.02, 0.03 + 0.02));
  follow();
  EXPECT_TRUE(contacts_.touches().empty());
  EXPECT_LT(force().norm(), 1e-9);
}

// The plane turns about the block's middle until one edge is off it.
TEST_F(PlaneOnABlock, ForgetsTouchesOnTheSideThatLiftsOff) {
  press(5e-4);
  for (int i = 1; i <= 8; ++i) {
    goTo(Vec3(0.02, 0.02, 0.03 - 5e-4), 0.04 * i);
    follow();
  }
  ASSERT_FALSE(contacts_.touches().empty());
  EXPECT_LT(contacts_.touches().size(), 25u);
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    const double gap = gapOf(touch.spring, tissue_->state().displacement);
    EXPECT_GT(gap, -kSettled);
    EXPECT_LT(gap, 0.31 * kSpacing);
    EXPECT_TRUE(gap <= kSettled || normalForce(touch) == 0.0);
  }
}

TEST_F(PlaneOnABlock, ItsNormalForceNeverPulls) {
  press(1e-3);
  for (int i = 0; i < 6; ++i) {
    goTo(Vec3(0.02, 0.02, 0.029 + 3e-4 * i));
    follow();
    for (const SlidingContacts::ContactConstraint& touch : contacts_.touches())
      EXPECT_GE(normalForce(touch), 0.0);
    EXPECT_LE(force().z(), 1e-9);
  }
  EXPECT_LT(force().norm(), 1e-9);
}

TEST_F(PlaneOnABlock, WithoutFrictionItDragsNothing) {
  press(2e-3);
  for (int time = 0; time < 3; ++time) follow();  // what is left of the gaps goes
  const double pressed = force().z();
  drag(Vec3(4e-3, 0.0, 0.0), 8);
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    EXPECT_EQ(dragOf(touch), Vec3::Zero());
  }
  EXPECT_LT(force().head<2>().norm(), 1e-6 * -force().z());
  EXPECT_NEAR(force().z(), pressed, 0.01 * std::abs(pressed));
}

TEST_F(PlaneOnABlock, DragStaysInTheConeAndReachesItWhenItSlides) {
  constexpr double kFriction = 0.2;
  make(kFriction);
  press(2e-3);
  drag(Vec3(3e-3, 0.0, 0.0), 6);
  double cone = 0.0;
  for (int i = 0; i < 6; ++i) {
    drag(Vec3(1e-3, 0.0, 0.0), 2);
    for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
      cone = std::max(cone, dragOf(touch).norm() - kFriction * normalForce(touch));
    }
  }
  EXPECT_LT(cone, 0.03 * kFriction * -force().z());
  EXPECT_NEAR(force().x(), kFriction * -force().z(), 0.05 * kFriction * -force().z());
  EXPECT_LT(std::abs(force().y()), 0.01 * force().x());
}

TEST_F(PlaneOnABlock, WithMuchFrictionTheTissueSticks) {
  make(5.0);
  press(2e-3);
  const int corner = tissue_->lattice().node(2, 2, 3);
  const Vec3 before = tissue_->state().displacement[at(corner)];
  drag(Vec3(2e-3, 0.0, 0.0), 4);
  const Vec3 moved = tissue_->state().displacement[at(corner)] - before;
  EXPECT_NEAR(moved.x(), 2e-3, 0.05 * 2e-3);
  EXPECT_GT(force().x(), 0.05 * -force().z());
}

TEST_F(PlaneOnABlock, PointsThatOnlyHeldNodesCarryAreNeverTaken) {
  for (int i = 0; i < 5; ++i) held_[at(tissue_->lattice().node(i, 2, 3))] = 1;
  goTo(Vec3(0.02, 0.02, 0.03 - 5e-4));
  contacts_.ride(pose_, *tissue_);
  contacts_.meet(contacts(), pose_, *tissue_, held_);
  EXPECT_EQ(contacts_.touches().size(), 20u);
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    for (const NodeWeight& carrier : touch.spring.carriers) {
      EXPECT_EQ(held_[at(carrier.node)], 0);
    }
  }
}

TEST(GivesWay, BesideGraspedNodesToOtherToolsByFourTenthsOfItsWeightToTheJawsNever) {
  const int jaws = 1, other = 0;
  const std::vector<std::uint8_t> held = {SlidingContacts::graspedBy(jaws), 0};
  EXPECT_TRUE(SlidingContacts::givesWay({{0, 0.55}, {1, 0.45}}, other, held));
  EXPECT_FALSE(SlidingContacts::givesWay({{0, 0.65}, {1, 0.35}}, other, held));
  EXPECT_FALSE(SlidingContacts::givesWay({{0, 0.05}, {1, 0.95}}, jaws, held));
  EXPECT_TRUE(SlidingContacts::givesWay({{1, 1.0}}, jaws, held));
}

TEST_F(PlaneOnABlock, ToolThatTheTissueSticksToIsNotItsOwn) {
  make(std::nullopt);
  goTo(Vec3(0.02, 0.02, 0.03 - 5e-4));
  contacts_.ride(pose_, *tissue_);
  contacts_.meet(contacts(), pose_, *tissue_, held_);
  EXPECT_TRUE(contacts_.touches().empty());
  contacts_.update({}, contacts(), pose_, *tissue_, held_);
  EXPECT_TRUE(contacts_.touches().empty());
}

TEST_F(PlaneOnABlock, ClearForgetsTheToolsTouches) {
  press(5e-4);
  contacts_.clear(1);
  EXPECT_EQ(contacts_.touches().size(), 25u);
  EXPECT_TRUE(contacts_.pushes(0, *tissue_));
  contacts_.clear(0);
  EXPECT_TRUE(contacts_.touches().empty());
  EXPECT_FALSE(contacts_.pushes(0, *tissue_));
}

TEST_F(PlaneOnABlock, SameWayGivesTheSameBits) {
  make(0.3);
  press(1e-3);
  drag(Vec3(2e-3, 1e-3, 0.0), 4);
  const std::vector<Vec3> first = tissue_->state().displacement;
  make(0.3);
  press(1e-3);
  drag(Vec3(2e-3, 1e-3, 0.0), 4);
  EXPECT_EQ(tissue_->state().displacement, first);
}

TEST_F(PlaneOnABlock, SettledTouchesNeedNoFurtherRound) {
  press(1e-3);
  for (int time = 0; time < 3; ++time) follow();
  EXPECT_EQ(rounds_, 1);
}

// They would be one that is twice as stiff.
TEST_F(TwoBumpsOnABlock, TouchesThatWanderToOnePlaceBecomeOne) {
  goTo(Vec3(0.02, 0.02, 0.03 - 5e-4));
  Contact a = bump(Vec3(0.8, 0.1, 0.1)), b = bump(Vec3(0.1, 0.1, 0.8));
  a.wanders = b.wanders = true;
  contacts_.ride(pose_, *tissue_);
  contacts_.meet({{a, b}}, pose_, *tissue_, held_);
  contacts_.update({a, b}, {}, pose_, *tissue_, held_, Shape::kOnItsWay);  // they are in the plane
  ASSERT_EQ(contacts_.touches().size(), 2u);
  double both = 0.0;
  for (const auto& touch : contacts_.touches()) both += touch.spring.multiplier;
  contacts_.update({a, a}, {}, pose_, *tissue_, held_, Shape::kOnItsWay);
  ASSERT_EQ(contacts_.touches().size(), 1u);
  EXPECT_GT(both, 0.0);
  EXPECT_GE(contacts_.touches().front().spring.multiplier, both);
}

// With one touch, which goes to the deeper one, rounds would go on to the last.
TEST_F(TwoBumpsOnABlock, ATriangleThatLiesOnTwoPlacesHasATouchAtEach) {
  press(1.5e-3);
  EXPECT_EQ(contacts_.touches().size(), 1u);
  EXPECT_EQ(rounds_, 16);
  is_uneven_ = true;
  make(0.0);
  press(1.5e-3);
  EXPECT_EQ(contacts_.touches().size(), 2u);
  EXPECT_LT(rounds_, 6);
  EXPECT_LT(contacts().contacts.front().depth_m, kSettled);
}

}  // namespace
}  // namespace robot_tissue::test_sliding_contacts
