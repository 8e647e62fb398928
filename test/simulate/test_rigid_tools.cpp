// A box that tissue sticks to is a loading patch of the same size: it feels the same.
#include <gtest/gtest.h>

#include <memory>

#include "core/mesh_fixtures.h"
#include "tool_scenes.h"

namespace robot_tissue::test_rigid_tools {
namespace {

constexpr double kWidth = 0.02, kPressed = 0.0015, kDrawn = 0.003;
const Vec3 kSize(0.051, 0.051, 0.0255);

Scene tissueWith(const std::string& steps, double spacing) {
  return sceneOf("tissue:\n  shape: {type: box, min: [0, 0, 0], max: " + list(kSize) + "}\n" +
                 "  spacing: " + std::to_string(spacing) + "\n" +
                 "  material: {young_modulus: 10000.0, poisson_ratio: 0.45}\n"
                 "  fixed: [{min: [-1, -1, -1], max: [1, 1, 1.0e-6]}]\n"
                 "solver: {tolerance: 0.003}\n" +
                 steps);
}

// Pressed, then drawn along x: forces on the tissue (N) after each. The box stands `aside` of the
// middle along x.
struct Forces {
  Vec3 pressed = Vec3::Zero(), drawn = Vec3::Zero();
};

Forces asPatch(double spacing, double aside) {
  const Vec3 half(0.5 * kWidth, 0.5 * kWidth, 1e-6);
  const Vec3 middle(0.5 * kSize.x() + aside, 0.5 * kSize.y(), kSize.z());
  const std::string patch = "  - load: {patches: [{name: p, min: " + list(middle - half) +
                            ", max: " + list(middle + half) + ", displacement: ";
  const RunResult result =
      runScene(tissueWith("steps:\n" + patch + list(Vec3(0.0, 0.0, -kPressed)) + "}]}\n" + patch +
                              list(Vec3(kDrawn, 0.0, -kPressed)) + "}]}\n",
                          spacing));
  Forces forces;
  for (const PatchRow& row : result.patches) {
    (row.step == 0 ? forces.pressed : forces.drawn) = row.answer.force;
  }
  return forces;
}

Forces asTool(bool is_mesh, double spacing, double aside) {
  const Vec3 above(0.5 * kSize.x() + aside, 0.5 * kSize.y(), kSize.z() + 0.5 * kWidth);
  const Vec3 pressed = above - Vec3(0.0, 0.0, kPressed);
  const std::string box =
      "tools: [{name: p, patch: rigid, shapes: [{type: box, size: " + list(Vec3::Constant(kWidth)) +
      "}]}]\nsteps:\n";
  Scene scene = tissueWith(box + placed("p", above + Vec3(0.0, 0.0, 0.0002), pressed, 4) +
                               moved("p", pressed + Vec3(kDrawn, 0.0, 0.0), 9),
                           is_mesh ? 0.0051 : spacing);
  if (is_mesh) {
    scene.tissue.mesh = std::make_shared<const TriangleMesh>(boxMesh(Vec3::Zero(), kSize));
    scene.tissue.spacing = spacing;
  }
  const RunResult result = runScene(scene);
  return {-rowsOf(result, 0, "p").back().force, -rowsOf(result, 1, "p").back().force};
}

void expectNear(const Forces& tool, const Forces& patch, double share) {
  EXPECT_NEAR(tool.pressed.z(), patch.pressed.z(), share * patch.pressed.norm());
  EXPECT_NEAR(tool.drawn.x(), patch.drawn.x(), share * patch.drawn.x());
  EXPECT_NEAR(tool.drawn.z(), patch.drawn.z(), share * patch.pressed.norm());
}

TEST(RigidTools, ABoxOnABlockFeelsWhatAPatchDoesWhereverItsEdgesAre) {
  for (const double aside : {0.0, 0.0013, 0.0025}) {
    SCOPED_TRACE(aside);
    expectNear(asTool(false, 0.0051, aside), asPatch(0.00255, aside), 0.04);
  }
}

// Held by all nodes around its points it would feel 60 to 90 % too much.
TEST(RigidTools, ABoxOnAMeshFeelsWhatAPatchDoes) {
  for (const double spacing : {0.004, 0.005}) {
    SCOPED_TRACE(spacing);
    expectNear(asTool(true, spacing, 0.0013), asPatch(0.00255, 0.0013), 0.08);
  }
}

}  // namespace
}  // namespace robot_tissue::test_rigid_tools
