// Flat tools with sharp edges, that stand anywhere between the nodes (doc/contact.md, "The rim").
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_flat_tools {
namespace {

constexpr double kSticks = 2.0;  // friction at which nothing slides
const Vec3 kTool(0.02, 0.02, 0.02);

Vec3 placeOf(double depth, double shift) {
  return {kMiddle + shift, kMiddle + shift, kTop + 0.5 * kTool.z() - depth};
}

double forceOf(const Pipeline& pipeline) { return pipeline.report().tools[0].force_on_tool.z(); }

// Of a bonded patch of the tool's size, whose edges are right anywhere (test_patch_rim).
double patchForce(const TissueConfig& config, double depth) {
  Tissue tissue(config, SolverConfig());
  PatchConfig patch;
  patch.name = "plate";
  const Vec3 reach(0.5 * kTool.x() + 1e-9, 0.5 * kTool.y() + 1e-9, 1e-6);
  const Vec3 middle(kMiddle, kMiddle, kTop);
  patch.box = {middle - reach, middle + reach};
  patch.displacement = {0.0, 0.0, -depth};
  LoadStep step;
  step.patches.push_back(patch);
  tissue.load(step);
  return -tissue.answerOf("plate", tissue.lastReport()).force.z();
}

double pressedForce(const TissueConfig& config, const ToolGeometry& tool, double shift,
                    double depth) {
  Pipeline pipeline(config, SolverConfig(), {tool});
  walk(pipeline, {placeOf(-0.0005, shift)}, {placeOf(depth, shift)});
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk) << shift;
  return forceOf(pipeline);
}

TEST(FlatTools, SizeOfABoxIsNotOfTheNodes) {
  TissueConfig config = block();
  for (const double poisson : {0.25, 0.45}) {
    config.material.poisson_ratio = poisson;
    const double right = patchForce(config, 0.001);
    ASSERT_GT(right, 0.1);
    for (const double shift : {0.0, 0.2, 0.5, 0.8}) {
      const double force = pressedForce(config, withFriction(kSticks, toolOf(boxOf(kTool))),
                                        shift * kSpacing, 0.001);
      EXPECT_NEAR(force, right, 0.03 * right) << "nu " << poisson << ", shift " << shift;
    }
  }
}

// The same at each 90 degrees, and of the same box as several shapes side by side.
TEST(FlatTools, CornersAreAlike) {
  Pipeline pipeline(block(), SolverConfig(), {withFriction(kSticks, toolOf(boxOf(kTool)))});
  walk(pipeline, {placeOf(-0.0005, 0.0)}, {placeOf(0.002, 0.0)});
  const ToolReport& tool = pipeline.report().tools[0];
  EXPECT_LT(tool.force_on_tool.head<2>().norm(), 0.02 * tool.force_on_tool.z());
}

// Shapes of one link whose faces are parts of one press as one, in any order.
TEST(FlatTools, SeamsDoNotPress) {
  const auto pressedBy = [](const std::vector<ToolShape>& shapes) {
    ToolGeometry tool = withFriction(0.0, toolOf(shapes.front()));
    tool.links.front().shapes = shapes;
    Pipeline pipeline(block(), SolverConfig(), {tool});
    walk(pipeline, {placeOf(-0.0005, 0.0013)}, {placeOf(0.003, 0.0013)});
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
    EXPECT_LT(pipeline.report().tools[0].max_penetration, 0.05 * kSpacing);
    return pipeline.report().tools[0].force_on_tool;
  };
  const Vec3 whole = pressedBy({boxOf(kTool)});
  const Vec3 half(0.5 * kTool.x(), kTool.y(), kTool.z()), aside(0.25 * kTool.x(), 0.0, 0.0);
  const ToolShape left = boxOf(half, -aside), right = boxOf(half, aside);
  const ToolShape inside = boxOf(Vec3(0.01, 0.01, kTool.z()));
  for (const auto& shapes : std::vector<std::vector<ToolShape>>{
           {left, right}, {right, left}, {boxOf(kTool), inside}, {inside, boxOf(kTool)}}) {
    const Vec3 force = pressedBy(shapes);
    EXPECT_NEAR(force.z(), whole.z(), 0.01 * whole.z());
    EXPECT_LT(force.head<2>().norm(), 0.01 * whole.z());
  }
}

// A box that is narrower than two columns of nodes, one on its edge and a ball have no rim.
TEST(FlatTools, TouchesOfOtherToolsDoNotGiveWay) {
  const auto gives_way = [](ToolShape shape) {
    Pipeline pipeline(block(), SolverConfig(), {withFriction(kSticks, toolOf(shape))});
    walk(pipeline, {placeOf(-0.0005, 0.001)}, {placeOf(0.002, 0.001)});
    EXPECT_GT(forceOf(pipeline), 0.0);
    const auto& patches = pipeline.tissue().patches();
    return std::any_of(patches.begin(), patches.end(), [](const LoadingPatch& patch) {
      return std::any_of(patch.contacts.begin(), patch.contacts.end(),
                         [](const auto& spring) { return spring.shown_compliance > 0.0; });
    });
  };
  EXPECT_TRUE(gives_way(boxOf(kTool)));
  EXPECT_FALSE(gives_way(boxOf(Vec3(0.004, 0.004, 0.02))));
  ToolShape on_edge = boxOf(Vec3::Constant(0.02 / std::sqrt(2.0)));
  on_edge.pose.linear() = Eigen::AngleAxisd(M_PI / 4, Vec3::UnitY()).toRotationMatrix();
  EXPECT_FALSE(gives_way(on_edge));
}

// An edge goes from one column of nodes to the next, and the force goes on.
TEST(FlatTools, ForceIsSmoothAsEdgesPassNodes) {
  Pipeline pipeline(block(), SolverConfig(), {withFriction(0.0, toolOf(boxOf(kTool)))});
  walk(pipeline, {placeOf(-0.0005, 0.0)}, {placeOf(0.001, 0.0)});
  const double start = forceOf(pipeline);
  double last = start, greatest_jump = 0.0;
  for (int step = 1; step <= 20; ++step) {
    pipeline.step(at({placeOf(0.001, 0.00025 * step)}));
    greatest_jump = std::max(greatest_jump, std::abs(forceOf(pipeline) - last));
    last = forceOf(pipeline);
    EXPECT_NEAR(last, start, 0.08 * start) << step;
  }
  EXPECT_LT(greatest_jump, 0.02 * start);
}

// What is drawn has the tool's edges in it, also while they pass columns of vertices: no point of
// the tool stands in it. Nodes are shown where they are.
TEST(FlatTools, EdgesAreDrawnAnywhere) {
  ToolShape rod;
  rod.type = ToolShape::Type::kCylinder;
  rod.radius = 0.01;
  rod.length = kTool.z();
  for (const auto& [shape, most] : {std::pair(boxOf(kTool), 0.02), std::pair(rod, 0.06)}) {
    Pipeline pipeline(block(), SolverConfig(), {withFriction(0.0, toolOf(shape))});
    walk(pipeline, {placeOf(-0.0005, 0.0)}, {placeOf(0.004, 0.0)});
    for (int step = 0; step <= 20; ++step) {
      pipeline.step(at({placeOf(0.004, 0.05 * kSpacing * step)}));
      EXPECT_LT(pipeline.report().tools[0].max_penetration, most * kSpacing) << step;
    }
    const std::vector<Vec3> shown = pipeline.tissue().shownDisplacement();
    const std::vector<Vec3>& own = pipeline.tissue().state().displacement;
    for (std::size_t node = 0; node < own.size(); ++node) {
      ASSERT_LT((shown[node] - own[node]).head<2>().norm(), 1e-3 * kSpacing) << node;
    }
  }
}

// What its rim and its side touch is drawn at its edge, three spacings deep, too: of a vertex that
// both touch, as the rim has it.
TEST(FlatTools, AnUprightCylinderIsDrawnAtItsEdgeHoweverDeep) {
  ToolShape shape;
  shape.type = ToolShape::Type::kCylinder;
  shape.radius = 0.008;
  shape.length = 0.05;
  Pipeline pipeline(block(), SolverConfig(), {withFriction(0.3, toolOf(shape))});
  const double up = kTop + 0.5 * shape.length;
  for (double depth = -0.0005; depth < 0.0151; depth += 0.00025) {
    pipeline.step(at(std::vector<Vec3>{{kMiddle, kMiddle, up - depth}}));
    EXPECT_LT(pipeline.report().tools.front().max_penetration, 0.1 * kSpacing) << depth;
  }
}

TEST(FlatTools, CornersAreDrawn) {
  for (const double shift : {0.0, 0.1, 0.3, 0.5, 0.7}) {
    Pipeline pipeline(block(), SolverConfig(), {withFriction(0.0, toolOf(boxOf(kTool)))});
    walk(pipeline, {placeOf(-0.0005, shift * kSpacing)}, {placeOf(0.003, shift * kSpacing)});
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        const Vec3 corner = placeOf(0.003, shift * kSpacing) + kTool.cwiseProduct(Vec3(x, y, -0.5));
        double nearest = kSpacing;
        for (const Vec3& vertex : pipeline.tissue().vertices()) {
          nearest = std::min(nearest, (vertex - corner).norm());
        }
        EXPECT_LT(nearest, 0.03 * kSpacing) << shift;
      }
    }
  }
}

// Without friction the way to a place does not count.
TEST(FlatTools, DraggedToAPlaceIsPressedThere) {
  const ToolGeometry tool = withFriction(0.0, toolOf(boxOf(kTool)));
  constexpr double kDepth = 0.003;
  Pipeline pipeline(block(), SolverConfig(), {tool});
  walk(pipeline, {placeOf(-0.0005, -0.004)}, {placeOf(kDepth, -0.004)});
  walk(pipeline, {placeOf(kDepth, -0.004)}, {placeOf(kDepth, 0.5 * kSpacing)});
  const double right = pressedForce(block(), tool, 0.5 * kSpacing, kDepth);
  EXPECT_NEAR(forceOf(pipeline), right, 0.01 * right);
}

}  // namespace
}  // namespace robot_tissue::test_flat_tools
