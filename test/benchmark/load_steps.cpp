// Loads in increments that the tissue chooses, against fixed numbers of them.
//   load_steps        100 x 100 x 50 mm, bottom fixed, a patch of 20 x 20 mm in the middle of the
//   top
// Writes method,load,young,force,increments,automatic,ms,way_mm,longest_step,error,status: ms of
// the processor for the whole load, way of the patch, longest step of it over the spacing, error of
// the displacement (L2) against the load in 400 increments.
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "contact_trial.h"
#include "robot_tissue/core/tissue.h"
#include "timing.h"

namespace robot_tissue {
namespace {

constexpr int kReference = 400;  // increments
constexpr double kTop = 0.05;    // m

struct Case {
  std::string method, load;
  double young;    // Pa
  double spacing;  // m
  Vec3 force;      // N
};

struct Outcome {
  int increments = 0;
  double ms = 0.0, way = 0.0, longest = 0.0;
  SolveStatus worst = SolveStatus::kOk;
  std::vector<Vec3> displacement;
};

Outcome bring(const Case& job, std::optional<int> increments) {
  TissueConfig block = blockOf({0.1, 0.1, kTop}, job.spacing);
  block.material.young_modulus = job.young;
  if (job.method == "paper") block.model = "six_spring";
  Tissue tissue(block, solverOf(job.method, job.method == "paper" ? 0.01 : 1e-4));
  PatchConfig patch;
  patch.name = "punch";
  patch.box = {Vec3(0.04, 0.04, kTop), Vec3(0.06, 0.06, kTop)};
  patch.force = job.force;
  LoadStep step;
  step.increments = increments;
  step.patches.push_back(patch);
  Outcome outcome;
  Vec3 last = Vec3::Zero();
  const double start = processorMs();
  tissue.load(step, [&](int, int, const SolveReport& report) {
    const Vec3 place = tissue.answerOf("punch", report).displacement;
    outcome.longest = std::max(outcome.longest, (place - last).norm() / job.spacing);
    outcome.worst = std::max(outcome.worst, report.status);
    last = place;
    ++outcome.increments;
  });
  outcome.ms = processorMs() - start;
  outcome.way = last.norm();
  outcome.displacement = tissue.state().displacement;
  return outcome;
}

double errorOf(const std::vector<Vec3>& found, const std::vector<Vec3>& right) {
  double off = 0.0, all = 0.0;
  for (std::size_t node = 0; node < right.size(); ++node) {
    off += (found[node] - right[node]).squaredNorm();
    all += right[node].squaredNorm();
  }
  return std::sqrt(off / all);
}

void study(const Case& job) {
  const Outcome reference = bring(job, kReference);
  const auto tell = [&](const Outcome& outcome, bool automatic) {
    std::printf("%s,%s,%g,%g,%d,%d,%.2f,%.3f,%.3f,%.2g,%s\n", job.method.c_str(), job.load.c_str(),
                job.young, job.force.norm(), outcome.increments, automatic ? 1 : 0, outcome.ms,
                1e3 * outcome.way, outcome.longest,
                errorOf(outcome.displacement, reference.displacement), toString(outcome.worst));
    std::fflush(stdout);
  };
  for (const int increments : {1, 2, 5, 20, 100}) tell(bring(job, increments), false);
  tell(bring(job, std::nullopt), true);
  tell(reference, false);
}

int run() {
  std::printf("method,load,young,force,increments,automatic,ms,way_mm,longest_step,error,status\n");
  for (const double young : {1e3, 1e4, 1e6}) {
    study({"layered", "press", young, 0.005, Vec3(0.0, 0.0, -4e-4 * young)});
  }
  study({"layered", "press", 1e4, 0.005, Vec3(0.0, 0.0, -12.0)});
  study({"layered", "drag", 1e4, 0.005, Vec3(4.0, 0.0, 0.0)});
  study({"layered", "pull", 1e4, 0.005, Vec3(0.0, 0.0, 4.0)});
  study({"layered", "press", 1e4, 0.01, Vec3(0.0, 0.0, -4.0)});
  for (const double young : {1e4, 1e6}) {
    study({"paper", "press", young, 0.005, Vec3(0.0, 0.0, -4e-4 * young)});
  }
  study({"paper", "drag", 1e4, 0.005, Vec3(2.0, 0.0, 0.0)});
  return 0;
}

}  // namespace
}  // namespace robot_tissue

int main() { return robot_tissue::run(); }
