// What an increment of method `layered` takes as the lattice grows: a patch of 20 x 20 mm pressed
// 5 mm into a block of SCALE times 100 x 100 x 50 mm, 5 mm aside, back and up again, 1 mm an
// increment. Prints a row of CSV; scripts/study growth reads it. Not a test: nothing here passes or
// fails.
//
//   growth SPACING SCALE NU TOLERANCE THREADS REPEATS [error]
//
// With `error` the greatest one against the same lattice at a tolerance of 1e-5 is told (L2 over
// all nodes), and times and memory are not.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "patch_trial.h"

namespace robot_tissue {
namespace {

constexpr double kStep = 0.001;  // m, an increment
constexpr int kSteps = 5;

struct Job : PatchJob {
  int repeats;
  bool with_error;
};

Tissue makeTissue(const Job& job, double tolerance) {
  return Tissue(blockOf(job), solverOf(job, tolerance));
}

std::vector<Vec3> wayOf() {
  std::vector<Vec3> way;
  for (int i = 1; i <= kSteps; ++i) way.emplace_back(0.0, 0.0, -kStep * i);
  for (int i = 1; i <= kSteps; ++i) way.emplace_back(kStep * i, 0.0, -kStep * kSteps);
  for (int i = kSteps - 1; i >= 0; --i) way.emplace_back(kStep * i, 0.0, -kStep * kSteps);
  for (int i = kSteps - 1; i >= 1; --i) way.emplace_back(0.0, 0.0, -kStep * i);
  return way;
}

// Of the process, at most (bytes).
double peakMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0.0;
    if (word == "VmHWM:" && status >> kilobytes) return 1024.0 * kilobytes;
  }
  return 0.0;
}

void tellError(const Job& job) {
  Tissue tissue = makeTissue(job, job.tolerance), exact = makeTissue(job, kExact);
  double greatest = 0.0;
  for (const Vec3& place : wayOf()) {
    tissue.load(stepTo(job, place));
    exact.load(stepTo(job, place));
    greatest = std::max(greatest, errorOf(tissue, exact));
  }
  std::printf("greatest_error\n%.4g\n", greatest);
}

void tellTimes(const Job& job) {
  Tissue tissue = makeTissue(job, job.tolerance);
  std::vector<double> processor, wall;
  int active = 0, not_ok = 0;
  for (int repeat = 0; repeat < job.repeats; ++repeat) {
    for (const Vec3& place : wayOf()) {
      const double before = threadMs();
      const Clock::time_point start = Clock::now();
      tissue.load(stepTo(job, place));
      processor.push_back(threadMs() - before);
      wall.push_back(millisecondsSince(start));
      active = std::max(active, tissue.lastReport().active_nodes);
      if (tissue.lastReport().status != SolveStatus::kOk) ++not_ok;
    }
  }
  const int nodes = tissue.lattice().nodeCount();
  std::printf("nodes,processor_ms,processor_90_ms,wall_ms,active_nodes,not_ok,bytes_a_node\n");
  std::printf("%d,%.4g,%.4g,%.4g,%d,%d,%.0f\n", nodes, quantile(processor, 0.5),
              quantile(processor, 0.9), quantile(wall, 0.5), active, not_ok, peakMemory() / nodes);
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  if (argc < 7) {
    std::fprintf(stderr, "usage: growth SPACING SCALE NU TOLERANCE THREADS REPEATS [error]\n");
    return 2;
  }
  const robot_tissue::Job job = {{std::atof(argv[1]), std::atof(argv[2]), std::atof(argv[3]),
                                  std::atof(argv[4]), std::atoi(argv[5])},
                                 std::atoi(argv[6]),
                                 argc > 7};
  if (job.with_error) {
    robot_tissue::tellError(job);
  } else {
    robot_tissue::tellTimes(job);
  }
  return 0;
}
