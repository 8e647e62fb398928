// Flat tools on tissue whose shape is a mesh, no node of which is on the surface (doc/contact.md,
// "The rim"): they feel what they feel on a block.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "../core/mesh_fixtures.h"
#include "pipeline_fixtures.h"

namespace robot_tissue::test_flat_tools_on_meshes {
namespace {

constexpr double kSticks = 2.0;  // friction at which nothing slides
const Vec3 kSize(0.051, 0.051, 0.0255);

TissueConfig blockOf(double spacing, const Vec3& size = kSize) {
  TissueConfig tissue;
  tissue.shape.max() = size;
  tissue.spacing = spacing;
  tissue.material.young_modulus = 1e4;
  tissue.material.poisson_ratio = 0.45;
  tissue.fixed.push_back({Vec3(-1, -1, -1), Vec3(1, 1, 1e-6)});  // nodes below a mesh, too
  return tissue;
}

TissueConfig meshOf(double spacing, const Vec3& size = kSize) {
  TissueConfig tissue = blockOf(spacing, size);
  tissue.mesh = std::make_shared<const TriangleMesh>(boxMesh(Vec3::Zero(), size));
  return tissue;
}

// Their lower ends at the origin.
ToolShape cube() { return boxOf(Vec3::Constant(0.02), Vec3(0.0, 0.0, 0.01)); }
ToolShape rod() { return uprightCylinder(0.008, 0.02); }

Vec3 placeOf(double depth, double x, double y = 0.5 * kSize.y()) {
  return {x, y, kSize.z() - depth};
}

double forceOf(const Pipeline& pipeline) { return pipeline.report().tools[0].force_on_tool.z(); }

double pressedForce(const TissueConfig& tissue, const ToolShape& shape, double x, double y) {
  Pipeline pipeline(tissue, SolverConfig(), {withFriction(kSticks, toolOf(shape))});
  walk(pipeline, {placeOf(-0.0005, x, y)}, {placeOf(0.0015, x, y)});
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << x;
  return forceOf(pipeline);
}

// Held on both sides of its edge they felt 17 to 42 % too much.
TEST(FlatToolsOnMeshes, FeelAFineBlock) {
  const double middle = 0.5 * kSize.x();
  for (const ToolShape& shape : {cube(), rod()}) {
    for (const double off : {0.0, 0.0016}) {
      const double x = middle + off, y = middle - 0.5 * off;
      const double right = pressedForce(blockOf(0.00255), shape, x, y);
      for (const double spacing : {0.005, 0.004}) {
        const double force = pressedForce(meshOf(spacing), shape, x, y);
        EXPECT_NEAR(force, right, 0.09 * right) << "spacing " << spacing << ", off " << off;
      }
    }
  }
}

// Beyond an edge where the tissue ends nothing holds it, and there is no rim.
TEST(FlatToolsOnMeshes, FeelTheEndOfTheTissue) {
  for (const double beyond : {0.0, 0.005}) {
    const double x = kSize.x() - 0.01 + beyond, y = 0.5 * kSize.y();
    const double right = pressedForce(blockOf(0.00255), cube(), x, y);
    const double force = pressedForce(meshOf(0.005), cube(), x, y);
    EXPECT_NEAR(force, right, 0.09 * right) << beyond;
  }
}

// An edge goes from one column of nodes to the next, and the force goes on.
TEST(FlatToolsOnMeshes, ForceIsSmoothAsEdgesPassColumns) {
  const double spacing = 0.005, x = 0.024;
  for (const ToolShape& shape : {cube(), rod()}) {
    Pipeline pipeline(meshOf(spacing), SolverConfig(), {withFriction(0.0, toolOf(shape))});
    walk(pipeline, {placeOf(-0.0005, x)}, {placeOf(0.0015, x)});
    const double start = forceOf(pipeline);
    double last = start, greatest_jump = 0.0;
    for (int step = 1; step <= 20; ++step) {
      pipeline.step(at({placeOf(0.0015, x + 0.05 * spacing * step)}));
      greatest_jump = std::max(greatest_jump, std::abs(forceOf(pipeline) - last));
      last = forceOf(pipeline);
      EXPECT_NEAR(last, start, 0.08 * start) << step;
    }
    EXPECT_LT(greatest_jump, 0.03 * start);
  }
}

// Mean of the force on the tool's way, and its greatest jump there (N).
std::pair<double, double> draggedForce(const TissueConfig& tissue, const ToolShape& shape) {
  Pipeline pipeline(tissue, SolverConfig(), {withFriction(0.3, toolOf(shape))});
  walk(pipeline, {placeOf(-0.0005, 0.024)}, {placeOf(0.003, 0.024)});
  double last = forceOf(pipeline), sum = 0.0, greatest_jump = 0.0;
  const int steps = 24;
  for (int step = 1; step <= steps; ++step) {
    pipeline.step(at({placeOf(0.003, 0.024 + 0.00025 * step)}));
    greatest_jump = std::max(greatest_jump, std::abs(forceOf(pipeline) - last));
    last = forceOf(pipeline);
    sum += last / steps;
  }
  return {sum, greatest_jump};
}

TEST(FlatToolsOnMeshes, AreDraggedAsOnABlock) {
  for (const ToolShape& shape : {cube(), rod()}) {
    const auto [right, of_block] = draggedForce(blockOf(0.0051), shape);
    const auto [force, jump] = draggedForce(meshOf(0.005), shape);
    EXPECT_NEAR(force, right, 0.07 * right);
    EXPECT_LT(jump, 0.04 * right);
  }
}

// The surface is shown where the tool has it, though its nodes are not there.
TEST(FlatToolsOnMeshes, StandOnWhatIsShown) {
  const double spacing = 0.005, x = 0.0271, depth = 0.0015;
  Pipeline pipeline(meshOf(spacing), SolverConfig(), {withFriction(kSticks, toolOf(cube()))});
  walk(pipeline, {placeOf(-0.0005, x)}, {placeOf(depth, x)});
  for (const Vec3& vertex : pipeline.tissue().vertices()) {
    const Vec3 off = vertex - placeOf(depth, x);
    if (off.head<2>().cwiseAbs().maxCoeff() > 0.01 - 0.3 * spacing) continue;
    EXPECT_LT(off.z(), 0.03 * spacing) << vertex.transpose();
  }
}

// There vertices are nodes, and have the law themselves.
TEST(FlatToolsOnMeshes, BlocksHaveNoColumns) {
  const auto has_columns = [](const TissueConfig& tissue) {
    Pipeline pipeline(tissue, SolverConfig(), {withFriction(kSticks, toolOf(cube()))});
    walk(pipeline, {placeOf(-0.0005, 0.0271)}, {placeOf(0.0015, 0.0271)});
    const std::vector<LoadingPatch>& patches = pipeline.tissue().patches();
    return std::any_of(patches.begin(), patches.end(), [](const LoadingPatch& patch) {
      return std::any_of(patch.contacts.begin(), patch.contacts.end(),
                         [](const auto& spring) { return !spring.carrier_ways.empty(); });
    });
  };
  EXPECT_TRUE(has_columns(meshOf(0.005)));
  EXPECT_FALSE(has_columns(blockOf(0.0051)));
}

}  // namespace
}  // namespace robot_tissue::test_flat_tools_on_meshes
