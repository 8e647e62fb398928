#include <gtest/gtest.h>

#include <cmath>

#include "contact_fixtures.h"
#include "robot_tissue/contact/tool_geometry.h"

namespace robot_tissue::test_tool_geometry {
namespace {

using testing::internal::CaptureStderr;
using testing::internal::GetCapturedStderr;

const char* const kRobot = R"(<robot name="arm">
  <link name="base"/>
  <link name="tip">
    <collision name="ball"><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>
      <geometry><sphere radius="0.01"/></geometry></collision>
    <collision name="brick"><geometry><box size="0.1 0.2 0.3"/></geometry></collision>
    <collision><origin xyz="0 0 -0.5"/>
      <geometry><cylinder radius="0.004" length="0.05"/></geometry></collision>
    <collision>
      <geometry><mesh filename="package://arm/tip.stl" scale="0.001 0.002 -0.003"/></geometry>
    </collision>
  </link>
  <joint name="j" type="fixed"><parent link="base"/><child link="tip"/></joint>
</robot>)";

ToolConfig toolOn(const std::string& link) {
  ToolConfig config;
  config.name = "probe";
  config.links.resize(1);
  config.links[0].link = link;
  return config;
}

bool isOneLine(const std::string& text) {
  return !text.empty() && text.find('\n') == std::string::npos;
}

TEST(ToolGeometry, TakesEveryCollisionElementWithItsOrigin) {
  const LoadedTools loaded = loadTools(kRobot, {toolOn("tip")});
  EXPECT_TRUE(loaded.warnings.empty());
  ASSERT_EQ(loaded.tools.size(), 1U);
  EXPECT_EQ(loaded.tools[0].name, "probe");
  ASSERT_EQ(loaded.tools[0].links.size(), 1U);
  const LinkGeometry& tool = loaded.tools[0].links[0];
  EXPECT_EQ(tool.link, "tip");
  ASSERT_EQ(tool.shapes.size(), 4U);

  EXPECT_EQ(tool.shapes[0].type, ToolShape::Type::kSphere);
  EXPECT_DOUBLE_EQ(tool.shapes[0].radius, 0.01);
  const Vec3 moved = tool.shapes[0].pose * Vec3(1.0, 0.0, 0.0);
  EXPECT_NEAR((moved - Vec3(1.0, 3.0, 3.0)).norm(), 0.0, 1e-12);

  EXPECT_EQ(tool.shapes[1].type, ToolShape::Type::kBox);
  EXPECT_EQ(tool.shapes[1].size, Vec3(0.1, 0.2, 0.3));
  EXPECT_TRUE(tool.shapes[1].pose.isApprox(Pose::Identity()));

  EXPECT_EQ(tool.shapes[2].type, ToolShape::Type::kCylinder);
  EXPECT_DOUBLE_EQ(tool.shapes[2].radius, 0.004);
  EXPECT_DOUBLE_EQ(tool.shapes[2].length, 0.05);
  EXPECT_EQ(tool.shapes[2].pose.translation(), Vec3(0.0, 0.0, -0.5));

  EXPECT_EQ(tool.shapes[3].type, ToolShape::Type::kMesh);
  EXPECT_EQ(tool.shapes[3].resource, "package://arm/tip.stl");
  EXPECT_EQ(tool.shapes[3].scale, Vec3(0.001, 0.002, -0.003));
}

TEST(ToolGeometry, OverlayTakesThePlaceOfTheUrdfGeometry) {
  ToolConfig config = toolOn("tip");
  config.links[0].shapes = {sphere(0.03)};
  const LoadedTools loaded = loadTools(kRobot, {config});
  ASSERT_EQ(loaded.tools[0].links[0].shapes.size(), 1U);
  EXPECT_DOUBLE_EQ(loaded.tools[0].links[0].shapes[0].radius, 0.03);
}

TEST(ToolGeometry, OverlayGivesGeometryToABareLinkWithoutWarning) {
  ToolConfig config = toolOn("base");
  config.links[0].shapes = {sphere(0.03)};
  const LoadedTools loaded = loadTools(kRobot, {config});
  EXPECT_TRUE(loaded.warnings.empty());
  EXPECT_EQ(loaded.tools[0].links[0].shapes.size(), 1U);
}

TEST(ToolGeometry, BareLinkIsKeptAndWarnedOf) {
  const LoadedTools loaded = loadTools(kRobot, {toolOn("tip"), toolOn("base")});
  ASSERT_EQ(loaded.tools.size(), 2U);
  EXPECT_TRUE(loaded.tools[1].links[0].shapes.empty());
  ASSERT_EQ(loaded.warnings.size(), 1U);
  const std::string& warning = loaded.warnings[0];
  EXPECT_TRUE(isOneLine(warning));
  for (const char* word : {"'probe'", "'base'", "tools[1].links[0].shapes"}) {
    EXPECT_NE(warning.find(word), std::string::npos) << warning;
  }
}

TEST(ToolGeometry, ToolWithoutNameIsCalledLikeItsLink) {
  ToolConfig config = toolOn("tip");
  config.name.clear();
  EXPECT_EQ(loadTools(kRobot, {config}).tools[0].name, "tip");
}

TEST(ToolGeometry, UnknownLinkIsRefusedAndTheLinksThatExistAreListed) {
  ToolConfig config = toolOn("tool_tipp");
  config.links[0].shapes = {sphere(0.01)};  // an overlay does not make a link
  const std::string error = inputErrorOf([&] { loadTools(kRobot, {config}); });
  EXPECT_TRUE(isOneLine(error));
  for (const char* word : {"tools[0].links[0].link", "'probe'", "'tool_tipp'", "base, tip"}) {
    EXPECT_NE(error.find(word), std::string::npos) << error;
  }
}

TEST(ToolGeometry, LongListsOfLinksAreCutShort) {
  std::string robot = "<robot name='long'><link name='l0'/>";
  for (int i = 1; i < 20; ++i) {
    const std::string n = std::to_string(i);
    robot += "<link name='l" + n + "'/><joint name='j" + n +
             "' type='fixed'><parent link='l0'/><child link='l" + n + "'/></joint>";
  }
  const std::string error = inputErrorOf([&] { loadTools(robot + "</robot>", {toolOn("tip")}); });
  EXPECT_NE(error.find("(12 more)"), std::string::npos) << error;
}

TEST(ToolGeometry, TextThatIsNoUrdfIsRefusedInOneLineWithoutNoise) {
  for (const std::string& text : {std::string(), std::string("  \n"), std::string("no xml"),
                                  std::string("<robot name='r'><link")}) {
    CaptureStderr();
    const std::string error = inputErrorOf([&] { loadTools(text, {toolOn("tip")}); });
    EXPECT_EQ(GetCapturedStderr(), "");
    EXPECT_TRUE(isOneLine(error)) << text << "\n" << error;
    EXPECT_NE(error.find("robot_description"), std::string::npos) << error;
  }
}

// urdfdom only logs it and drops the element and all that follow.
TEST(ToolGeometry, FaultyCollisionElementIsRefusedUnlessOverlaid) {
  const std::string robot =
      "<robot name='r'><link name='tip'>"
      "<collision><geometry><sphere radius='0.1'/></geometry></collision>"
      "<collision><geometry><sphere/></geometry></collision></link></robot>";
  CaptureStderr();
  ToolConfig config = toolOn("tip");
  const std::string error = inputErrorOf([&] { loadTools(robot, {config}); });
  EXPECT_EQ(GetCapturedStderr(), "");
  EXPECT_TRUE(isOneLine(error));
  for (const char* word : {"'tip'", "radius"}) {
    EXPECT_NE(error.find(word), std::string::npos) << error;
  }
  config.links[0].shapes = {sphere(0.03)};
  EXPECT_EQ(loadTools(robot, {config}).tools[0].links[0].shapes.size(), 1U);
}

TEST(ToolGeometry, NoToolsNeedNoUrdf) { EXPECT_TRUE(loadTools("", {}).tools.empty()); }

TEST(ToolGeometry, PaddingsAddUp) {
  ToolConfig config = toolOn("tip");
  config.links[0].padding = 0.002;
  config.links[0].collision_padding = {{"brick", 0.0005}};
  const auto shapes = loadTools(kRobot, {config}).tools[0].links[0].shapes;
  ASSERT_EQ(shapes.size(), 4U);
  EXPECT_DOUBLE_EQ(shapes[0].padding, 0.002);
  EXPECT_DOUBLE_EQ(shapes[1].padding, 0.0025);
  EXPECT_DOUBLE_EQ(shapes[3].padding, 0.002);

  config = toolOn("tip");
  config.links[0].padding = 0.002;
  config.links[0].shapes = {sphere(0.03), sphere(0.01)};
  config.links[0].shapes[1].padding = 0.001;
  for (const LoadedTools& loaded : {loadTools(kRobot, {config}), toolsOf({config})}) {
    EXPECT_DOUBLE_EQ(loaded.tools[0].links[0].shapes[0].padding, 0.002);
    EXPECT_DOUBLE_EQ(loaded.tools[0].links[0].shapes[1].padding, 0.003);
  }
}

TEST(ToolGeometry, UnknownPaddedCollisionIsRefusedAndTheNamesAreListed) {
  ToolConfig config = toolOn("base");
  config.links.resize(2);
  config.links[1].link = "tip";
  config.links[1].collision_padding = {{"ball", 0.001}, {"brik", 0.001}};
  const std::string error = inputErrorOf([&] { loadTools(kRobot, {toolOn("tip"), config}); });
  EXPECT_TRUE(isOneLine(error));
  for (const char* word :
       {"tools[1].links[1].collision_padding", "'brik'", "'tip'", "ball, brick"}) {
    EXPECT_NE(error.find(word), std::string::npos) << error;
  }
  config = toolOn("base");
  config.links[0].collision_padding = {{"ball", 0.001}};
  EXPECT_NE(inputErrorOf([&] { loadTools(kRobot, {config}); }).find("no names"), std::string::npos);
}

TEST(ToolGeometry, PaddingOfCollisionsThatAnOverlayReplacesIsWarnedOf) {
  ToolConfig config = toolOn("tip");
  config.links[0].shapes = {sphere(0.03)};
  config.links[0].collision_padding = {{"ball", 0.001}};
  for (const LoadedTools& loaded : {loadTools(kRobot, {config}), toolsOf({config})}) {
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_NE(loaded.warnings[0].find("tools[0].links[0].collision_padding"), std::string::npos);
    EXPECT_EQ(loaded.tools[0].links[0].shapes[0].padding, 0.0);
  }
}

TEST(ToolGeometry, EveryLinkAndEntryIsTakenOver) {
  ToolConfig config = toolOn("base");
  config.name.clear();
  config.links.resize(3, config.links[0]);
  config.links[2].link = "tip";
  for (ToolLink& link : config.links) link.shapes = {sphere(0.01)};
  config.role = toolRole("grasper");
  config.patch = ToolConfig::Patch::kRigid;
  config.friction = 0.7;
  config.max_force = 5.0;
  config.grasp.close_gap = 0.001;
  for (const LoadedTools& loaded : {loadTools(kRobot, {config}), toolsOf({config})}) {
    const ToolGeometry& tool = loaded.tools[0];
    EXPECT_EQ(tool.name, "base");
    ASSERT_EQ(tool.links.size(), 3U);
    EXPECT_EQ(tool.links[2].link, "tip");
    EXPECT_TRUE(tool.role.has_jaws);
    EXPECT_EQ(tool.patch, ToolConfig::Patch::kRigid);
    EXPECT_EQ(tool.friction, 0.7);
    EXPECT_EQ(tool.max_force, 5.0);
    EXPECT_EQ(tool.grasp.close_gap, 0.001);
  }
}

TEST(ToolGeometry, GraspersOwnLinkIsAFrameUnlessItHasShapes) {
  ToolConfig grasper = toolOn("tip");
  grasper.role = toolRole("grasper");
  grasper.links = std::vector<ToolLink>(3, toolOn("tip").links.front());
  LoadedTools loaded = loadTools(kRobot, {grasper});
  EXPECT_TRUE(loaded.warnings.empty());
  EXPECT_EQ(loaded.tools[0].links[0].link, "tip");
  EXPECT_TRUE(loaded.tools[0].links[0].shapes.empty());
  EXPECT_FALSE(loaded.tools[0].links[1].shapes.empty());

  grasper.links[0].link = "";
  loaded = loadTools(kRobot, {grasper});
  EXPECT_TRUE(loaded.warnings.empty());
  EXPECT_EQ(loaded.tools[0].links.size(), 3U);

  grasper.links[0].link = "hand";
  EXPECT_THROW(loadTools(kRobot, {grasper}), InputError);

  grasper.links[0].link = "tip";
  grasper.links[0].shapes = {ToolShape{}};
  EXPECT_EQ(loadTools(kRobot, {grasper}).tools[0].links[0].shapes.size(), 1U);
}

TEST(ToolGeometry, WithoutUrdfToolsWithoutShapesAreWarnedOf) {
  ToolConfig bare = toolOn("");
  ToolConfig shaped = toolOn("");
  shaped.links[0].shapes = {sphere(0.01)};
  const LoadedTools loaded = toolsOf({shaped, bare});
  ASSERT_EQ(loaded.tools.size(), 2U);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("tools[1].links[0].shapes"), std::string::npos);
}

TEST(ToolGeometry, ToolWithoutLinksIsRefused) {
  ToolConfig config;
  EXPECT_NE(inputErrorOf([&] { toolsOf({config}); }).find("tools[0].links"), std::string::npos);
  EXPECT_NE(inputErrorOf([&] { loadTools(kRobot, {config}); }).find("tools[0].links"),
            std::string::npos);
}

}  // namespace
}  // namespace robot_tissue::test_tool_geometry
