// Walls that a lattice cannot show are told when a scene is loaded, with how far they are off.
#include <gtest/gtest.h>

#include <filesystem>

#include "../core/mesh_fixtures.h"
#include "mesh_files.h"
#include "robot_tissue/core/mesh_walls.h"
#include "robot_tissue/scene/scene_parser.h"
#include "robot_tissue/scene/wall_remarks.h"

namespace robot_tissue::test_wall_remarks {
namespace {

TissueConfig tissueOf(const TriangleMesh& mesh, double spacing) {
  TissueConfig config;
  config.mesh = std::make_shared<const TriangleMesh>(mesh);
  config.spacing = spacing;
  config.material.poisson_ratio = 0.3;
  return config;
}

TriangleMesh sheet(double thickness, double degrees) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(degrees * M_PI / 180.0, Vec3::UnitY()).toRotationMatrix();
  return moved(boxMesh(Vec3::Zero(), Vec3(0.08, 0.06, thickness)), pose);
}

TEST(WallSamples, AreAsThickAsTheMesh) {
  for (const double degrees : {0.0, 30.0}) {
    double area = 0.0;
    for (const WallSample& wall : wallSamples(sheet(0.004, degrees))) {
      EXPECT_NEAR(wall.normal.norm(), 1.0, 1e-12);
      area += wall.area;
      const bool is_face = wall.area > 0.002;
      if (is_face) {
        EXPECT_NEAR(wall.thickness, 0.004, 1e-9);
      }
    }
    EXPECT_NEAR(area, 2.0 * (0.08 * 0.06 + 0.08 * 0.004 + 0.06 * 0.004), 1e-9);
  }
}

// A wedge of 60 degrees: thin at its edge, but no wall.
TEST(WallSamples, EdgesThatRunOutAreNone) {
  TriangleMesh wedge = boxMesh(Vec3::Zero(), Vec3(0.1, 0.1, 0.1));
  for (Vec3& vertex : wedge.vertices) {
    if (vertex.z() > 0.0) vertex.x() = 0.05;
  }
  wedge.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 6}, {1, 6, 4},
                     {0, 1, 4}, {2, 6, 3}, {0, 2, 3}, {0, 3, 1}};
  for (const WallSample& wall : wallSamples(refined(wedge, 0.01))) {
    EXPECT_GT(wall.thickness, 0.09);
  }
}

TEST(WallRemarks, TellThinWallsWithTheirNumber) {
  EXPECT_TRUE(wallRemarks(tissueOf(sheet(0.01, 0.0), 0.005)).empty());
  const auto thin = wallRemarks(tissueOf(sheet(0.005, 0.0), 0.005));
  ASSERT_EQ(thin.size(), 1U);
  EXPECT_NE(thin[0].text.find("the thinnest 5 mm"), std::string::npos) << thin[0].text;
  EXPECT_NE(thin[0].text.find("bend 97 to 130 % as far"), std::string::npos) << thin[0].text;
  const auto thinner = wallRemarks(tissueOf(sheet(0.0025, 45.0), 0.005));
  ASSERT_EQ(thinner.size(), 1U);
  EXPECT_NE(thinner[0].text.find("bend 71 to 128 % as far"), std::string::npos) << thinner[0].text;
  const auto sheer = wallRemarks(tissueOf(sheet(0.0005, 45.0), 0.005));
  ASSERT_EQ(sheer.size(), 1U);
  EXPECT_NE(sheer[0].text.find("bend 5 to 9 % as far"), std::string::npos) << sheer[0].text;
}

TEST(WallRemarks, TellObliqueWallsUpToWhereTheyBendAsTheyShould) {
  EXPECT_TRUE(wallRemarks(tissueOf(sheet(0.0075, 0.0), 0.005)).empty());
  EXPECT_TRUE(wallRemarks(tissueOf(sheet(0.0175, 45.0), 0.005)).empty());
  const auto told = wallRemarks(tissueOf(sheet(0.0125, 45.0), 0.005));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told[0].text.find("oblique to the grid"), std::string::npos) << told[0].text;
  EXPECT_NE(told[0].text.find("bend 98 to 106 % as far"), std::string::npos) << told[0].text;
  EXPECT_EQ(told[0].remedy, "tissue.spacing: 0.003125 or less");
}

TEST(WallRemarks, OfABlockAreOfItsThinnestSide) {
  TissueConfig block;
  block.shape.max() = Vec3(0.1, 0.1, 0.01);
  block.spacing = 0.005;
  EXPECT_TRUE(wallRemarks(block).empty());
  block.spacing = 0.01;
  EXPECT_EQ(wallRemarks(block).size(), 1U);
  block.model = "six_spring";
  EXPECT_TRUE(wallRemarks(block).empty());
}

TEST(WallRemarks, StandInTheScenesRemarks) {
  writeFile("sheet.stl", stlText(sheet(0.005, 0.0)));
  SceneSource source;
  source.name = "sheet.yaml";
  source.folder = meshFolder();
  for (const SceneUser user : {SceneUser::kRunner, SceneUser::kNode}) {
    source.user = user;
    const Scene scene = parseScene(YAML::Load("tissue:\n"
                                              "  shape: {type: mesh, resource: sheet.stl}\n"
                                              "  spacing: 0.005\n"
                                              "  material: {young_modulus: 1.0e+4}\n"),
                                   source);
    ASSERT_EQ(scene.remarks.size(), 1U);
    EXPECT_EQ(scene.remarks[0].rfind("sheet.yaml:3: tissue.spacing = 0.005: ", 0), 0U)
        << scene.remarks[0];
    EXPECT_NE(scene.remarks[0].find(
                  "97 to 145 % as far as they should; remedy: tissue.spacing: 0.0025 or less"),
              std::string::npos)
        << scene.remarks[0];
  }
}

TEST(WallRemarks, ShippedScenesHaveNone) {
  const std::string folder = std::string(ROBOT_TISSUE_SOURCE_DIR) + "/config";
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    const YAML::Node text = loadSceneText(entry.path().string());
    if (!text["tissue"]) continue;
    SceneSource source;
    source.name = entry.path().string();
    source.folder = folder;
    for (const SceneUser user : {SceneUser::kRunner, SceneUser::kNode}) {
      source.user = user;
      try {
        for (const WallRemark& remark : wallRemarks(parseScene(text, source).tissue)) {
          ADD_FAILURE() << source.name << ": " << remark.text;
        }
        ++scenes;
      } catch (const InputError&) {  // the other's scene
      }
    }
  }
  EXPECT_GE(scenes, 6);
}

}  // namespace
}  // namespace robot_tissue::test_wall_remarks
