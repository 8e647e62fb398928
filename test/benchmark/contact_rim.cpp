// A flat tool of 20 mm across pressed into a block of 100 x 100 x 50 mm, bottom fixed, its edges
// anywhere between the nodes: force over depth, beside that of a bonded patch of the same size.
//   contact_rim [box|turned|cylinder|patch] [SPACING in mm] [FRICTION] [DEPTH in mm] [STEPS]
//               [METHOD] [TOLERANCE] [POISSON] [OFFSET in spacings: the edges of the box off nodes]
// Without the last two all of some. `turned`: the box by 45 degrees about its axis; `patch`: a
// load, its edges on nodes where all are asked for. Writes
// tool,spacing_mm,poisson,friction,offset,depth_mm,force_n,penetration_mm,ms,status: one line a
// step.
#include <cstdio>

#include "contact_trial.h"
#include "timing.h"

namespace robot_tissue {
namespace {

constexpr double kAcross = 0.02;  // m
constexpr double kTop = 0.05;     // m

struct Job {
  std::string tool;
  TissueConfig tissue;
  SolverConfig solver;
  double friction, offset, depth;
  int steps;
};

struct Answer {
  double force = 0.0;        // N
  double penetration = 0.0;  // m
  SolveStatus status = SolveStatus::kOk;
};

Vec3 middleOf(const Job& job) {
  const double off = job.offset * job.tissue.spacing;
  return {kTop + off, kTop + off, kTop};
}

ToolShape shapeOf(const std::string& tool) {
  if (tool == "cylinder") return cylinderOf(0.5 * kAcross, kAcross);
  ToolShape box = boxOf(Vec3::Constant(kAcross));
  if (tool == "turned") {
    box.pose.linear() = Eigen::AngleAxisd(M_PI / 4, Vec3::UnitZ()).toRotationMatrix();
  }
  return box;
}

template <class Press>
void press(const Job& job, const Press& to) {
  for (int step = 1; step <= job.steps; ++step) {
    const double depth = job.depth * step / job.steps;
    const double start = processorMs();
    const Answer answer = to(depth);
    const double ms = processorMs() - start;
    std::printf("%s,%g,%g,%g,%g,%.4f,%.6f,%.4f,%.1f,%s\n", job.tool.c_str(),
                1e3 * job.tissue.spacing, job.tissue.material.poisson_ratio, job.friction,
                job.offset, 1e3 * depth, answer.force, 1e3 * answer.penetration, ms,
                toString(answer.status));
    std::fflush(stdout);
  }
}

void pressPatch(const Job& job) {
  Tissue tissue(job.tissue, job.solver);
  press(job, [&](double depth) {
    PatchConfig patch;
    patch.name = "plate";
    const Vec3 reach(0.5 * kAcross + 1e-9, 0.5 * kAcross + 1e-9, 1e-6);
    patch.box = {middleOf(job) - reach, middleOf(job) + reach};
    patch.displacement = {0.0, 0.0, -depth};
    LoadStep load;
    load.patches.push_back(patch);
    tissue.load(load);
    Answer answer;
    answer.force = -tissue.answerOf("plate", tissue.lastReport()).force.z();
    answer.status = tissue.lastReport().status;
    return answer;
  });
}

void pressTool(const Job& job) {
  Pipeline pipeline(job.tissue, job.solver, {toolOf(job.tool, shapeOf(job.tool), job.friction)});
  const auto at_depth = [&](double depth) {
    RobotPose pose;
    pose.links.push_back(placedAt(middleOf(job) + Vec3(0.0, 0.0, 0.5 * kAcross - depth)));
    return pose;
  };
  pipeline.step(at_depth(-0.001));
  press(job, [&](double depth) {
    const ToolReport& tool = pipeline.step(at_depth(depth)).tools.front();
    return Answer{tool.force_on_tool.z(), tool.max_penetration,
                  pipeline.tissue().lastReport().status};
  });
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  Job job;
  job.tool = argc > 1 ? argv[1] : "box";
  job.tissue = blockOf(Vec3(0.1, 0.1, kTop), 1e-3 * argument(argc, argv, 2, 5.0));
  job.friction = argument(argc, argv, 3, 2.0);
  job.depth = 1e-3 * argument(argc, argv, 4, 5.0);
  job.steps = static_cast<int>(argument(argc, argv, 5, 5.0));
  job.solver = solverOf(argc > 6 ? argv[6] : "layered", argument(argc, argv, 7, 0.003));
  std::vector<double> ratios = {0.25, 0.45}, offsets = {0.0};
  if (job.tool != "patch") offsets = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.75, 0.9};
  if (argc > 8) ratios = {std::atof(argv[8])};
  if (argc > 9) offsets = {std::atof(argv[9])};
  std::printf(
      "tool,spacing_mm,poisson,friction,offset,depth_mm,force_n,penetration_mm,ms,status\n");
  for (const double ratio : ratios) {
    for (const double offset : offsets) {
      job.tissue.material.poisson_ratio = ratio;
      job.offset = offset;
      job.tool == "patch" ? pressPatch(job) : pressTool(job);
    }
  }
  return 0;
}
