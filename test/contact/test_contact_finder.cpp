#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "contact_fixtures.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Signed distance to a shape in its own frame, negative inside (m).
using Distance = std::function<double(const Vec3&)>;

// Asks at every grid point under several poses, and compares depth and way out with the formula.
void expectAgreement(const ToolShape& shape, double padding, const Vec3& reach,
                     const Distance& distance, double slack) {
  ToolShape placed = shape;
  placed.pose = makePose(Vec3(0.01, -0.02, 0.03), 0.7, Vec3(1.0, 2.0, -1.0));
  ContactFinder finder({makeTool({placed}, padding)});
  const std::vector<Pose> poses = {Pose::Identity(), makePose(Vec3(0.1, 0.2, -0.3)),
                                   makePose(Vec3(-0.5, 0.1, 0.2), 2.1, Vec3(0.3, -1.0, 0.5)),
                                   makePose(Vec3::Zero(), 0.5 * M_PI, Vec3::UnitX())};
  for (const Pose& pose : poses) {
    const Pose tissue_T_shape = pose * placed.pose;
    std::vector<Vec3> points;
    for (const Vec3& point : grid(reach)) points.push_back(tissue_T_shape * point);
    const Sheet sheet = makePoints(points);
    const ContactSet found = finder.find(at(pose), sheet.surface, sheet.vertices);

    std::vector<int> hits(points.size(), 0);
    for (const Contact& contact : found.contacts) {
      const Vec3 point = tissue_T_shape.inverse() * contact.point;
      const Vec3 normal = tissue_T_shape.linear().transpose() * contact.normal;
      ++hits[static_cast<std::size_t>(contact.triangle)];
      EXPECT_GT(contact.depth_m, 0.0);
      EXPECT_NEAR(contact.depth_m, padding - distance(point), slack);
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-9);
      EXPECT_NEAR(distance(point + contact.depth_m * normal), padding, 2.0 * slack);
    }
    int inside = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double depth = padding - distance(tissue_T_shape.inverse() * points[i]);
      if (std::abs(depth) < 1e-8) continue;  // on the very surface: either answer
      EXPECT_EQ(hits[i], depth > 0.0 ? 1 : 0) << "depth " << depth;
      inside += depth > 0.0 ? 1 : 0;
    }
    EXPECT_GT(inside, 100);
    EXPECT_LT(inside, static_cast<int>(points.size()) - 100);
  }
}

TEST(ContactFinder, SphereAgreesWithItsFormula) {
  for (const double padding : {0.0, 0.0013}) {
    expectAgreement(
        sphere(0.01), padding, Vec3::Constant(0.0131),
        [](const Vec3& p) { return p.norm() - 0.01; }, 1e-12);
  }
}

TEST(ContactFinder, BoxAgreesWithItsFormula) {
  const Vec3 size(0.01, 0.02, 0.04);
  for (const double padding : {0.0, 0.0013}) {
    expectAgreement(
        box(size), padding, Vec3(0.008, 0.016, 0.0271),
        [&](const Vec3& p) { return boxDistance(size, p); }, 1e-12);
  }
}

TEST(ContactFinder, CylinderAgreesWithItsFormula) {
  for (const double padding : {0.0, 0.0007}) {
    expectAgreement(
        cylinder(0.004, 0.03), padding, Vec3(0.0056, 0.0056, 0.0193),
        [](const Vec3& p) { return cylinderDistance(0.004, 0.03, p); }, 1e-12);
  }
}

TEST(ContactFinder, MeshOfABoxAgreesWithTheBox) {
  const Vec3 size(0.01, 0.02, 0.04);
  const std::string resource = writeStl("box.stl", boxTriangles(size));
  for (const double padding : {0.0, 0.0013}) {
    // STL keeps single precision.
    expectAgreement(
        mesh(resource), padding, Vec3(0.008, 0.016, 0.0271),
        [&](const Vec3& p) { return boxDistance(size, p); }, 1e-8);
  }
}

TEST(ContactFinder, MeshIsScaledAlsoMirrored) {
  ToolShape shape = mesh(writeStl("mm.stl", boxTriangles(Vec3(10.0, 20.0, 40.0))));
  shape.scale = Vec3(0.001, -0.001, 0.001);
  const Vec3 size(0.01, 0.02, 0.04);
  expectAgreement(
      shape, 0.0, Vec3(0.008, 0.016, 0.0271), [&](const Vec3& p) { return boxDistance(size, p); },
      1e-8);
}

