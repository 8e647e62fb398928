// Signed distances of the shapes, against closed formulas and against FCL.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>
#include <random>

#include "contact_fixtures.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue::test_shape_distance {
namespace {

constexpr double kFar = 1.0;  // m, farther than any point asked

using Distance = std::function<double(const Vec3&)>;

// Asks at every grid point under several poses, and compares depth and way out with the formula.
void expectAgreement(const ToolShape& shape, double padding, const Vec3& reach,
                     const Distance& distance, double slack) {
  const ToolShape placed = placedAt(makePose(Vec3(0.01, -0.02, 0.03), 0.7, Vec3(1, 2, -1)), shape);
  const ContactFinder finder({makeTool({placed}, padding)});
  for (const Pose& pose :
       {Pose::Identity(), makePose(Vec3(-0.5, 0.1, 0.2), 2.1, Vec3(0.3, -1, 0.5)),
        makePose(Vec3::Zero(), 0.5 * M_PI, Vec3::UnitX())}) {
    const Pose tissue_T_shape = pose * placed.pose;
    int inside = 0;
    for (const Vec3& point : grid(reach)) {
      const auto out = finder.wayOut(0, pose, tissue_T_shape * point, kFar);
      ASSERT_TRUE(out);
      EXPECT_NEAR(out->depth_m, padding - distance(point), slack);
      inside += out->depth_m > 0.0 ? 1 : 0;
      if (out->normal.isZero()) continue;
      EXPECT_NEAR(out->normal.norm(), 1.0, 1e-9);
      const Vec3 normal = tissue_T_shape.linear().transpose() * out->normal;
      EXPECT_NEAR(distance(point + out->depth_m * normal), padding, 2.0 * slack);
    }
    EXPECT_GT(inside, 100);
    EXPECT_LT(inside, static_cast<int>(grid(reach).size()) - 100);
  }
}

TEST(ShapeDistance, SphereAgreesWithItsFormula) {
  for (const double padding : {0.0, 0.0013}) {
    expectAgreement(
        sphere(0.01), padding, Vec3::Constant(0.0131),
        [](const Vec3& p) { return p.norm() - 0.01; }, 1e-12);
  }
}

TEST(ShapeDistance, BoxAgreesWithItsFormula) {
  const Vec3 size(0.01, 0.02, 0.04);
  for (const double padding : {0.0, 0.0013}) {
    expectAgreement(
        box(size), padding, Vec3(0.008, 0.016, 0.0271),
        [&](const Vec3& p) { return boxDistance(size, p); }, 1e-12);
  }
}

TEST(ShapeDistance, CylinderAgreesWithItsFormula) {
  for (const double padding : {0.0, 0.0007}) {
    expectAgreement(
        cylinder(0.004, 0.03), padding, Vec3(0.0056, 0.0056, 0.0193),
        [](const Vec3& p) { return cylinderDistance(0.004, 0.03, p); }, 1e-12);
  }
}

TEST(ShapeDistance, PlaneIsSolidBelow) {
  for (const double padding : {0.0, 0.0013}) {
    expectAgreement(
        plane(), padding, Vec3::Constant(0.1), [](const Vec3& p) { return p.z(); }, 1e-12);
  }
}

TEST(ShapeDistance, MeshOfABoxAgreesWithTheBox) {
  const Vec3 size(0.01, 0.02, 0.04);
  const std::string resource = writeStl("box.stl", boxTriangles(size));
  for (const double padding : {0.0, 0.0013}) {
    // STL keeps single precision.
    expectAgreement(
        mesh(resource), padding, Vec3(0.008, 0.016, 0.0271),
        [&](const Vec3& p) { return boxDistance(size, p); }, 1e-8);
  }
}

TEST(ShapeDistance, MeshIsScaledAlsoMirrored) {
  ToolShape shape = mesh(writeStl("mm.stl", boxTriangles(Vec3(10.0, 20.0, 40.0))));
  shape.scale = Vec3(0.001, -0.001, 0.001);
  const Vec3 size(0.01, 0.02, 0.04);
  expectAgreement(
      shape, 0.0, Vec3(0.008, 0.016, 0.0271), [&](const Vec3& p) { return boxDistance(size, p); },
      1e-8);
}

// Of a sphere as large as what is asked for, FCL's depth is the gap to its center, too.
double distanceByFcl(const fcl::CollisionGeometryd& shape, const Vec3& point, Vec3& away) {
  const double radius = 0.1;
  const fcl::Sphered probe(radius);
  fcl::Transform3d place = fcl::Transform3d::Identity();
  place.translation() = point;
  fcl::CollisionResultd result;
  fcl::collide(&probe, place, &shape, fcl::Transform3d::Identity(), fcl::CollisionRequestd(1, true),
               result);
  EXPECT_TRUE(result.isCollision());
  away = -result.getContact(0).normal;
  return radius - result.getContact(0).penetration_depth;
}

TEST(ShapeDistance, PrimitivesAgreeWithFcl) {
  const Vec3 size(0.01, 0.02, 0.04);
  const fcl::Sphered fcl_sphere(0.01);
  const fcl::Boxd fcl_box(size);
  const fcl::Cylinderd fcl_cylinder(0.008, 0.03);
  const std::vector<std::pair<ToolShape, const fcl::CollisionGeometryd*>> pairs = {
      {sphere(0.01), &fcl_sphere}, {box(size), &fcl_box}, {cylinder(0.008, 0.03), &fcl_cylinder}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.025, 0.025);
  for (const auto& [shape, by_fcl] : pairs) {
    const ContactFinder finder({makeTool({shape})});
    for (int i = 0; i < 500; ++i) {
      const Vec3 point(place(random), place(random), place(random));
      Vec3 away;
      const double distance = distanceByFcl(*by_fcl, point, away);
      const auto out = finder.wayOut(0, Pose::Identity(), point, kFar);
      ASSERT_TRUE(out);
      EXPECT_NEAR(out->depth_m, -distance, 1e-12);
      EXPECT_NEAR((out->normal - away).norm(), 0.0, 1e-6) << point.transpose();
    }
  }
}

std::unique_ptr<fcl::BVHModel<fcl::OBBRSSd>> fclMesh(const std::vector<Triangle>& triangles) {
  auto model = std::make_unique<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel();
  for (const Triangle& t : triangles) model->addTriangle(t[0], t[1], t[2]);
  model->endModel();
  return model;
}

// The distance as a mesh of FCL, the sign by the solid angles around the point.
TEST(ShapeDistance, ConcaveMeshAgreesWithFcl) {
  const std::vector<Triangle> triangles = forkTriangles(0.004, 0.006, 0.015, 0.005);
  const auto fcl_mesh = fclMesh(triangles);
  const double speck = 1e-7;
  const auto fcl_speck = fclMesh({{{Vec3::Zero(), Vec3(speck, 0, 0), Vec3(0, speck, 0)}}});
  std::vector<Vec3> vertices;
  std::vector<MeshTriangle> indices;
  for (const Triangle& t : triangles) {
    const int first = static_cast<int>(vertices.size());
    vertices.insert(vertices.end(), t.begin(), t.end());
    indices.push_back({first, first + 1, first + 2});
  }
  const ContactFinder finder({makeTool({mesh(writeStl("fcl_fork.stl", triangles))})});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.012, 0.012);
  int inside = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 point(place(random), 0.5 * place(random), 0.01 + place(random));
    fcl::Transform3d at_point = fcl::Transform3d::Identity();
    at_point.translation() = point;
    fcl::DistanceResultd result;
    fcl::distance(fcl_mesh.get(), fcl::Transform3d::Identity(), fcl_speck.get(), at_point,
                  fcl::DistanceRequestd(), result);
    const bool is_inside = encloses(vertices, indices, point);
    const auto out = finder.wayOut(0, Pose::Identity(), point, kFar);
    EXPECT_NEAR(out->depth_m, is_inside ? result.min_distance : -result.min_distance, 2.0 * speck);
    inside += is_inside ? 1 : 0;
  }
  EXPECT_GT(inside, 50);
  EXPECT_LT(inside, 450);
}

