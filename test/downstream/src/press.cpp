// Without ROS: a patch presses a block by `Tissue`, then a sphere presses another by `Pipeline`.
#include <robot_tissue/core/tissue.h>
#include <robot_tissue/pipeline/pipeline.h>

#include <array>
#include <cstdio>
#include <optional>

namespace {

namespace rt = robot_tissue;

constexpr double kTop = 0.04;     // of the block (m)
constexpr double kDepth = 0.004;  // m

rt::TissueConfig block() {
  rt::TissueConfig tissue;
  tissue.shape.max() = rt::Vec3(0.06, 0.06, kTop);
  tissue.spacing = 0.01;
  tissue.material.young_modulus = 1e4;  // Pa
  tissue.fixed.push_back({rt::Vec3(-1.0, -1.0, -1e-6), rt::Vec3(1.0, 1.0, 1e-6)});
  return tissue;
}

double forceOfPatch() {
  rt::Tissue tissue(block(), rt::SolverConfig());
  rt::LoadStep load;
  load.patches.emplace_back();
  load.patches[0].name = "punch";
  load.patches[0].box = {rt::Vec3(0.02, 0.02, kTop), rt::Vec3(0.04, 0.04, kTop)};
  load.patches[0].displacement = std::array<std::optional<double>, 3>{0.0, 0.0, -kDepth};
  tissue.load(load);
  return tissue.answerOf("punch", tissue.lastReport()).force.z();
}

double forceOfTool() {
  rt::ToolConfig probe;
  probe.name = "probe";
  probe.links.emplace_back();
  probe.links[0].shapes.emplace_back();
  probe.links[0].shapes[0].radius = 0.01;
  rt::Pipeline pipeline(block(), rt::SolverConfig(), rt::toolsOf({probe}).tools);
  rt::RobotPose pose;
  pose.links.push_back(rt::Pose::Identity());
  for (const double height : {0.02, 0.01 - kDepth}) {
    pose.links[0].translation() = rt::Vec3(0.03, 0.03, kTop + height);
    pipeline.step(pose);
  }
  return pipeline.report().tools.at(0).force_on_tool.z();
}

}  // namespace

int main() {
  const double of_patch = forceOfPatch(), of_tool = forceOfTool();
  std::printf("patch %.3f N, tool %.3f N\n", of_patch, of_tool);
  return of_patch < -0.1 && of_tool > 0.1 ? 0 : 1;  // the patch pushes down, the tissue up
}
