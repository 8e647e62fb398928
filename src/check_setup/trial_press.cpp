#include "trial_press.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot_tissue/core/body_load.h"
#include "robot_tissue/core/deadline.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/scene/memory.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kDepth = 0.001;         // m
constexpr int kUpdates = 4;              // that the way in is told in
constexpr double kRadiusSpacings = 2.0;  // of the sphere: it touches some nodes. Chosen
constexpr double kSlowUpdate = 100.0;    // ms: the node leaves what takes longer to later updates

struct Place {
  Vec3 top = Vec3::Zero();      // of the surface (m)
  Vec3 inwards = Vec3::Zero();  // unit
};

// Outwards from the middle of what is fixed to that of the tissue; without: up.
Vec3 outwardsOf(const Tissue& tissue, const Vec3& middle) {
  Vec3 held = Vec3::Zero();
  int count = 0;
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    if (!tissue.lattice().isFixed(node)) continue;
    held += tissue.lattice().restPosition(node);
    ++count;
  }
  const Vec3 away = count > 0 ? Vec3(middle - held / count) : Vec3::Zero();
  return away.norm() > 1e-6 * tissue.bounds().sizes().norm() ? away.normalized() : Vec3::UnitZ();
}

// The farthest vertex that way, in the middle rather than at the rim.
Place placeOn(const Tissue& tissue) {
  const Vec3 middle = tissue.bounds().center();
  const Vec3 outwards = outwardsOf(tissue, middle);
  Place place{middle, -outwards};
  double best = -std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : tissue.vertices()) {
    const Vec3 from_middle = vertex - middle;
    const double along = from_middle.dot(outwards);
    const double aside = (from_middle - along * outwards).norm();
    if (along - 2.0 * aside <= best) continue;
    best = along - 2.0 * aside;
    place.top = vertex;
  }
  return place;
}

ToolGeometry sphereOf(double radius, const Scene& scene) {
  ToolShape sphere;
  sphere.radius = radius;
  ToolGeometry tool;
  tool.name = "press";
  tool.links.push_back({"press", {sphere}});
  if (scene.tissue.model == "six_spring") tool.patch = ToolConfig::Patch::kRigid;
  return tool;
}

RobotPose poseAt(const Place& place, double radius, double depth) {
  Pose pose = Pose::Identity();
  pose.translation() = place.top + (depth - radius) * place.inwards;
  RobotPose robot;
  robot.links = {pose};
  return robot;
}

}  // namespace

TrialPress pressOnce(const Scene& scene, double most_seconds) {
  TrialPress press;
  const double before = residentMemory();
  press.radius_m = kRadiusSpacings * scene.tissue.spacing;
  Pipeline pipeline(scene.tissue, scene.solver, {sphereOf(press.radius_m, scene)}, scene.supports);
  const Deadline deadline(most_seconds);
  pipeline.setEnd(deadline);
  if (hasBodyLoad(scene.tissue) || !scene.supports.empty()) pipeline.settle();
  press.nodes = pipeline.tissue().lattice().nodeCount();
  const Place place = placeOn(pipeline.tissue());
  pipeline.step(poseAt(place, press.radius_m, -0.1 * kDepth));
  for (int update = 1; update <= kUpdates; ++update) {
    const double start_ms = deadline.leftMs();
    const StepReport& report =
        pipeline.step(poseAt(place, press.radius_m, kDepth * update / kUpdates));
    press.update_ms += (start_ms - deadline.leftMs()) / kUpdates;
    press.ended = press.ended && !report.late && !deadline.isOver();
    press.converged = press.converged && pipeline.tissue().lastReport().status == SolveStatus::kOk;
  }
  press.force_n = -pipeline.report().tools[0].force_on_tool.dot(place.inwards);
  press.memory_mb = std::max(0.0, 1e-6 * (residentMemory() - before));
  return press;
}

Findings checkPress(const Scene& scene, double most_seconds) {
  const TrialPress press = pressOnce(scene, most_seconds);
  const auto rounded = [](double value) {
    if (value == 0.0) return std::string("0");
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
    return numberText(std::round(value / unit) * unit);
  };
  const std::string what = "a sphere of " + rounded(1e3 * press.radius_m) +
                           " mm radius pressed 1 mm into " + std::to_string(press.nodes) + " nodes";
  if (!press.ended) {
    return {{Finding::Level::kWarning,
             "solver.method: " + what + " is not done in " + rounded(most_seconds) + " s",
             "a larger tissue.spacing, or method layered"}};
  }
  Findings findings = {{Finding::Level::kNote,
                        what + " takes " + rounded(press.update_ms) + " ms an update, " +
                            rounded(press.memory_mb) + " MB and " + rounded(press.force_n) + " N",
                        ""}};
  if (!press.converged) {
    findings.push_back({Finding::Level::kWarning, "solver: that press did not come to balance",
                        "more of the tissue fixed, or a larger solver.tolerance"});
  } else if (press.update_ms > kSlowUpdate) {
    findings.push_back({Finding::Level::kWarning,
                        "tissue.spacing: an update longer than " + rounded(kSlowUpdate) +
                            " ms is carried on in later ones, and the shape lags (LATE)",
                        "a larger tissue.spacing, solver.tolerance or solver.threads"});
  }
  return findings;
}

}  // namespace robot_tissue
