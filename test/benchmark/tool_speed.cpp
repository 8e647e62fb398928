// What an update of the pipeline takes while tools press a block and go round on it, and what of it
// is contact. 100 x 100 x 50 mm, E 10 kPa, nu 0.45; 5 mm spacing (4,851 nodes) unless told.
//   tool_speed [sphere|mesh|both|hand|fingers] [SPEED in m/s] [RATE in Hz] [UPDATES] [SPACING in
//   mm]
// fingers: three, meshes of 3,000 triangles each; hand: two of them, as scripts/study node moves
// them.
// Writes one line an update: contact_ms (wall), solve_ms (wall), update_ms (of the processor),
// substeps, force along z on the tools (N), penetration_mm, status. Sums up on stderr. What the
// stages of an update take of it: scripts/study stages.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "contact_trial.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "timing.h"
#include "tool_meshes.h"

namespace robot_tissue {
namespace {

constexpr double kTop = 0.05;     // m
constexpr double kPress = 0.005;  // m
constexpr double kRound = 0.010;  // m: radius of the way

struct Way {
  Vec3 center;
  double lowest;  // m, of the tool below its origin
};

// Down by kPress, then round and round.
Vec3 placeOn(const Way& way, double gone) {
  const double down = std::min(gone, 2.0 * kPress);
  const double angle = (gone - down) / kRound;
  return way.center + Vec3(kRound * std::cos(angle), kRound * std::sin(angle),
                           kTop + way.lowest + kPress - down);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(share * last)];
}

void sumUp(const char* name, const std::vector<double>& ms) {
  std::fprintf(stderr, "%s: median %.3f, 99 %% %.3f, greatest %.3f ms\n", name, quantile(ms, 0.5),
               quantile(ms, 0.99), quantile(ms, 1.0));
}

std::vector<std::string> toolsOf(const std::string& which) {
  if (which == "both") return {"sphere", "mesh"};
  if (which == "fingers") return {"thumb", "index", "middle"};
  if (which == "hand") return {"left", "right"};
  return {which};
}

void addTool(const std::string& kind, std::vector<ToolGeometry>& tools, std::vector<Way>& ways) {
  static const std::map<std::string, Vec3> fingers = {{"thumb", {0.032, 0.05, 0.0}},
                                                      {"index", {0.062, 0.036, 0.0}},
                                                      {"middle", {0.062, 0.064, 0.0}},
                                                      {"left", {0.038, 0.05, 0.0}},
                                                      {"right", {0.062, 0.05, 0.0}}};
  if (kind == "sphere") {
    tools.push_back(toolOf(kind, sphereOf(0.01), 0.3));
    return ways.push_back({{0.03, 0.05, 0.0}, 0.01});
  }
  ToolShape mesh;
  mesh.type = ToolShape::Type::kMesh;
  const bool is_finger = fingers.count(kind) > 0;
  mesh.resource = is_finger ? writeFinger(0.008, 0.045) : writeEllipsoid({0.01, 0.008, 0.012});
  tools.push_back(toolOf(kind, mesh, 0.3));
  ways.push_back(is_finger ? Way{fingers.at(kind), 0.0} : Way{{0.07, 0.05, 0.0}, 0.012});
}

int run(int argc, char** argv) {
  const std::string which = argc > 1 ? argv[1] : "both";
  const double speed = argument(argc, argv, 2, 0.05), rate = argument(argc, argv, 3, 200.0);
  const int updates = static_cast<int>(argument(argc, argv, 4, 1000.0));
  const double spacing = 1e-3 * argument(argc, argv, 5, 5.0);
  std::vector<ToolGeometry> tools;
  std::vector<Way> ways;
  for (const std::string& kind : toolsOf(which)) addTool(kind, tools, ways);
  Pipeline pipeline(blockOf({0.1, 0.1, kTop}, spacing), solverOf("layered", 0.01), tools);
  std::vector<double> contact, solve, total;
  std::printf("contact_ms,solve_ms,update_ms,substeps,fz,penetration_mm,status\n");
  for (int update = 0; update < updates; ++update) {
    RobotPose pose;
    for (const Way& way : ways) pose.links.push_back(placedAt(placeOn(way, update * speed / rate)));
    const double start = threadMs();
    const StepReport& report = pipeline.step(pose);
    const double update_ms = threadMs() - start;
    double force = 0.0, penetration = 0.0;
    int touches = 0;
    for (const ToolReport& tool : report.tools) {
      force += tool.force_on_tool.z();
      touches += tool.contacts;
      penetration = std::max(penetration, tool.max_penetration);
    }
    std::printf("%.4f,%.4f,%.4f,%d,%.5f,%.4f,%s\n", report.contact_ms, report.solve_ms, update_ms,
                report.substeps, force, 1e3 * penetration,
                toString(pipeline.tissue().lastReport().status));
    if (touches == 0) continue;
    contact.push_back(report.contact_ms);
    solve.push_back(report.solve_ms);
    total.push_back(update_ms);
  }
  if (total.empty()) return 1;
  sumUp("contact, wall", contact);
  sumUp("solve with its contact rounds, wall", solve);
  sumUp("update, processor", total);
  return 0;
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) { return robot_tissue::run(argc, argv); }
