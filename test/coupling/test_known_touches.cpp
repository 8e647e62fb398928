// Among many touches: answers as of a look at all of them, without one.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "core/tissue_fixtures.h"
#include "known_touches.h"

namespace robot_tissue::test_known_touches {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kSamePoint = 0.25;  // barycentric
constexpr int kLinks = 3;

using Touch = SlidingContacts::ContactConstraint;

class TouchesOfABlock : public ::testing::Test {
 protected:
  TouchesOfABlock() : tissue_(softBlock(), SolverConfig()) {}

  static TissueConfig softBlock() {
    TissueConfig config = withFixedBottom(blockOf(3, 3, 2, kSpacing));
    config.model = "elastic";
    return config;
  }

  int anyBelow(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }
  double anyShare() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  // At corners of triangles and in them, at places that touches share.
  Contact anyContact() {
    Contact contact;
    contact.link = anyBelow(kLinks);
    contact.place.triangle = anyBelow(static_cast<int>(surface().triangles.size()));
    const double share = 0.1 * anyBelow(5);
    contact.place.barycentric =
        anyBelow(2) == 0 ? Vec3(Vec3::Unit(anyBelow(3))) : Vec3(share + 0.1, 0.1, 0.8 - share);
    contact.rim.is_beyond = anyBelow(4) == 0;
    if (anyBelow(2) == 0) contact.rim.edges.push_back({Vec3::UnitX(), 0.0});
    contact.point = kSpacing * Vec3(anyBelow(4), anyBelow(4), anyBelow(4));
    return contact;
  }

  void add(const Contact& contact) {
    Touch touch;
    touch.contact = contact;
    touch.vertex = vertexAt(surface(), contact.place);
    touch.tool_point = contact.point;
    touch.friction_ratio = Vec3(anyShare(), anyShare(), anyShare());
    touches_.push_back(touch);
  }

  void addMany(int count) {
    for (int i = 0; i < count; ++i) {
      add(anyContact());
      if (anyBelow(2) == 0) touches_.back().spring.multiplier = 1.0;
    }
  }

  const Touch* findAmongAll(const Contact& contact) const {
    const int vertex = vertexAt(surface(), contact.place);
    const Touch* nearest = nullptr;
    double least = kSamePoint;
    for (const Touch& touch : touches_) {
      if (touch.contact.link != contact.link || touch.vertex != vertex) continue;
      const Rim &known_rim = touch.contact.rim, &rim = contact.rim;
      const bool either_is_at_none = known_rim.edges.empty() || rim.edges.empty();
      if (known_rim.is_beyond != rim.is_beyond && either_is_at_none) continue;
      if (vertex >= 0) return &touch;
      if (touch.contact.place.triangle != contact.place.triangle) continue;
      const Vec3 way = touch.contact.place.barycentric - contact.place.barycentric;
      if (way.cwiseAbs().maxCoeff() >= least) continue;
      least = way.cwiseAbs().maxCoeff();
      nearest = &touch;
    }
    return nearest;
  }

  Vec3 ratioAmongAll(int link, const Vec3& point) const {
    Vec3 ratio = Vec3::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (const Touch& touch : touches_) {
      if (touch.spring.multiplier <= 0.0 || touch.contact.link != link) continue;
      const double off = (touch.tool_point - point).norm();
      if (off >= least) continue;
      least = off;
      ratio = touch.friction_ratio;
    }
    return ratio;
  }

  const TissueSurface& surface() const { return tissue_.surface(); }

  Tissue tissue_;
  std::vector<Touch> touches_;
  std::mt19937 random_{1};
};

TEST_F(TouchesOfABlock, AContactFindsTheTouchItWouldFindAmongAllAlsoOfThoseAddedSince) {
  addMany(300);
  KnownTouches known(touches_);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Contact contact = anyContact();
    const Touch* const touch = known.find(contact, surface());
    ASSERT_EQ(touch, findAmongAll(contact));
    if (touch != nullptr) ++found;
    if (i % 4 == 0) add(contact);
  }
  EXPECT_GT(found, 500);
  EXPECT_LT(found, 1900);
}

TEST_F(TouchesOfABlock, WhereEachVertexIsTouchedByEachLinkOnceASearchMeetsOneTouch) {
  KnownTouches known(touches_);
  for (int link = 0; link < kLinks; ++link) {
    for (std::size_t i = 0; i < surface().triangles.size(); ++i) {
      for (int corner = 0; corner < 3; ++corner) {
        Contact contact;
        contact.link = link;
        contact.place = {static_cast<int>(i), Vec3::Unit(corner)};
        if (known.find(contact, surface()) == nullptr) add(contact);
        EXPECT_EQ(known.touchesAt(contact, surface()).size(), 1u);
      }
    }
  }
  EXPECT_EQ(touches_.size(), kLinks * surface().rest.size());
}

TEST_F(TouchesOfABlock, FrictionIsThatOfTheNearestThatPushesAlsoOfTouchesThatMoved) {
  addMany(200);
  KnownTouches known(touches_);
  for (int i = 0; i < 1000; ++i) {
    const Contact contact = anyContact();
    ASSERT_EQ(known.frictionRatioNear(contact.link, contact.point),
              ratioAmongAll(contact.link, contact.point));
    if (i % 3 == 0) add(contact);
    if (i % 2 == 0) continue;
    Touch& touch = touches_[at(anyBelow(static_cast<int>(touches_.size())))];
    touch.tool_point = contact.point;
    known.moved(touch);
  }
}

TEST_F(TouchesOfABlock, WithoutOneThatPushesThereIsNoFriction) {
  add(anyContact());
  KnownTouches known(touches_);
  for (int link = 0; link < kLinks; ++link) {
    EXPECT_EQ(known.frictionRatioNear(link, Vec3::Zero()), Vec3(Vec3::Zero()));
  }
}

}  // namespace
}  // namespace robot_tissue::test_known_touches
