// Scenes whose tissue is a mesh: only nodes and cells that there are count.
#include <gtest/gtest.h>

#include "../core/mesh_fixtures.h"
#include "bad_scene.h"
#include "mesh_files.h"
#include "robot_tissue/core/lattice.h"

namespace robot_tissue::test_mesh_scene {
namespace {

// A ball of radius 33 mm: nodes from -35 to 35 mm, none in the corners of that box.
const std::string kBallScene = R"(tissue:
  shape: {type: mesh, resource: ball.stl, scale: 0.001}
  spacing: 0.01
  material: {young_modulus: 10000.0}
  regions:
    - {min: [-0.01, -0.01, -0.01], max: [0.01, 0.01, 0.01], young_modulus: 1.0e+5}
  fixed:
    - {min: [-1.0, -1.0, -1.0], max: [1.0, 1.0, -0.02]}
steps:
  - load:
      patches:
        - {name: punch, min: [-0.01, -0.01, 0.02], max: [0.01, 0.01, 0.04], displacement: [0.0, 0.0, -0.005]}
        - {name: side, min: [0.02, -0.01, -0.01], max: [0.04, 0.01, 0.04], force: [0.1, 0.0, 0.0]}
)";

class BallScene : public ::testing::Test {
 protected:
  void SetUp() override { writeFile("ball.stl", stlText(sphereMesh(33.0, 3))); }

  static Scene parsed(const std::string& text) {
    SceneSource source;
    source.name = "ball.yaml";
    source.folder = meshFolder();
    return parseScene(YAML::Load(text), source);
  }
  static void expectRefusal(const std::string& from, const std::string& to,
                            const std::vector<std::string>& fragments) {
    const std::string text = replaced(kBallScene, from, to);
    ASSERT_NE(text, "") << "the scene has no place '" << from << "'";
    std::string message;
    try {
      parsed(text);
    } catch (const InputError& error) {
      message = error.what();
    }
    EXPECT_EQ(message.rfind("ball.yaml:", 0), 0U) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& fragment : fragments) {
      EXPECT_NE(message.find(fragment), std::string::npos)
          << "'" << fragment << "' is not in: " << message;
    }
  }
};

TEST_F(BallScene, GivesTheMeshAndItsLattice) {
  const Scene scene = parsed(kBallScene);
  ASSERT_NE(scene.tissue.mesh, nullptr);
  EXPECT_EQ(scene.tissue.mesh->triangles.size(), 512U);
  EXPECT_NEAR(boundsOf(scene.tissue.mesh->vertices).max().x(), 0.033, 1e-8);
  const Lattice lattice(scene.tissue);
  EXPECT_NEAR(lattice.bounds().min().x(), -0.035, 1e-8);
  EXPECT_EQ(lattice.size(), (std::array<int, 3>{8, 8, 8}));
  EXPECT_LT(lattice.nodeCount(), 8 * 8 * 8);
}

TEST_F(BallScene, SpacingThatIsTooLargeOrMakesTooManyNodes) {
  expectRefusal("spacing: 0.01", "spacing: 0.07",
                {"tissue.spacing = 0.07", "at most the mesh's smallest extent, 0.066"});
  expectRefusal("spacing: 0.01", "spacing: 1.0e-5",
                {"tissue.spacing = 1.0e-5", "e+11 nodes", "than can be numbered",
                 "must be larger, or the mesh, 0.066 m across, smaller"});
  expectRefusal("spacing: 0.01", "spacing: 1.0e-12", {"tissue.spacing = 1.0e-12", "from 1e-06"});
}

// (0.03, 0.03, 0.03) is in the grid, but the ball has no cell there.
TEST_F(BallScene, BoxInAnEmptyCornerOfTheGridHoldsNoNode) {
  expectRefusal("max: [1.0, 1.0, -0.02]", "max: [-0.03, -0.03, -0.03]",
                {"tissue.fixed[0] = {min", "no node", "every 0.01 m"});
  expectRefusal("min: [-0.01, -0.01, 0.02], max: [0.01, 0.01, 0.04]",
                "min: [0.03, 0.03, 0.03], max: [0.04, 0.04, 0.04]",
                {"steps[0].load.patches[0] = {name: punch", "no node"});
  expectRefusal("min: [-0.01, -0.01, -0.01], max: [0.01, 0.01, 0.01], y",
                "min: [0.025, 0.025, 0.025], max: [0.035, 0.035, 0.035], y",
                {"tissue.regions[0] = {min", "no cell's center"});
}

std::string withTumor(const std::string& shape) {
  return "regions:\n    - {name: tumor, shape: {type: mesh, " + shape +
         "}, young_modulus: 1.0e+5}\n";
}

const std::string kBoxRegion =
    "regions:\n    - {min: [-0.01, -0.01, -0.01], max: [0.01, 0.01, 0.01], young_modulus: "
    "1.0e+5}\n";

// A file beside the scene, as the tissue's own; by each format.
TEST_F(BallScene, RegionsHaveShapes) {
  const TriangleMesh tumor = moved(sphereMesh(9.0, 2), Vec3(4, 5, 6));
  writeFile("tumor.stl", stlText(tumor));
  writeFile("tumor.obj", objText(tumor));
  writeFile("tumor.dae", daeText(tumor, "Z_UP", 1.0));
  for (const char* file : {"tumor.stl", "tumor.obj", "tumor.dae"}) {
    const Scene scene = parsed(replaced(
        kBallScene, kBoxRegion, withTumor("resource: " + std::string(file) + ", scale: 0.001")));
    ASSERT_EQ(scene.tissue.regions.size(), 1U);
    const Region& region = scene.tissue.regions[0];
    ASSERT_NE(region.mesh, nullptr) << file;
    EXPECT_NEAR(boundsOf(region.mesh->vertices).max().z(), 0.015, 1e-8) << file;
    EXPECT_EQ(region.material.young_modulus, 1e5);
  }
  const std::string shaped =
      "regions:\n    - {shape: {type: box, min: [-0.01, -0.01, -0.01], "
      "max: [0.01, 0.01, 0.01]}, young_modulus: 1.0e+5}\n";
  const Region box = parsed(replaced(kBallScene, kBoxRegion, shaped)).tissue.regions.at(0);
  EXPECT_EQ(box.mesh, nullptr);
  EXPECT_EQ(box.box.max(), Vec3::Constant(0.01));
}