// Points of a ball as a mesh with many faces; nothing inside may be lost.
TEST(ContactFinder, RoundMeshIsNearTheSphere) {
  std::vector<Triangle> triangles;
  const int rings = 16;
  const double radius = 0.01;
  const auto point = [&](int ring, int step) -> Vec3 {
    const double polar = M_PI * ring / rings;
    const double azimuth = M_PI * step / rings;
    return radius * Vec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                         std::cos(polar));
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) triangles.push_back({{point(i, j), point(i + 1, j), point(i, j + 1)}});
      if (i + 1 < rings)
        triangles.push_back({{point(i, j + 1), point(i + 1, j), point(i + 1, j + 1)}});
    }
  }
  ContactFinder finder({makeTool({mesh(writeStl("ball.stl", triangles))})});
  EXPECT_TRUE(finder.warnings().empty());
  const double sag = radius * (1.0 - std::cos(M_PI / rings));  // greatest, of face under sphere
  const Sheet sheet = makePoints(grid(Vec3::Constant(0.0113)));
  const ContactSet found = finder.find(at(Pose::Identity()), sheet.surface, sheet.vertices);
  std::vector<bool> hit(sheet.vertices.size(), false);
  for (const Contact& contact : found.contacts) {
    hit[static_cast<std::size_t>(contact.triangle)] = true;
    const double depth = radius - contact.point.norm();
    EXPECT_LE(contact.depth_m, depth + 1e-8);
    EXPECT_GE(contact.depth_m, depth - sag - 1e-8);
  }
  for (std::size_t i = 0; i < hit.size(); ++i) {
    if (sheet.vertices[i].norm() < radius - sag) {
      EXPECT_TRUE(hit[i]);
    }
  }
}

TEST(ContactFinder, PointAtTheCenterOfASphereIsPushedIntoTheTissue) {
  const Sheet sheet = makeSheet(2, 0.005);
  ContactFinder finder({makeTool({sphere(0.002)})});
  const ContactSet found =
      finder.find(at(makePose(sheet.vertices[4])), sheet.surface, sheet.vertices);
  const auto center = std::find_if(found.contacts.begin(), found.contacts.end(),
                                   [&](const Contact& c) { return c.point == sheet.vertices[4]; });
  ASSERT_NE(center, found.contacts.end());
  EXPECT_DOUBLE_EQ(center->depth_m, 0.002);
  EXPECT_EQ(center->normal, Vec3(0.0, 0.0, -1.0));
}

TEST(ContactFinder, ContactsTellTheirTriangleAndNoPointTwice) {
  const Sheet sheet = makeSheet(10, 0.005);
  ContactFinder finder({makeTool({sphere(0.004), cylinder(0.002, 0.03)}, 0.0005)});
  const ContactSet found = finder.find(at(makePose(Vec3(0.023, 0.026, 0.001), 0.4, Vec3::UnitX())),
                                       sheet.surface, sheet.vertices);
  ASSERT_GT(found.contacts.size(), 10U);
  for (std::size_t i = 0; i < found.contacts.size(); ++i) {
    const Contact& contact = found.contacts[i];
    EXPECT_NEAR(contact.barycentric.sum(), 1.0, 1e-12);
    EXPECT_GE(contact.barycentric.minCoeff(), 0.0);
    const auto& corners = sheet.surface.triangles[static_cast<std::size_t>(contact.triangle)];
    Vec3 point = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      point += contact.barycentric[static_cast<int>(k)] *
               sheet.vertices[static_cast<std::size_t>(corners[k])];
    }
    EXPECT_NEAR((point - contact.point).norm(), 0.0, 1e-15);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT((found.contacts[j].point - contact.point).norm(), 1e-9);
    }
  }
}

