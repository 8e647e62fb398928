// Milliseconds per increment and the true error they buy, for any method: a patch of 20 x 20 mm
// pressed 5 mm into a block of 100 x 100 x 50 mm, 1 mm an increment. Prints CSV, a row an
// increment; doc/baselines.md reads it. Not a test: nothing here passes or fails.
//
//   speed JOB SPACING NU CACHE REPEATS METHOD:TOLERANCE[,TOLERANCE ...] ...
//
// JOB: press; drag: then drawn 5 mm aside; reverse: then 5 mm back; stiff: press over a region a
// hundred times stiffer; large: press into a block four times as long, wide and high. The error is
// against method `newton`, whose shapes are kept in the folder CACHE. In a repeat each method and
// tolerance has one run, so that what else the machine does meets all of them.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "robot_tissue/core/tissue.h"

namespace robot_tissue {
namespace {

constexpr double kIncrement = 0.001;  // m

struct Job {
  std::string name;
  double spacing = 0.0;
  double poisson_ratio = 0.0;

  double scale() const { return name == "large" ? 4.0 : 1.0; }
};

struct Choice {
  std::string method;
  double tolerance = 0.0;
};

TissueConfig tissueOf(const Job& job) {
  TissueConfig config;
  config.model = "elastic";
  config.shape.max = job.scale() * Vec3(0.10, 0.10, 0.05);
  config.spacing = job.spacing;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = job.poisson_ratio;
  config.fixed.push_back({Vec3::Zero(), job.scale() * Vec3(0.10, 0.10, 0.0)});
  if (job.name == "stiff") {
    Region region;
    region.name = "tumour";
    region.box = {Vec3(0.05, 0.03, 0.01), Vec3(0.08, 0.07, 0.03)};
    region.material = config.material;
    region.material.young_modulus *= 100.0;
    config.regions.push_back(region);
  }
  return config;
}

std::vector<Vec3> pathOf(const Job& job) {
  std::vector<Vec3> places;
  for (int i = 1; i <= 5; ++i) places.emplace_back(0.0, 0.0, -kIncrement * i);
  if (job.name != "drag" && job.name != "reverse") return places;
  for (int i = 1; i <= 5; ++i) places.emplace_back(kIncrement * i, 0.0, places[4].z());
  if (job.name == "drag") return places;
  for (int i = 4; i >= 0; --i) places.emplace_back(kIncrement * i, 0.0, places[4].z());
  return places;
}

LoadStep stepTo(const Job& job, const Vec3& place) {
  const Vec3 center = job.scale() * Vec3(0.05, 0.05, 0.05);
  PatchConfig patch;
  patch.name = "punch";
  patch.box = {center - Vec3(0.01, 0.01, 0.0), center + Vec3(0.01, 0.01, 0.0)};
  patch.displacement = std::array<std::optional<double>, 3>{{place.x(), place.y(), place.z()}};
  LoadStep step;
  step.increments = 1;
  step.patches.push_back(patch);
  return step;
}

Tissue makeTissue(const Job& job, const Choice& choice) {
  SolverConfig solver;
  solver.method = choice.method;
  solver.tolerance = choice.tolerance;
  return Tissue(tissueOf(job), solver);
}

SolveReport loadTo(const Job& job, const Vec3& place, Tissue& tissue) {
  SolveReport last;
  tissue.load(stepTo(job, place), [&](int, int, const SolveReport& report) { last = report; });
  return last;
}

using Shapes = std::vector<std::vector<Vec3>>;

// The exact shapes: from the file, and what is missing there from method newton.
Shapes exactShapes(const Job& job, const std::string& folder) {
  const std::vector<Vec3> path = pathOf(job);
  const bool plain = job.name == "drag" || job.name == "reverse";
  std::ostringstream name;
  name << folder << '/' << (plain ? "press" : job.name) << '_' << job.spacing << '_'
       << job.poisson_ratio << ".bin";
  Tissue tissue = makeTissue(job, {"newton", 0.01});
  const std::size_t nodes = tissue.state().displacement.size();
  Shapes shapes;
  std::ifstream file(name.str(), std::ios::binary);
  std::vector<Vec3> shape(nodes);
  const auto bytes = static_cast<std::streamsize>(nodes * sizeof(Vec3));
  while (shapes.size() < path.size() && file.read(reinterpret_cast<char*>(shape.data()), bytes)) {
    shapes.push_back(shape);
  }
  if (shapes.size() == path.size()) return shapes;
  shapes.clear();
  std::ofstream out(name.str(), std::ios::binary);
  for (const Vec3& place : path) {
    const SolveReport report = loadTo(job, place, tissue);
    std::fprintf(stderr, "newton %s %g %g: %s, %d steps, %.0f ms\n", job.name.c_str(), job.spacing,
                 job.poisson_ratio, toString(report.status), report.iterations, report.wall_ms);
    shapes.push_back(tissue.state().displacement);
    out.write(reinterpret_cast<const char*>(shapes.back().data()), bytes);
  }
  return shapes;
}

// Relative L2 over the nodes that are not hard in the patch.
double errorOf(const Tissue& tissue, const std::vector<Vec3>& exact) {
  std::vector<char> counts(exact.size(), 1);
  for (const int node : hardNodes(tissue.patches().front())) counts[at(node)] = 0;
  double missed = 0.0, moved = 0.0;
  for (std::size_t node = 0; node < exact.size(); ++node) {
    if (counts[node] == 0) continue;
    missed += (tissue.state().displacement[node] - exact[node]).squaredNorm();
    moved += exact[node].squaredNorm();
  }
  return std::sqrt(missed / moved);
}

void run(const Job& job, const Choice& choice, int repeat, const Shapes& exact) {
  using Clock = std::chrono::steady_clock;
  Tissue tissue = makeTissue(job, choice);
  const std::vector<Vec3> path = pathOf(job);
  for (std::size_t increment = 0; increment < path.size(); ++increment) {
    const Clock::time_point start = Clock::now();
    const SolveReport report = loadTo(job, path[increment], tissue);
    const std::chrono::duration<double, std::milli> load = Clock::now() - start;
    std::printf("%s,%s,%d,%g,%g,%d,%d,%.4g,%.4g,%.4g,%.4g,%d,%s\n", job.name.c_str(),
                choice.method.c_str(), tissue.lattice().nodeCount(), job.poisson_ratio,
                choice.tolerance, repeat, static_cast<int>(increment) + 1, report.wall_ms,
                load.count(), errorOf(tissue, exact[increment]), report.error_estimate,
                report.iterations, toString(report.status));
  }
  std::fflush(stdout);
}

std::vector<Choice> choicesOf(const std::string& argument) {
  const std::size_t colon = argument.find(':');
  std::vector<Choice> choices;
  std::istringstream tolerances(colon == std::string::npos ? "0.01" : argument.substr(colon + 1));
  for (std::string tolerance; std::getline(tolerances, tolerance, ',');) {
    choices.push_back({argument.substr(0, colon), std::stod(tolerance)});
  }
  return choices;
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  if (argc < 7) {
    std::cerr << "usage: speed JOB SPACING NU CACHE REPEATS METHOD:TOLERANCE[,TOLERANCE ...] ...\n";
    return 2;
  }
  try {
    const Job job = {argv[1], std::stod(argv[2]), std::stod(argv[3])};
    std::vector<Choice> choices;
    for (int i = 6; i < argc; ++i) {
      for (const Choice& choice : choicesOf(argv[i])) choices.push_back(choice);
    }
    const Shapes exact = exactShapes(job, argv[4]);
    std::printf(
        "job,method,nodes,nu,tolerance,repeat,increment,ms,load_ms,error,error_estimate,iterations,"
        "status\n");
    for (int repeat = 0; repeat < std::stoi(argv[5]); ++repeat) {
      for (const Choice& choice : choices) run(job, choice, repeat, exact);
    }
  } catch (const std::exception& error) {
    std::cerr << "speed: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
