// After a reset, a loaded state or other tools the pipeline goes as a fresh one, bit for bit: what
// was before, drags and cuts among it, is no matter.
#include <memory>

#include "../contact/contact_fixtures.h"
#include "pipeline_fixtures.h"

namespace robot_tissue::test_begin_anew {
namespace {

// A box on its edge: it drags, and tissue slips off it.
ToolGeometry edge() {
  ToolShape box = boxOf(Vec3::Constant(0.02));
  box.pose.linear() = Eigen::AngleAxisd(0.25 * M_PI, Vec3::UnitY()).toRotationMatrix();
  box.pose.translation().z() = 0.01 * std::sqrt(2.0);
  return toolOf(box);
}

// A ball narrower than a spacing, on which touches are recessed.
ToolGeometry stylus() {
  ToolShape ball;
  ball.radius = 0.0015;
  ball.pose.translation().z() = ball.radius;
  return toolOf(ball);
}

// What was found beside a mesh is followed from search to search.
ToolGeometry spike() {
  ToolShape point = mesh(writeStl("begin_anew.stl", ballTriangles(12, 0.008)));
  point.pose.translation().z() = 0.008;
  return toolOf(point);
}

// With a rim on the tissue.
ToolGeometry stamp() { return toolOf(uprightCylinder(0.012, 0.03)); }

struct Way {
  std::string name;
  ToolGeometry (*tool)() = nullptr;
  double depth = 0.0;  // m
};

RobotPose lowest(double x, double depth) { return at({Vec3(x, kMiddle + 0.0011, kTop - depth)}); }

class BeginAnew : public ::testing::TestWithParam<Way> {
 protected:
  static std::unique_ptr<Pipeline> fresh() {
    return std::make_unique<Pipeline>(block(), methodOf("elastic"), tools());
  }
  static std::vector<ToolGeometry> tools() { return {withFriction(0.3, GetParam().tool())}; }

  // Presses in at once and drags: the force and the shape after each step.
  static std::vector<Vec3> pressAndDrag(Pipeline& pipeline) {
    std::vector<Vec3> all;
    for (int step = -1; step <= 14; ++step) {
      const double x = 0.0213 + 0.001 * std::max(0, step - 2);
      pipeline.step(lowest(x, step < 0 ? -0.01 : GetParam().depth * std::min(1.0, 0.5 * step)));
      all.push_back(pipeline.report().tools.front().force_on_tool);
      const std::vector<Vec3>& shape = pipeline.tissue().state().displacement;
      all.insert(all.end(), shape.begin(), shape.end());
    }
    return all;
  }
  // Ends deep in the tissue.
  static void drag(Pipeline& pipeline) {
    pressAndDrag(pipeline);
    for (int i = 1; i <= 4; ++i) pipeline.step(lowest(0.0333, (1.0 + 0.2 * i) * GetParam().depth));
  }
  static void cut(Pipeline& pipeline) {
    const double x = 0.0475;  // between nodes
    pipeline.cut({Vec3(x, -1.0, 0.01), Vec3(x, 1.0, 0.01), Vec3(x, 1.0, 1.0), Vec3(x, -1.0, 1.0)});
  }
};

TEST_P(BeginAnew, AfterAReset) {
  const auto pipeline = fresh(), once = fresh();
  drag(*pipeline);
  pipeline->reset();
  EXPECT_EQ(pressAndDrag(*pipeline), pressAndDrag(*once));
}

TEST_P(BeginAnew, AfterAResetOfCutTissue) {
  const auto pipeline = fresh(), once = fresh();
  drag(*pipeline);
  cut(*pipeline);
  drag(*pipeline);
  pipeline->reset();
  EXPECT_EQ(pressAndDrag(*pipeline), pressAndDrag(*once));
}

// What the first cut after it changes little, the solver knew before.
TEST_P(BeginAnew, AfterAResetWithTheSameCutsAgain) {
  const auto pipeline = fresh(), once = fresh();
  const auto way = [](Pipeline& of) {
    pressAndDrag(of);
    of.cut({Vec3(0.0025, -1.0, 0.0375), Vec3(0.0025, 0.0075, 0.0375), Vec3(0.0025, 0.0075, 1.0),
            Vec3(0.0025, -1.0, 1.0)});
    return pressAndDrag(of);
  };
  way(*pipeline);
  pipeline->undo(1);
  pipeline->reset();
  EXPECT_EQ(way(*pipeline), way(*once));
}

TEST_P(BeginAnew, InALoadedState) {
  const auto pipeline = fresh(), once = fresh();
  cut(*once);
  const std::string state = once->tissue().savedState();
  for (const bool drags : {true, false}) {
    Pipeline& of = drags ? *pipeline : *once;
    if (drags) drag(of);
    of.loadState(state);
  }
  EXPECT_EQ(pressAndDrag(*pipeline), pressAndDrag(*once));
}

TEST_P(BeginAnew, WithOtherTools) {
  const auto pipeline = fresh(), once = fresh();
  drag(*pipeline);
  pipeline->step(lowest(0.0333, -0.02));
  ASSERT_EQ(greatestDisplacement(pipeline->tissue()), 0.0);
  pipeline->setTools(tools());
  EXPECT_EQ(pressAndDrag(*pipeline), pressAndDrag(*once));
}

// Jaws that overlap from the first pose on are told of only once they were apart.
TEST(BeginAnewWithJaws, TheyWereNeverApart) {
  ToolGeometry tool;
  tool.role = toolRole("grasper");
  tool.links = {{"left", {boxOf(Vec3::Constant(0.004))}},
                {"right", {boxOf(Vec3::Constant(0.004))}}};
  Pipeline pipeline(block(), methodOf("elastic"), {tool});
  const auto jaws = [](double apart) {
    return at({Vec3(kMiddle, kMiddle, 0.1), Vec3(kMiddle, kMiddle + apart, 0.1)});
  };
  for (const double apart : {0.0, 0.01, 0.0}) pipeline.step(jaws(apart));
  ASSERT_TRUE(pipeline.report().tools.front().jaws_overlap);
  pipeline.reset();
  pipeline.step(jaws(0.0));
  EXPECT_FALSE(pipeline.report().tools.front().jaws_overlap);
}

INSTANTIATE_TEST_SUITE_P(Tool, BeginAnew,
                         ::testing::Values(Way{"Edge", edge, 0.004}, Way{"Stylus", stylus, 0.001},
                                           Way{"Stamp", stamp, 0.003}, Way{"Mesh", spike, 0.003}),
                         [](const auto& way) { return way.param.name; });

}  // namespace
}  // namespace robot_tissue::test_begin_anew
