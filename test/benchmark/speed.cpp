// Milliseconds per increment and the true error they buy, for any method: a patch of 20 x 20 mm
// pressed 5 mm into a block of 100 x 100 x 50 mm, 1 mm an increment. Prints CSV, a row an
// increment; doc/baselines.md reads it. Not a test: nothing here passes or fails.
//
//   speed JOB SPACING NU CACHE REPEATS METHOD:TOLERANCE[,TOLERANCE ...] ...
//
// JOB: press; drag: then drawn 5 mm aside; reverse: then 5 mm back; stiff: press over a region a
// hundred times stiffer; large: press into a block four times as long, wide and high. The error is
// against method `newton`, whose shapes are kept in the folder CACHE. In a repeat each method and
// tolerance has one run, so that what else the machine does meets all of them. Methods vbd_plain
// and vbd_chebyshev are vbd with another acceleration.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "loads/patch_rim.h"
#include "material/elastic_model.h"
#include "robot_tissue/core/tissue.h"
#include "solvers/baselines/vbd_method.h"
#include "tissue/registry.h"

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
  config.shape.max() = job.scale() * Vec3(0.10, 0.10, 0.05);
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

SolverConfig solverOf(const Choice& choice) {
  SolverConfig solver;
  solver.method = choice.method.substr(0, choice.method.find('_'));
  solver.tolerance = choice.tolerance;
  return solver;
}

Tissue makeTissue(const Job& job, const Choice& choice) {
  return Tissue(tissueOf(job), solverOf(choice));
}

// What Tissue does with one patch, for methods that the registry does not have.
class Bench {
 public:
  Bench(const Job& job, const Choice& choice)
      : lattice_(tissueOf(job)), model_(lattice_, tissueOf(job)) {
    VbdOptions options;
    options.tolerance = choice.tolerance;
    if (choice.method == "vbd_plain") options.acceleration = VbdOptions::Acceleration::kNone;
    if (choice.method == "vbd_chebyshev") {
      options.acceleration = VbdOptions::Acceleration::kChebyshev;
    }
    method_ = options.acceleration == VbdOptions::Acceleration::kOverRelaxed
                  ? makeMethod(solverOf(choice), lattice_, model_)
                  : std::make_unique<VbdMethod>(lattice_, model_, options);
    state_ = lattice_.restState();
    const Box box = stepTo(job, Vec3::Zero()).patches.front().box;
    patches_.resize(1);
    patches_.front().nodes = lattice_.nodesIn(box);
    patches_.front().rim = rimOf(lattice_, model_, state_, box, patches_.front().nodes);
  }

  SolveReport loadTo(const Vec3& place) {
    method_->beginStep(state_);
    patches_.front().displacement.assign(patches_.front().nodes.size(), place);
    for (RimSpring& spring : patches_.front().rim) spring.anchor = place;
    return method_->solve(patches_, {}, state_);
  }

  // Relative L2 over the nodes that are not hard in the patch.
  double errorTo(const std::vector<Vec3>& exact) const {
    std::vector<char> counts(exact.size(), 1);
    for (const int node : hardNodes(patches_.front())) counts[at(node)] = 0;
    double missed = 0.0, moved = 0.0;
    for (std::size_t node = 0; node < exact.size(); ++node) {
      if (counts[node] == 0) continue;
      missed += (state_.displacement[node] - exact[node]).squaredNorm();
      moved += exact[node].squaredNorm();
    }
    return std::sqrt(missed / moved);
  }

 private:
  Lattice lattice_;
  ElasticModel model_;
  std::unique_ptr<SolverMethod> method_;
  LatticeState state_;
  std::vector<LoadingPatch> patches_;
};

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

// Prints also what Tissue::load takes, the solve included, on its own way through the same job.
void run(const Job& job, const Choice& choice, int repeat, const Shapes& exact) {
  using Clock = std::chrono::steady_clock;
  Bench bench(job, choice);
  Tissue tissue = makeTissue(job, choice);
  const bool whole = choice.method == solverOf(choice).method;
  const std::vector<Vec3> path = pathOf(job);
  for (std::size_t increment = 0; increment < path.size(); ++increment) {
    const SolveReport report = bench.loadTo(path[increment]);
    std::chrono::duration<double, std::milli> load(0.0);
    if (whole) {
      const Clock::time_point start = Clock::now();
      loadTo(job, path[increment], tissue);
      load = Clock::now() - start;
    }
    std::printf("%s,%s,%zu,%g,%g,%d,%zu,%.4g,%.4g,%.4g,%.4g,%d,%s\n", job.name.c_str(),
                choice.method.c_str(), exact.front().size(), job.poisson_ratio, choice.tolerance,
                repeat, increment + 1, report.wall_ms, load.count(),
                bench.errorTo(exact[increment]), report.error_estimate, report.iterations,
                toString(report.status));
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