TEST(ContactFinder, NeedleBetweenTheNodesIsFoundWhereverItStands) {
  const Sheet sheet = makeSheet(6, 0.005);
  ContactFinder finder({makeTool({cylinder(0.0005, 0.05)})});
  const double depth = 0.0002;
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      const Vec3 tip(0.01 + 0.00025 * i, 0.01 + 0.00025 * j, -depth);
      const ContactSet found =
          finder.find(at(makePose(tip + Vec3(0.0, 0.0, 0.025))), sheet.surface, sheet.vertices);
      ASSERT_FALSE(found.contacts.empty()) << tip.transpose();
      double deepest = 0.0;
      for (const Contact& contact : found.contacts) {
        deepest = std::max(deepest, contact.depth_m);
      }
      EXPECT_NEAR(deepest, depth, 1e-12);
    }
  }
}

TEST(ContactFinder, SlantedNeedleIsFound) {
  const Sheet sheet = makeSheet(6, 0.005);
  ContactFinder finder({makeTool({cylinder(0.0005, 0.05)})});
  for (int i = 0; i <= 20; ++i) {
    const Pose middle_to_tip =
        makePose(Vec3(0.011 + 0.0002 * i, 0.012, -0.002), 0.8, Vec3(1, 1, 0));
    const Pose pose = middle_to_tip * makePose(Vec3(0.0, 0.0, 0.025));
    EXPECT_FALSE(finder.find(at(pose), sheet.surface, sheet.vertices).contacts.empty()) << i;
  }
}

// Thinner than the rows of points beside it: only the points on the edges under it are inside.
TEST(ContactFinder, NeedleLyingOnAnEdgeIsFoundAllAlong) {
  const Sheet sheet = makeSheet(6, 0.005);
  ContactFinder finder({makeTool({cylinder(0.0002, 0.02)})});
  const Pose lying = makePose(Vec3(0.0151, 0.01, 0.0), 0.5 * M_PI, Vec3::UnitY());
  std::vector<double> along;
  for (const Contact& contact : finder.find(at(lying), sheet.surface, sheet.vertices).contacts) {
    EXPECT_NEAR(contact.point.y(), 0.01, 0.0002);
    along.push_back(contact.point.x());
  }
  std::sort(along.begin(), along.end());
  ASSERT_FALSE(along.empty());
  const double spacing = 0.005 / 8.0 + 1e-9;
  EXPECT_LT(along.front(), 0.0051 + spacing);
  EXPECT_GT(along.back(), 0.0251 - spacing);
  for (std::size_t i = 1; i < along.size(); ++i) EXPECT_LT(along[i] - along[i - 1], spacing);
}

TEST(ContactFinder, PointInSeveralShapesGetsTheDeepest) {
  const Sheet sheet = makePoints({Vec3(0.0005, 0.0, 0.0)});
  for (const auto& shapes : {std::vector<ToolShape>{sphere(0.001), sphere(0.003)},
                             std::vector<ToolShape>{sphere(0.003), sphere(0.001)}}) {
    ContactFinder finder({makeTool(shapes)});
    const ContactSet found = finder.find(at(Pose::Identity()), sheet.surface, sheet.vertices);
    ASSERT_EQ(found.contacts.size(), 1U);
    EXPECT_NEAR(found.contacts[0].depth_m, 0.0025, 1e-12);
  }
}

TEST(ContactFinder, SphereIsFoundAtItsFirstTouchBetweenTheNodes) {
  const Sheet sheet = makeSheet(6, 0.005);
  const double depth = 1e-5;
  ContactFinder finder({makeTool({sphere(0.01)})});
  for (int i = 0; i <= 10; ++i) {
    const Vec3 lowest(0.01 + 0.0005 * i, 0.0125, -depth);
    const ContactSet found =
        finder.find(at(makePose(lowest + Vec3(0.0, 0.0, 0.01))), sheet.surface, sheet.vertices);
    ASSERT_FALSE(found.contacts.empty()) << i;
    const auto deepest =
        std::max_element(found.contacts.begin(), found.contacts.end(),
                         [](const Contact& a, const Contact& b) { return a.depth_m < b.depth_m; });
    EXPECT_NEAR(deepest->depth_m, depth, 1e-12);
    EXPECT_NEAR((deepest->normal - Vec3(0.0, 0.0, -1.0)).norm(), 0.0, 1e-6);
  }
}