TEST_F(BallScene, MeshesOfRegionsThatAreNoneAreRefusedByTheirKey) {
  TriangleMesh open = sphereMesh(9.0, 2);
  open.triangles.pop_back();
  writeFile("open.stl", stlText(open));
  writeFile("tumor.stl", stlText(sphereMesh(9.0, 2)));
  writeFile("far.stl", stlText(moved(sphereMesh(9.0, 2), Vec3(60, 0, 0))));
  // In the grid around the ball, in none of its cells.
  writeFile("corner.stl", stlText(moved(sphereMesh(3.0, 2), Vec3(31, 31, 31))));
  writeFile("around.stl", stlText(sphereMesh(50.0, 2)));
  writeFile("tumor.txt", stlText(sphereMesh(9.0, 2)));
  writeFile("words.stl", "no mesh");
  const std::string key = "tissue.regions[0].shape.resource = ";
  const auto refused = [&](const std::string& shape, const std::vector<std::string>& fragments) {
    expectRefusal(kBoxRegion, withTumor(shape), fragments);
  };
  const std::string scale = ", scale: 0.001";
  refused("resource: open.stl" + scale, {key + "open.stl: the mesh is not closed"});
  for (const std::string far : {"far.stl", "corner.stl"}) {
    refused("resource: " + far + scale, {key + far + ": the mesh encloses nothing of the tissue"});
  }
  refused("resource: around.stl" + scale,
          {key + "around.stl: the mesh encloses all of the tissue", "x -0.05 to 0.05"});
  refused("resource: tumor.stl", {key + "tumor.stl: the mesh encloses all", "x -9 to 9"});
  refused("resource: tumor.stl, scale: 1.0e+9", {"resource = tumor.stl: the mesh encloses all"});
  refused("resource: tumor.stl, scale: 0", {"tissue.regions[0].shape.scale = 0", "from 1e-09"});
  refused("resource: tumor.txt" + scale, {key + "tumor.txt", "neither in .stl nor .obj nor .dae"});
  refused("resource: words.stl" + scale, {key + "words.stl"});
  refused("resource: none.stl" + scale, {key + "none.stl: must be an existing file"});
  refused("resource: tumor.stl, min: [0, 0, 0]", {"tissue.regions[0].shape.min", "must be one of"});
  refused("resource: tumor.stl" + scale + "}, min: [0, 0, 0], max: {x: 0",
          {"tissue.regions[0].min = [0, 0, 0]: must not stand beside shape"});
}

// The second box reaches over the first one's, but at a height of 35 mm the ball has no node at
// x = 35 mm.
TEST_F(BallScene, PatchesShareOnlyNodesThatThereAre) {
  const std::string side = "min: [0.02, -0.01, -0.01], max: [0.04, 0.01, 0.04]";
  const std::string outer = "min: [0.03, -0.01, -0.01], max: [0.04, 0.01, 0.04]";
  const std::string punch = "min: [-0.01, -0.01, 0.02], max: [0.01, 0.01, 0.04]";
  const std::string wide = "min: [-0.01, -0.01, 0.03], max: [0.04, 0.01, 0.04]";
  EXPECT_NO_THROW(parsed(replaced(replaced(kBallScene, side, outer), punch, wide)));
  expectRefusal(
      side, "min: [0.0, -0.01, 0.0], max: [0.04, 0.01, 0.04]",
      {"steps[0].load.patches[1] = {name: side", "shares nodes with standing patch punch"});
}

TEST_F(BallScene, ToolsMeshWithoutAnInsideIsRefusedByItsKey) {
  const std::string steps = "steps:";
  const auto tool = [](const std::string& file) {
    return "tools:\n  - {name: probe, shapes: [{type: mesh, resource: " + file + "}]}\nsteps:";
  };
  TriangleMesh open = boxMesh(Vec3::Zero(), Vec3::Ones());
  TriangleMesh flat = open;
  open.triangles.pop_back();
  for (Vec3& vertex : flat.vertices) vertex.z() = 0.0;
  writeFile("tool.stl", stlText(boxMesh(Vec3::Zero(), Vec3::Ones())));
  writeFile("open.stl", stlText(open));
  writeFile("flat.stl", stlText(flat));
  writeFile("hollow.stl", "solid made\nendsolid made\n");
  EXPECT_NO_THROW(parsed(replaced(kBallScene, steps, tool("tool.stl"))));
  expectRefusal(
      steps, tool("open.stl"),
      {"tools[0].shapes[0].resource = open.stl: the mesh is not closed", "must be closed"});
  expectRefusal(
      steps, tool("flat.stl"),
      {"tools[0].shapes[0].resource = flat.stl: the mesh has no volume", "must be closed"});
  expectRefusal(steps, tool("hollow.stl"), {"tools[0].shapes[0].resource = hollow.stl", "must be"});
}

}  // namespace
}  // namespace robot_tissue::test_mesh_scene
