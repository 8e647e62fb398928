// What a user gets who bounds an update (solver.max_ms): a sphere of 10 mm radius is pressed 5 mm
// into 4,851 nodes and moved round at a speed, then held; poses come 200 times a second, an update
// takes the newest one. The clock is the processor's, so that other programs do not show; the
// solver's own is the wall's.
//
// usage: bounded_updates [SPEED (m/s) [SECONDS [MAX_MS...]]]
// A line a budget: max_ms (0: none); median and 99th percentile of an update and of the pose's age
// when it is done (ms); share of updates LATE and TOO_FAST (%); greatest depth of the tool in the
// surface (mm); error of the force against the unbounded run in which no pose is missed, of its
// greatest (%): median and 99th percentile; greatest change of the force between updates, of the
// same (%); updates until it was settled when the tool stood, -1: never.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"
#include "timing.h"

namespace robot_tissue {
namespace {

constexpr double kTop = 0.05, kRadius = 0.01;     // m
constexpr double kPress = 0.005, kRound = 0.010;  // m: depth, and radius of its way
constexpr double kPeriod = 1.0 / 200.0;           // s
constexpr double kLongestUpdate = 0.1;            // s, as the node's
constexpr int kMostSettling = 400;                // updates

RobotPose poseAt(double gone) {
  const double down = std::min(gone, 2.0 * kPress);
  const double angle = (gone - down) / kRound;
  RobotPose pose;
  pose.links.assign(1, Pose::Identity());
  pose.links.front().translation() =
      Vec3(0.05 + kRound * std::cos(angle), 0.05 + kRound * std::sin(angle),
           kTop + kRadius + kPress - down);
  return pose;
}

Pipeline pipelineWith(double max_ms) {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(0.1, 0.1, kTop);
  tissue.spacing = 0.005;
  tissue.material.young_modulus = 1e4;
  tissue.material.poisson_ratio = 0.45;
  tissue.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  SolverConfig solver;
  solver.max_ms = max_ms;
  ToolGeometry tool;
  tool.name = "sphere";
  tool.friction = 0.3;
  ToolShape sphere;
  sphere.radius = kRadius;
  tool.links.push_back({"sphere", {sphere}});
  return {tissue, solver, {tool}};
}

struct Run {
  std::vector<double> took, age;  // ms
  std::vector<Vec3> force;        // of every pose; of those missed as before
  std::vector<bool> followed;
  double late = 0.0, too_fast = 0.0;
  double deepest = 0.0;  // m
  int settling = -1;
};

// misses: poses that come during an update, but for the newest, are missed.
Run follow(double max_ms, double speed, int poses, bool misses) {
  Pipeline pipeline = pipelineWith(max_ms);
  pipeline.setBudget(max_ms > 0.0 ? 1e-3 * max_ms : kLongestUpdate);
  Run run;
  run.force.assign(static_cast<std::size_t>(poses), Vec3::Zero());
  run.followed.assign(run.force.size(), false);
  double now = 0.0;  // s
  for (int pose = 0; pose < poses;) {
    const double came = pose * kPeriod;
    now = std::max(now, came);
    const double start = 1e-3 * processorMs();
    const StepReport& report = pipeline.step(poseAt(speed * came));
    const double took = 1e-3 * processorMs() - start;
    now += took;
    const auto index = static_cast<std::size_t>(pose);
    run.force[index] = report.tools.front().force_on_tool;
    run.followed[index] = true;
    run.deepest = std::max(run.deepest, report.tools.front().max_penetration);
    if (report.tools.front().contacts > 0) {
      run.took.push_back(1e3 * took);
      run.age.push_back(1e3 * (now - came));
      run.late += pipeline.tissue().lastReport().status == SolveStatus::kLate ? 1.0 : 0.0;
      run.too_fast += report.too_fast ? 1.0 : 0.0;
    }
    const int newest = static_cast<int>(std::floor(now / kPeriod));
    pose = misses ? std::max(pose + 1, newest) : pose + 1;
  }
  const RobotPose stands = poseAt(speed * (poses - 1) * kPeriod);
  for (int update = 0; update < kMostSettling && run.settling < 0; ++update) {
    if (!pipeline.step(stands).changed) run.settling = update;
  }
  return run;
}

void tell(double max_ms, const Run& run, const Run& reference) {
  double greatest = 0.0, jump = 0.0;
  for (const Vec3& force : reference.force) greatest = std::max(greatest, force.norm());
  std::vector<double> errors;
  const Vec3* last = nullptr;
  for (std::size_t pose = 0; pose < run.force.size(); ++pose) {
    if (!run.followed[pose]) continue;
    if (reference.force[pose].norm() > 0.0) {
      errors.push_back(100.0 * (run.force[pose] - reference.force[pose]).norm() / greatest);
    }
    if (last != nullptr) jump = std::max(jump, (run.force[pose] - *last).norm());
    last = &run.force[pose];
  }
  const double updates = static_cast<double>(run.took.size());
  std::printf("%g, %.2f, %.2f, %.2f, %.2f, %.1f, %.1f, %.3f, %.2f, %.2f, %.1f, %d\n", max_ms,
              quantile(run.took, 0.5), quantile(run.took, 0.99), quantile(run.age, 0.5),
              quantile(run.age, 0.99), 100.0 * run.late / updates, 100.0 * run.too_fast / updates,
              1e3 * run.deepest, quantile(errors, 0.5), quantile(errors, 0.99),
              100.0 * jump / greatest, run.settling);
  std::fflush(stdout);
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  const double speed = argc > 1 ? std::atof(argv[1]) : 0.02;
  const double seconds = argc > 2 ? std::atof(argv[2]) : 5.0;
  std::vector<double> budgets = {1.0, 2.0, 3.0, 5.0, 0.0};
  if (argc > 3) budgets.clear();
  for (int i = 3; i < argc; ++i) budgets.push_back(std::atof(argv[i]));
  const int poses = static_cast<int>(seconds / kPeriod);
  const Run reference = follow(0.0, speed, poses, false);
  std::printf(
      "max_ms, update_ms, update_ms_99, age_ms, age_ms_99, late_percent, too_fast_percent, "
      "depth_mm, force_error_percent, force_error_99, force_jump_percent, settled_after\n");
  for (const double max_ms : budgets) tell(max_ms, follow(max_ms, speed, poses, true), reference);
  return 0;
}
