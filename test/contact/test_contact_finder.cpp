#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "contact_fixtures.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue::test_contact_finder {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(ContactFinder, PointAtTheCenterOfASphereIsPushedIntoTheTissue) {
  const Sheet sheet = makeSheet(2, 0.005);
  const ContactFinder finder({makeTool({sphere(0.002)})});
  const ContactSet found =
      finder.find(at(makePose(sheet.vertices[4])), sheet.surface, sheet.vertices, 0.0);
  const auto center = std::find_if(found.contacts.begin(), found.contacts.end(),
                                   [&](const Contact& c) { return c.point == sheet.vertices[4]; });
  ASSERT_NE(center, found.contacts.end());
  EXPECT_DOUBLE_EQ(center->depth_m, 0.002);
  EXPECT_EQ(center->normal, Vec3(0.0, 0.0, -1.0));
}

TEST(ContactFinder, ContactsTellTheirTriangleAndNoPointTwice) {
  const Sheet sheet = makeSheet(10, 0.005);
  const ContactFinder finder({makeTool({sphere(0.004), cylinder(0.002, 0.03)}, 0.0005)});
  const ContactSet found = finder.find(at(makePose(Vec3(0.023, 0.026, 0.001), 0.4, Vec3::UnitX())),
                                       sheet.surface, sheet.vertices, 0.0);
  ASSERT_GT(found.contacts.size(), 5U);
  for (std::size_t i = 0; i < found.contacts.size(); ++i) {
    const Contact& contact = found.contacts[i];
    EXPECT_NEAR(contact.place.barycentric.sum(), 1.0, 1e-12);
    EXPECT_GE(contact.place.barycentric.minCoeff(), 0.0);
    const auto& corners = sheet.surface.triangles[static_cast<std::size_t>(contact.place.triangle)];
    Vec3 point = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      point += contact.place.barycentric[static_cast<int>(k)] *
               sheet.vertices[static_cast<std::size_t>(corners[k])];
    }
    EXPECT_NEAR((point - contact.point).norm(), 0.0, 1e-15);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT((found.contacts[j].point - contact.point).norm(), 1e-9);
    }
  }
}

TEST(ContactFinder, NothingIsFoundApart) {
  const Sheet sheet = makeSheet(6, 0.005);
  const ContactFinder finder({makeTool({sphere(0.01), box(Vec3(0.01, 0.01, 0.02))}, 0.001)});
  const auto count = [&](double height) {
    const Pose pose = makePose(Vec3(0.0125, 0.0125, height));
    return finder.find(at(pose), sheet.surface, sheet.vertices, 0.0).contacts.size();
  };
  EXPECT_EQ(count(0.01101), 0U);
  EXPECT_GT(count(0.01099), 0U);
}

TEST(ContactFinder, ToolWithoutShapesTouchesNothing) {
  const Sheet sheet = makeSheet(2, 0.005);
  const ContactFinder finder({makeTool({})});
  EXPECT_TRUE(
      finder.find(at(Pose::Identity()), sheet.surface, sheet.vertices, 0.0).contacts.empty());
}

TEST(ContactFinder, EachToolAnswersForItself) {
  const Sheet sheet = makeSheet(6, 0.005);
  const ContactFinder finder({makeTool({sphere(0.002)}), makeTool({sphere(0.003)})});
  RobotPose pose;
  pose.links = {makePose(Vec3(0.005, 0.005, 0.0)), makePose(Vec3(0.02, 0.02, 0.0))};
  const ContactSet found = finder.find(pose, sheet.surface, sheet.vertices, 0.0);
  int of_tool[2] = {0, 0};
  for (const Contact& contact : found.contacts) {
    ++of_tool[contact.tool];
    const Vec3 center = pose.links[static_cast<std::size_t>(contact.tool)].translation();
    EXPECT_LT((contact.point - center).norm(), contact.tool == 0 ? 0.002 : 0.003);
  }
  EXPECT_GT(of_tool[0], 0);
  EXPECT_GT(of_tool[1], 0);
}

TEST(ContactFinder, LinksOfAToolAreToldApartInOrder) {
  const Sheet sheet = makeSheet(6, 0.005);
  ToolGeometry jaws = makeTool({sphere(0.003)});
  jaws.links.push_back({"jaw", {cylinder(0.002, 0.01)}});
  const ContactFinder finder({makeTool({sphere(0.002)}), jaws});
  ASSERT_EQ(finder.linkCount(), 3U);
  RobotPose pose;
  pose.links = {makePose(Vec3(0.005, 0.005, 0.0)), makePose(Vec3(0.02, 0.005, 0.0)),
                makePose(Vec3(0.02, 0.02, 0.0))};
  const ContactSet found = finder.find(pose, sheet.surface, sheet.vertices, 0.0);
  std::pair<int, int> last(-1, -1);
  int links_seen = 0;
  for (const Contact& contact : found.contacts) {
    EXPECT_EQ(contact.tool, contact.link == 0 ? 0 : 1);
    const std::pair<int, int> place(contact.link, contact.place.triangle);
    EXPECT_GE(place, last);
    links_seen |= 1 << contact.link;
    last = place;
  }
  EXPECT_EQ(links_seen, 7);
}

