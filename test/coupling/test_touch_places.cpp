// Touches on a surface that a cut has changed.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/tissue_fixtures.h"
#include "robot_tissue/coupling/sliding_contacts.h"

namespace robot_tissue::test_touch_places {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kTop = 0.03;
constexpr double kDepth = 1e-3;  // of the plane over the block

using Touch = SlidingContacts::ContactConstraint;

class TouchedBlock : public ::testing::Test {
 protected:
  TouchedBlock() : tissue_(softBlock(), newton()) { pose_.links = {Pose::Identity()}; }

  static TissueConfig softBlock() {
    TissueConfig config = withFixedBottom(blockOf(4, 4, 3, kSpacing));
    config.model = "elastic";
    return config;
  }
  static SolverConfig newton() {
    SolverConfig solver;
    solver.method = "newton";
    return solver;
  }

  // A touch in the top's triangles, at these weights of their corners.
  void touch(const Vec3& barycentric) {
    const TissueSurface& surface = tissue_.surface();
    ContactSet set;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      Vec3 point = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        point += barycentric[k] * surface.rest[at(surface.triangles[i][at(k)])];
      }
      if (point.z() < kTop - 1e-9) continue;
      set.contacts.push_back(
          {0, 0, 0, {static_cast<int>(i), barycentric}, point, -Vec3::UnitZ(), kDepth, {}, {}});
    }
    contacts_.ride(pose_, tissue_);
    const std::vector<std::uint8_t> held(tissue_.state().displacement.size(), 0);  // ghosts, too
    contacts_.meet(set, pose_, tissue_, held);
  }

  // Upright at that x, from side to side.
  void cut(double x) {
    ASSERT_GT(tissue_.cut({Vec3(x, -1, 0.01), Vec3(x, 1, 0.01), Vec3(x, 1, 1), Vec3(x, -1, 1)})
                  .springs_cut,
              0);
  }

  // The touches of before that are on the new surface, each at its place.
  std::vector<Touch> goneOn(const std::vector<Touch>& before) {
    contacts_.takeSurface(pose_, tissue_);
    std::vector<Touch> gone_on;
    for (const Touch& touch : before) {
      const auto& touches = contacts_.touches();
      const auto now = std::find_if(touches.begin(), touches.end(), [&](const Touch& other) {
        return (other.spring.rest - touch.spring.rest).isZero(1e-12);
      });
      if (now == touches.end()) continue;
      gone_on.push_back(*now);
      EXPECT_LT((onSurface(*now) - touch.spring.rest).norm(), 1e-12);
      EXPECT_EQ(now->vertex < 0, touch.vertex < 0);
    }
    EXPECT_EQ(gone_on.size(), contacts_.touches().size());
    return gone_on;
  }
  Vec3 onSurface(const Touch& touch) const {
    Vec3 point = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const int vertex = tissue_.surface().triangles[at(touch.contact.place.triangle)][at(k)];
      point += touch.contact.place.barycentric[k] * tissue_.surface().rest[at(vertex)];
    }
    return point;
  }

  Tissue tissue_;
  SlidingContacts contacts_{{0.0}, {{{1.0}, false, {}}}};
  RobotPose pose_;
};

// The cells from x = 0 on are cut; those beside them have corners of triangles along them.
TEST_F(TouchedBlock, PointsGoOnWhereTheirTrianglesAreAsTheyWere) {
  touch(Vec3(0.5, 0.3, 0.2));
  const std::vector<Touch> before = contacts_.touches();
  ASSERT_EQ(before.size(), 32u);
  cut(0.005);
  const std::vector<Touch> after = goneOn(before);
  EXPECT_EQ(after.size(), 16u);
  for (const Touch& touch : after) EXPECT_GT(touch.spring.rest.x(), 0.02);
}

TEST_F(TouchedBlock, VerticesGoOnBesideTheCut) {
  touch(Vec3::UnitX());
  const std::vector<Touch> before = contacts_.touches();
  cut(0.005);
  const std::vector<Touch> after = goneOn(before);
  EXPECT_EQ(after.size(), before.size());
  for (const Touch& touch : after) EXPECT_EQ(touch.spring.carriers.size(), 1u);
}

// Two vertices are at each place of the first cut's lips.
TEST_F(TouchedBlock, VerticesOfLipsGoOnByTheirTriangles) {
  cut(0.005);
  touch(Vec3::UnitZ());
  const auto at_lips = [](const std::vector<Touch>& touches) {
    return std::count_if(touches.begin(), touches.end(), [](const Touch& touch) {
      return std::abs(touch.spring.rest.x() - 0.005) < 1e-9;
    });
  };
  const std::vector<Touch> before = contacts_.touches();
  ASSERT_GT(at_lips(before), 0);
  cut(0.035);
  contacts_.takeSurface(pose_, tissue_);
  EXPECT_EQ(at_lips(contacts_.touches()), at_lips(before));
  for (const Touch& touch : contacts_.touches()) {
    const auto was = std::find_if(before.begin(), before.end(), [&](const Touch& other) {
      return other.spring.rest == touch.spring.rest &&
             other.spring.carriers.front().node == touch.spring.carriers.front().node;
    });
    EXPECT_NE(was, before.end()) << touch.spring.rest.transpose();
  }
}

}  // namespace
}  // namespace robot_tissue::test_touch_places
