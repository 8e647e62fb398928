// Milliseconds and true error of method `layered`, an increment of 1 mm at a time: a patch of
// 20 x 20 mm pressed 5 mm into a block of 100 x 100 x 50 mm, drawn 5 mm aside and 5 mm back. Prints
// CSV; doc/model.md reads it. Not a test: nothing here passes or fails.
//
//   layered_steps SPACING TOLERANCE [POISSON_RATIO ...]
//
// The error is against method `newton`; with a spacing below 4 mm against `layered` at 1e-6.
#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "robot_tissue/core/tissue.h"

namespace robot_tissue {
namespace {

constexpr double kIncrement = 0.001;  // m
constexpr double kFinest = 0.004;     // m: below, newton needs too much memory

TissueConfig blockOf(double spacing, double poisson_ratio) {
  TissueConfig config;
  config.model = "elastic";
  config.shape.max() = Vec3(0.10, 0.10, 0.05);
  config.spacing = spacing;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = poisson_ratio;
  config.fixed.push_back({Vec3::Zero(), Vec3(0.10, 0.10, 0.0)});
  return config;
}

std::vector<Vec3> path() {
  std::vector<Vec3> places;
  for (int i = 1; i <= 5; ++i) places.emplace_back(0.0, 0.0, -kIncrement * i);
  for (int i = 1; i <= 5; ++i) places.emplace_back(kIncrement * i, 0.0, places[4].z());
  for (int i = 4; i >= 0; --i) places.emplace_back(kIncrement * i, 0.0, places[4].z());
  return places;
}

LoadStep stepTo(const Vec3& place) {
  PatchConfig patch;
  patch.name = "punch";
  patch.box = {Vec3(0.04, 0.04, 0.05), Vec3(0.06, 0.06, 0.05)};
  patch.displacement = std::array<std::optional<double>, 3>{{place.x(), place.y(), place.z()}};
  LoadStep step;
  step.increments = 1;
  step.patches.push_back(patch);
  return step;
}

SolveReport loadTo(Tissue& tissue, const Vec3& place) {
  SolveReport last;
  tissue.load(stepTo(place), [&](int, int, const SolveReport& report) { last = report; });
  return last;
}

// Relative L2 over the nodes that are neither fixed nor hard in the patch.
double errorOf(const Tissue& tissue, const Tissue& exact) {
  std::vector<char> counts(tissue.state().displacement.size(), 1);
  for (const int node : hardNodes(tissue.patches().front())) counts[at(node)] = 0;
  double missed = 0.0, moved = 0.0;
  for (std::size_t node = 0; node < counts.size(); ++node) {
    if (counts[node] == 0) continue;
    const Vec3& right = exact.state().displacement[node];
    missed += (tissue.state().displacement[node] - right).squaredNorm();
    moved += right.squaredNorm();
  }
  return std::sqrt(missed / moved);
}

void run(double spacing, double tolerance, double poisson_ratio) {
  SolverConfig layered, exact;
  layered.method = "layered";
  layered.tolerance = tolerance;
  exact.method = spacing < kFinest ? "layered" : "newton";
  exact.tolerance = 1e-6;
  Tissue tissue(blockOf(spacing, poisson_ratio), layered);
  Tissue reference(blockOf(spacing, poisson_ratio), exact);
  int increment = 0;
  for (const Vec3& place : path()) {
    const SolveReport report = loadTo(tissue, place);
    const SolveReport right = loadTo(reference, place);
    const double error = errorOf(tissue, reference);
    std::printf("%g,%g,%g,%d,%s,%.1f,%d,%.3g,%.3g,%.2f,%d,%d,%.6g,%s,%.0f\n", spacing, tolerance,
                poisson_ratio, ++increment, toString(report.status), report.wall_ms,
                report.iterations, report.error_estimate, error, report.error_estimate / error,
                report.active_nodes, report.layers, report.patches.front().force.norm(),
                toString(right.status), right.wall_ms);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  if (argc < 3) {
    std::cerr << "usage: layered_steps SPACING TOLERANCE [POISSON_RATIO ...]\n";
    return 2;
  }
  try {
    std::vector<double> ratios;
    for (int i = 3; i < argc; ++i) ratios.push_back(std::stod(argv[i]));
    if (ratios.empty()) ratios = {0.25, 0.45};
    std::printf(
        "spacing_m,tolerance,poisson_ratio,increment,status,ms,sweeps,error_estimate,error,"
        "estimate_over_error,active_nodes,layers,force_n,reference_status,reference_ms\n");
    for (const double ratio : ratios) run(std::stod(argv[1]), std::stod(argv[2]), ratio);
  } catch (const std::exception& error) {
    std::cerr << "layered_steps: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