TEST(ShapeDistance, NothingBeyondTheReach) {
  const std::string resource = writeStl("reach.stl", boxTriangles(Vec3(0.02, 0.02, 0.02)));
  for (const ToolShape& shape :
       {sphere(0.01), box(Vec3(0.02, 0.02, 0.02)), mesh(resource), cylinder(0.01, 0.05)}) {
    const ContactFinder finder({makeTool({shape}, 0.001)});
    const auto ask = [&](double x, double reach) {
      return finder.wayOut(0, Pose::Identity(), Vec3(x, 0.0, 0.0), reach);
    };
    EXPECT_FALSE(ask(0.0131, 0.002));
    ASSERT_TRUE(ask(0.0129, 0.002));
    EXPECT_NEAR(ask(0.0129, 0.002)->depth_m, -0.0019, 1e-8);
    EXPECT_TRUE(ask(0.009, 0.0));
    EXPECT_FALSE(ask(std::numeric_limits<double>::quiet_NaN(), 0.002));
  }
}

TEST(ShapeDistance, EveryWayLeadsOutOfTheCenterOfASphere) {
  const ContactFinder finder({makeTool({sphere(0.01)})});
  const auto out = finder.wayOut(0, Pose::Identity(), Vec3::Zero(), 0.0);
  ASSERT_TRUE(out);
  EXPECT_DOUBLE_EQ(out->depth_m, 0.01);
  EXPECT_TRUE(out->normal.isZero(0.0));
}

