// A sphere without friction pressed into a layer that is bonded to its ground: force over depth.
// The depth is of the sphere's lowest point below the surface at rest.
//   contact_hertz [SPACING in mm] [RADIUS in mm] [LAYER in mm] [WIDTH in mm] [DEPTH in mm]
//                 [STEPS] [METHOD] [TOLERANCE] [SHIFT in spacings: sphere's axis off a node]
//                 [SHIFT along y, where that is another] [POISSON]
// Writes spacing_mm,radius_mm,layer_mm,width_mm,method,tolerance,shift,shift_y,depth_mm,force_n,
// lateral_n,contact_radius_mm,touches,penetration_mm,unbalanced_n,ms,status: one line a step.
#include <cstdio>

#include "contact_trial.h"
#include "timing.h"

int main(int argc, char** argv) {
  using namespace robot_tissue;
  const double spacing = 1e-3 * argument(argc, argv, 1, 5.0);
  const double radius = 1e-3 * argument(argc, argv, 2, 40.0);
  const double layer = 1e-3 * argument(argc, argv, 3, 50.0);
  const double width = 1e-3 * argument(argc, argv, 4, 160.0);
  const double depth = 1e-3 * argument(argc, argv, 5, 6.0);
  const int steps = static_cast<int>(argument(argc, argv, 6, 24.0));
  const std::string method = argc > 7 ? argv[7] : "layered";
  const double tolerance = argument(argc, argv, 8, 0.01);
  const double shift = argument(argc, argv, 9, 0.0), shift_y = argument(argc, argv, 10, shift);

  const Vec3 axis(0.5 * width + shift * spacing, 0.5 * width + shift_y * spacing, 0.0);
  TissueConfig block = blockOf(Vec3(width, width, layer), spacing);
  block.material.poisson_ratio = argument(argc, argv, 11, kPoisson);
  Pipeline pipeline(block, solverOf(method, tolerance), {toolOf("sphere", sphereOf(radius), 0.0)});
  const auto at_depth = [&](double deep) {
    RobotPose pose;
    pose.links.push_back(placedAt(axis + Vec3(0.0, 0.0, layer + radius - deep)));
    return pose;
  };
  pipeline.step(at_depth(-0.001));
  std::printf(
      "spacing_mm,radius_mm,layer_mm,width_mm,method,tolerance,shift,shift_y,depth_mm,force_n,"
      "lateral_n,contact_radius_mm,touches,penetration_mm,unbalanced_n,ms,status\n");
  for (int step = 1; step <= steps; ++step) {
    const double deep = depth * step / steps;
    const double start = processorMs();
    const ToolReport& tool = pipeline.step(at_depth(deep)).tools.front();
    const double ms = processorMs() - start;
    const TouchSums touches = touchesOf(pipeline.tissue(), "sphere", axis);
    std::printf("%g,%g,%g,%g,%s,%g,%g,%g,%.4f,%.6f,%.6f,%.3f,%d,%.4f,%.6f,%.1f,%s\n", 1e3 * spacing,
                1e3 * radius, 1e3 * layer, 1e3 * width, method.c_str(), tolerance, shift, shift_y,
                1e3 * deep, tool.force_on_tool.z(), tool.force_on_tool.head<2>().norm(),
                1e3 * touches.radius, touches.pushing, 1e3 * tool.max_penetration,
                pipeline.forceBalance().unbalanced().norm(), ms,
                toString(pipeline.tissue().lastReport().status));
    std::fflush(stdout);
  }
  return 0;
}