TEST(ContactFinder, PoseThatIsNotFiniteOrRigidTouchesNothing) {
  const Sheet sheet = makeSheet(6, 0.005);
  const ContactFinder finder({makeTool({sphere(0.01)}), makeTool({sphere(0.01)})});
  const Pose good = makePose(Vec3(0.015, 0.015, 0.0));
  Pose not_finite = good;
  not_finite.translation().x() = kNaN;
  Pose collapsed = good;
  collapsed.linear().setZero();
  for (const Pose& bad : {not_finite, collapsed}) {
    RobotPose pose;
    pose.links = {bad, good};
    const ContactSet found = finder.find(pose, sheet.surface, sheet.vertices, 0.0);
    EXPECT_FALSE(found.contacts.empty());
    for (const Contact& contact : found.contacts) EXPECT_EQ(contact.tool, 1);
  }
}

TEST(ContactFinder, VertexThatIsNotFiniteLeavesNoTrace) {
  Sheet sheet = makeSheet(6, 0.005);
  const Vec3 neighbor = sheet.vertices[23];
  sheet.vertices[15].z() = kNaN;  // in the first triangles of vertex 23
  const ContactFinder finder({makeTool({sphere(0.01)})});
  const ContactSet found = finder.find(at(makePose(neighbor)), sheet.surface, sheet.vertices, 0.0);
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
  const ContactFinder first(tools), second(tools);
  const RobotPose pose = at(makePose(Vec3(0.021, 0.024, 0.002), 0.3, Vec3(1.0, 1.0, 1.0)));
  const ContactSet a = first.find(pose, sheet.surface, sheet.vertices, 0.0);
  first.find(at(makePose(Vec3(0.03, 0.02, 0.0))), sheet.surface, sheet.vertices, 0.0);
  const ContactSet again = first.find(pose, sheet.surface, sheet.vertices, 0.0);
  const ContactSet b = second.find(pose, sheet.surface, sheet.vertices, 0.0);
  ASSERT_GT(a.contacts.size(), 5U);
  for (const ContactSet* other : {&again, &b}) {
    ASSERT_EQ(other->contacts.size(), a.contacts.size());
    for (std::size_t i = 0; i < a.contacts.size(); ++i) {
      EXPECT_EQ(other->contacts[i].place.triangle, a.contacts[i].place.triangle);
      EXPECT_EQ(other->contacts[i].place.barycentric, a.contacts[i].place.barycentric);
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

TEST(ContactFinder, OpenMeshIsRefused) {
  std::vector<Triangle> open = boxTriangles(Vec3(0.01, 0.02, 0.03));
  open.pop_back();
  const std::string error = refusal(mesh(writeStl("open.stl", open)));
  for (const char* word : {"'probe'", "'tip'", "shape 1", "open.stl", "is not closed", "allowed is",
                           "closed mesh with volume"}) {
    EXPECT_NE(error.find(word), std::string::npos) << error;
  }
}

TEST(ContactFinder, MeasuresThatAreNotPositiveAreRefused) {
  EXPECT_NE(refusal(sphere(0.0)).find("sphere radius is 0"), std::string::npos);
  EXPECT_NE(refusal(sphere(kNaN)).find("sphere radius"), std::string::npos);
  EXPECT_NE(refusal(box(Vec3(0.1, -0.2, 0.1))).find("box size is -0.2"), std::string::npos);
  EXPECT_NE(refusal(cylinder(0.1, 0.0)).find("cylinder length is 0"), std::string::npos);
  EXPECT_NE(refusal(sphere(0.1), -0.001).find("padding is -0.001"), std::string::npos);
}

// As a URDF may have them, which no scene's ranges guard.
TEST(ContactFinder, MeasuresWithoutAMeaningAreRefused) {
  EXPECT_NE(refusal(sphere(1e15)).find("sphere radius is 1e+15; allowed is > 0, from 1e-09 to"),
            std::string::npos);
  EXPECT_NE(refusal(box(Vec3(0.1, 1e-30, 0.1))).find("box size is 1e-30"), std::string::npos);
  ToolShape far = sphere(0.1);
  far.pose.translation().x() = 1e15;
  EXPECT_NE(refusal(far).find("1e+15 m from its link"), std::string::npos);
  ToolShape huge = mesh(writeStl("grown.stl", boxTriangles(Vec3(1.0, 1.0, 1.0))));
  huge.scale *= 1e12;
  EXPECT_NE(refusal(huge).find("size of its mesh is 1e+12"), std::string::npos);
}

TEST(ContactFinder, PoseOrSurfaceOfAnotherSizeIsRefused) {
  const Sheet sheet = makeSheet(2, 0.005);
  const ContactFinder finder({makeTool({sphere(0.01)})});
  EXPECT_THROW(finder.find(RobotPose(), sheet.surface, sheet.vertices, 0.0), InputError);
  EXPECT_THROW(finder.find(at(Pose::Identity()), sheet.surface, {Vec3::Zero()}, 0.0), InputError);
}

}  // namespace
}  // namespace robot_tissue::test_contact_finder