TEST(ShapeDistance, OfSeveralShapesTheDeepestAnswers) {
  for (const auto& shapes : {std::vector<ToolShape>{sphere(0.001), sphere(0.003)},
                             std::vector<ToolShape>{sphere(0.003), sphere(0.001)}}) {
    const ContactFinder finder({makeTool(shapes)});
    const auto out = finder.wayOut(0, Pose::Identity(), Vec3(0.0005, 0.0, 0.0), 0.0);
    ASSERT_TRUE(out);
    EXPECT_NEAR(out->depth_m, 0.0025, 1e-12);
  }
}

TEST(ShapeDistance, MeasuresOfALink) {
  const Pose place = makePose(Vec3(0.0, 0.0, 0.05));
  const ContactFinder finder(
      {makeTool({placedAt(place, cylinder(0.002, 0.1)), sphere(0.004)}, 0.001), makeTool({plane()}),
       makeTool({})});
  EXPECT_EQ(finder.linkCount(), 3U);
  EXPECT_NEAR(finder.thickness(0), 0.006, 1e-12);
  EXPECT_NEAR(finder.reach(0), Vec3(0.003, 0.003, 0.101).norm(), 1e-12);
  EXPECT_NEAR(boundsOf(finder.surfacePoints(0)).max().z(), 0.101, 1e-12);
  EXPECT_TRUE(finder.surfacePoints(1).empty());
  const Box box = finder.bounds(0, makePose(Vec3(1.0, 0.0, 0.0), 0.5 * M_PI, Vec3::UnitY()));
  EXPECT_NEAR((box.min() - Vec3(0.995, -0.005, -0.005)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((box.max() - Vec3(1.101, 0.005, 0.005)).norm(), 0.0, 1e-12);
  EXPECT_EQ(finder.reach(1), 0.0);
  EXPECT_TRUE(std::isinf(finder.thickness(1)));
  EXPECT_TRUE(std::isinf(finder.thickness(2)));
  EXPECT_EQ(finder.reach(2), 0.0);
  EXPECT_GT(finder.bounds(2, Pose::Identity()).min().x(),
            finder.bounds(2, Pose::Identity()).max().x());
}

}  // namespace
}  // namespace robot_tissue::test_shape_distance
