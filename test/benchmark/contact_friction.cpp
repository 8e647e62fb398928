// Tools that are pressed and then slide: the force across over the force along the normal.
//   contact_friction [plate|box|sphere|all] [FRICTION] [SPACING in mm] [METHOD] [TOLERANCE]
// plate: larger than the block's top, that all of it slides; box: its edges are on the top;
// sphere: of 60 mm radius, that its normals are nearly upright.
// Writes tool,friction,spacing_mm,way_mm,fx,fy,fz,ratio,normal_n,drag_n,steepest,penetration_mm,
// unbalanced_n,ms,status,sliding_normal_n,sliding_drag_n: one line an increment of the drag; ratio
// is of the wrench, normal_n and drag_n are sums over the touches, sliding_ over those that slide.
#include <cstdio>

#include "contact_trial.h"
#include "timing.h"

namespace robot_tissue {
namespace {

struct Slide {
  std::string name;
  ToolShape shape;
  double bottom;  // m: of the tool, below its origin
  Vec3 extent;    // of the block, m
  double press;   // m
  double drag;    // m
};

void slide(const Slide& trial, double friction, double spacing, const SolverConfig& solver) {
  constexpr double kIncrement = 0.0005;  // m
  Pipeline pipeline(blockOf(trial.extent, spacing), solver,
                    {toolOf(trial.name, trial.shape, friction)});
  const Vec3 start(0.5 * trial.extent.x() - 0.5 * trial.drag, 0.5 * trial.extent.y(),
                   trial.extent.z() + trial.bottom);
  const auto at_way = [&](double down, double aside) {
    RobotPose pose;
    pose.links.push_back(placedAt(start + Vec3(aside, 0.0, -down)));
    return pose;
  };
  pipeline.step(at_way(-0.001, 0.0));
  const int downs = static_cast<int>(trial.press / kIncrement + 0.5);
  for (int i = 1; i <= downs; ++i) pipeline.step(at_way(trial.press * i / downs, 0.0));
  const int increments = static_cast<int>(trial.drag / kIncrement + 0.5);
  for (int i = 0; i <= increments; ++i) {
    const double aside = trial.drag * i / increments;
    const double begin = processorMs();
    const ToolReport& tool = pipeline.step(at_way(trial.press, aside)).tools.front();
    const double ms = processorMs() - begin;
    const TouchSums touches = touchesOf(pipeline.tissue(), trial.name, Vec3::Zero());
    const Vec3& force = tool.force_on_tool;
    std::printf("%s,%g,%g,%.3f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.4f,%.6f,%.1f,%s,%.6f,%.6f\n",
                trial.name.c_str(), friction, 1e3 * spacing, 1e3 * aside, force.x(), force.y(),
                force.z(), force.head<2>().norm() / force.z(), touches.normal, touches.drag,
                touches.steepest, 1e3 * tool.max_penetration,
                pipeline.forceBalance().unbalanced().norm(), ms,
                toString(pipeline.tissue().lastReport().status), touches.sliding_normal,
                touches.sliding_drag);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  const std::string wanted = argc > 1 ? argv[1] : "all";
  const double friction = argument(argc, argv, 2, 0.3);
  const double spacing = 1e-3 * argument(argc, argv, 3, 5.0);
  const SolverConfig solver =
      solverOf(argc > 4 ? argv[4] : "layered", argument(argc, argv, 5, 0.01));
  const Slide trials[] = {
      {"plate", boxOf(Vec3(0.2, 0.2, 0.02)), 0.01, Vec3(0.06, 0.06, 0.03), 0.003, 0.02},
      {"box", boxOf(Vec3(0.04, 0.04, 0.02)), 0.01, Vec3(0.1, 0.1, 0.05), 0.002, 0.02},
      {"sphere", sphereOf(0.06), 0.06, Vec3(0.1, 0.1, 0.05), 0.003, 0.02}};
  std::printf(
      "tool,friction,spacing_mm,way_mm,fx,fy,fz,ratio,normal_n,drag_n,steepest,penetration_mm,"
      "unbalanced_n,ms,status,sliding_normal_n,sliding_drag_n\n");
  for (const Slide& trial : trials) {
    if (wanted == "all" || wanted == trial.name) slide(trial, friction, spacing, solver);
  }
  return 0;
}