TEST(ContactFinder, NothingIsFoundApart) {
  const Sheet sheet = makeSheet(6, 0.005);
  ContactFinder finder({makeTool({sphere(0.01), box(Vec3(0.01, 0.01, 0.02))}, 0.001)});
  const auto count = [&](double height) {
    const Pose pose = makePose(Vec3(0.0125, 0.0125, height));
    return finder.find(at(pose), sheet.surface, sheet.vertices).contacts.size();
  };
  EXPECT_EQ(count(0.01101), 0U);
  EXPECT_GT(count(0.01099), 0U);
}

TEST(ContactFinder, ToolWithoutShapesTouchesNothing) {
  const Sheet sheet = makeSheet(2, 0.005);
  ContactFinder finder({makeTool({})});
  EXPECT_TRUE(finder.find(at(Pose::Identity()), sheet.surface, sheet.vertices).contacts.empty());
}

TEST(ContactFinder, EachToolAnswersForItself) {
  const Sheet sheet = makeSheet(6, 0.005);
  ContactFinder finder({makeTool({sphere(0.002)}), makeTool({sphere(0.003)})});
  RobotPose pose;
  pose.tools = {makePose(Vec3(0.005, 0.005, 0.0)), makePose(Vec3(0.02, 0.02, 0.0))};
  const ContactSet found = finder.find(pose, sheet.surface, sheet.vertices);
  int of_tool[2] = {0, 0};
  for (const Contact& contact : found.contacts) {
    ++of_tool[contact.tool];
    const Vec3 center = pose.tools[static_cast<std::size_t>(contact.tool)].translation();
    EXPECT_LT((contact.point - center).norm(), contact.tool == 0 ? 0.002 : 0.003);
  }
  EXPECT_GT(of_tool[0], 0);
  EXPECT_GT(of_tool[1], 0);
}

TEST(ContactFinder, PoseThatIsNotFiniteOrRigidTouchesNothing) {
  const Sheet sheet = makeSheet(6, 0.005);
  ContactFinder finder({makeTool({sphere(0.01)}), makeTool({sphere(0.01)})});
  const Pose good = makePose(Vec3(0.015, 0.015, 0.0));
  Pose not_finite = good;
  not_finite.translation().x() = kNaN;
  Pose collapsed = good;
  collapsed.linear().setZero();
  for (const Pose& bad : {not_finite, collapsed}) {
    RobotPose pose;
    pose.tools = {bad, good};
    const ContactSet found = finder.find(pose, sheet.surface, sheet.vertices);
    EXPECT_FALSE(found.contacts.empty());
    for (const Contact& contact : found.contacts) EXPECT_EQ(contact.tool, 1);
  }
}

TEST(ContactFinder, VertexThatIsNotFiniteLeavesNoTrace) {
  Sheet sheet = makeSheet(6, 0.005);
  const Vec3 neighbor = sheet.vertices[23];
  sheet.vertices[15].z() = kNaN;  // in the first triangles of vertex 23
  ContactFinder finder({makeTool({sphere(0.01)})});
  const ContactSet found = finder.find(at(makePose(neighbor)), sheet.surface, sheet.vertices);
  EXPECT_TRUE(std::any_of(found.contacts.begin(), found.contacts.end(),
                          [&](const Contact& c) { return c.point == neighbor; }));
  for (const Contact& contact : found.contacts) {
    EXPECT_TRUE(contact.point.allFinite() && contact.normal.allFinite());
    EXPECT_TRUE(std::isfinite(contact.depth_m));
  }
}

TEST(ContactFinder, SameQuestionSameAnswerBitForBit) {
  const Sheet sheet = makeSheet(10, 0.005);
  const std::vector<ToolGeometry> tools = {
      makeTool({sphere(0.004), mesh(writeStl("bits.stl", boxTriangles(Vec3(0.01, 0.01, 0.03))))})};
  ContactFinder first(tools), second(tools);
  const RobotPose pose = at(makePose(Vec3(0.021, 0.024, 0.002), 0.3, Vec3(1.0, 1.0, 1.0)));
  const ContactSet a = first.find(pose, sheet.surface, sheet.vertices);
  first.find(at(makePose(Vec3(0.03, 0.02, 0.0))), sheet.surface, sheet.vertices);
  const ContactSet again = first.find(pose, sheet.surface, sheet.vertices);
  const ContactSet b = second.find(pose, sheet.surface, sheet.vertices);
  ASSERT_GT(a.contacts.size(), 5U);
  for (const ContactSet* other : {&again, &b}) {
    ASSERT_EQ(other->contacts.size(), a.contacts.size());
    for (std::size_t i = 0; i < a.contacts.size(); ++i) {
      EXPECT_EQ(other->contacts[i].triangle, a.contacts[i].triangle);
      EXPECT_EQ(other->contacts[i].barycentric, a.contacts[i].barycentric);
      EXPECT_EQ(other->contacts[i].normal, a.contacts[i].normal);
      EXPECT_EQ(other->contacts[i].depth_m, a.contacts[i].depth_m);
    }
  }
}

