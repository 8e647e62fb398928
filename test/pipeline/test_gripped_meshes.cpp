// What jaws hold of a mesh: what is between them, wherever its faces are between the nodes.
#include <gtest/gtest.h>

#include <memory>

#include "../core/mesh_fixtures.h"
#include "pipeline_fixtures.h"

namespace robot_tissue::test_gripped_meshes {
namespace {

const Vec3 kWall(0.051, 0.01275, 0.0255);  // m
const Vec3 kPad(0.016, 0.008, 0.01);

ToolGeometry padsOfForceps() {
  ToolGeometry tool;
  tool.name = "forceps";
  tool.role = toolRole("grasper");
  tool.links = {{"left", {boxOf(kPad, Vec3::Zero())}}, {"right", {boxOf(kPad, Vec3::Zero())}}};
  tool.grasp.close_gap = kWall.y() - 0.0005;
  tool.grasp.open_gap = kWall.y() + 0.002;
  return tool;
}

// Around the top of the wall, so far apart and so much lifted (m).
std::vector<Vec3> padsAt(double gap, double lift) {
  const double aside = 0.5 * (gap + kPad.y()), height = kWall.z() - 0.004 + lift;
  return {Vec3(0.5 * kWall.x(), 0.5 * kWall.y() - aside, height),
          Vec3(0.5 * kWall.x(), 0.5 * kWall.y() + aside, height)};
}

// N, on the jaws, to lift what they hold by 2 mm.
double liftingForce(double spacing, bool as_mesh) {
  TissueConfig tissue;
  tissue.shape = {Vec3::Zero(), kWall};
  if (as_mesh) tissue.mesh = std::make_shared<const TriangleMesh>(boxMesh(Vec3::Zero(), kWall));
  tissue.spacing = spacing;
  tissue.material.young_modulus = 1e4;
  tissue.material.poisson_ratio = 0.45;
  tissue.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, 1e-6)});
  Pipeline pipeline(tissue, SolverConfig(), {padsOfForceps()});
  walk(pipeline, padsAt(kWall.y() + 0.006, 0.0), padsAt(kWall.y() - 0.001, 0.0));
  EXPECT_TRUE(pipeline.report().tools.front().grasps) << spacing;
  walk(pipeline, padsAt(kWall.y() - 0.001, 0.0), padsAt(kWall.y() - 0.001, 0.002));
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << spacing;
  return -pipeline.report().tools.front().force_on_tool.z();
}

// When all nodes went with the jaws on which touched points hang, it was up to three times that.
TEST(GrippedMeshes, PullAsWhereTheLatticeFits) {
  const double fitting = liftingForce(0.00255, false);
  EXPECT_GT(fitting, 0.4);
  for (const double spacing : {0.004, 0.0045, 0.005, 0.006}) {
    EXPECT_NEAR(liftingForce(spacing, true) / fitting, 1.0, 0.2) << spacing;
  }
}

}  // namespace
}  // namespace robot_tissue::test_gripped_meshes