std::string refusal(const ToolShape& shape, double padding = 0.0) {
  testing::internal::CaptureStderr();
  const std::string error = inputErrorOf([&] { ContactFinder({makeTool({shape}, padding)}); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  return error;
}

TEST(ContactFinder, MeshThatIsNotThereIsRefusedByName) {
  const std::string error = refusal(mesh("file:///nowhere/tip.stl"));
  EXPECT_NE(error.find("file:///nowhere/tip.stl"), std::string::npos) << error;
  EXPECT_NE(error.find("'probe'"), std::string::npos) << error;
}

TEST(ContactFinder, MeshAddressOfAnotherKindIsRefused) {
  for (const char* resource : {"", "tip.stl", "/tmp/tip.stl", "http://localhost/tip.stl"}) {
    const std::string error = refusal(mesh(resource));
    EXPECT_NE(error.find("package:// or file://"), std::string::npos) << error;
  }
}

TEST(ContactFinder, FlatMeshIsRefused) {
  const std::vector<Triangle> flat = {{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)}},
                                      {{Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}}};
  const std::string error = refusal(mesh(writeStl("flat.stl", flat)));
  EXPECT_NE(error.find("no volume"), std::string::npos) << error;
  ToolShape pressed = mesh(writeStl("pressed.stl", boxTriangles(Vec3(1.0, 1.0, 1.0))));
  pressed.scale.z() = 0.0;
  EXPECT_NE(refusal(pressed).find("no volume"), std::string::npos);
}

TEST(ContactFinder, MeasuresThatAreNotPositiveAreRefused) {
  EXPECT_NE(refusal(sphere(0.0)).find("sphere radius is 0"), std::string::npos);
  EXPECT_NE(refusal(sphere(kNaN)).find("sphere radius"), std::string::npos);
  EXPECT_NE(refusal(box(Vec3(0.1, -0.2, 0.1))).find("box size is -0.2"), std::string::npos);
  EXPECT_NE(refusal(cylinder(0.1, 0.0)).find("cylinder length is 0"), std::string::npos);
  EXPECT_NE(refusal(sphere(0.1), -0.001).find("padding is -0.001"), std::string::npos);
}

TEST(ContactFinder, MeshThatIsNotConvexIsReported) {
  std::vector<Triangle> corner = boxTriangles(Vec3(0.03, 0.01, 0.01));
  for (const Triangle& t : boxTriangles(Vec3(0.01, 0.02, 0.01), Vec3(-0.01, 0.015, 0.0))) {
    corner.push_back(t);
  }
  const ContactFinder bent({makeTool({mesh(writeStl("bent.stl", corner))})});
  ASSERT_EQ(bent.warnings().size(), 1U);
  EXPECT_NE(bent.warnings()[0].find("not convex"), std::string::npos) << bent.warnings()[0];
  const ContactFinder straight(
      {makeTool({mesh(writeStl("straight.stl", boxTriangles(Vec3(0.03, 0.01, 0.01))))})});
  EXPECT_TRUE(straight.warnings().empty());
}

TEST(ContactFinder, PoseOrSurfaceOfAnotherSizeIsRefused) {
  const Sheet sheet = makeSheet(2, 0.005);
  ContactFinder finder({makeTool({sphere(0.01)})});
  EXPECT_THROW(finder.find(RobotPose(), sheet.surface, sheet.vertices), InputError);
  EXPECT_THROW(finder.find(at(Pose::Identity()), sheet.surface, {Vec3::Zero()}), InputError);
}

}  // namespace
}  // namespace robot_tissue
