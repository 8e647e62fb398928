// Measures what the choices of method `paper` do where the paper is silent, one choice at a time,
// and how many shapes the six-spring lattice holds without a force. Prints CSV; doc/paper.md reads
// it. Not a test: nothing here passes or fails.
//
//   paper_choices choices    one row for each choice, value and job
//   paper_choices modes      one row for each block: eigenvalues of its stiffness matrix
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "material/six_spring_model.h"
#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/surface.h"
#include "solvers/paper/paper_method.h"

namespace robot_tissue {
namespace {

using Drive = LoadingPatch::Drive;
using Order = PaperOptions::Order;

constexpr int kLoads = 6;             // each job at 1/6, 2/6 ... 6/6 of its load, as in the figures
constexpr int kRuns = 5;              // of one load, for the median time
constexpr double kLongEnough = 1000;  // ms: no more runs after that
constexpr double kMoved = 1e-6;       // of the spacing
const Vec3 kExtent(0.10, 0.10, 0.05);

std::size_t at(int index) { return static_cast<std::size_t>(index); }

struct Job {
  std::string name;
  bool bottom_fixed = false;
  Drive drive = Drive::kForce;
  Vec3 load = Vec3::Zero();  // N or m
  int steps = 12;
};

const std::vector<Job>& jobs() {
  static const std::vector<Job> all = {
      {"figure5", false, Drive::kForce, Vec3(0.0, 0.0, -12.0), 12},
      {"figure6", false, Drive::kForce, Vec3::Constant(6.0 / std::sqrt(3.0)), 12},
      {"press", true, Drive::kDisplacement, Vec3(0.0, 0.0, -0.005), 5}};
  return all;
}

// What config/paper_figure5.yaml and paper_figure6.yaml say, and the method's defaults.
struct Setup {
  double spacing = 0.01;     // m
  double stiffness = 300.0;  // N/m
  double patch = 0.02;       // m, side of the loading area
  int steps = 0;             // 0: the job's
  PaperOptions options;
};

struct Variation {
  std::string choice;
  std::string value;
  std::function<void(Setup&)> apply;
  std::string only_job;  // empty: all
};

struct Outcome {
  SolveStatus status = SolveStatus::kOk;  // worst of the steps
  double ms = 0.0;
  Vec3 patch_force = Vec3::Zero();
  Vec3 patch_displacement = Vec3::Zero();
  double greatest = 0.0;     // displacement of a node (m)
  Vec3 mean = Vec3::Zero();  // displacement of all nodes
  double volume_ratio = 1.0;
  double bottom = 0.0;     // greatest downward displacement of the bottom face (m)
  double side = 0.0;       // greatest outward displacement of a side face (m)
  double asymmetry = 0.0;  // greatest difference to the mirror image over the greatest displacement
  double residual = 0.0;
  int layers = 0;
  int moved = 0;
};

TissueConfig configOf(const Job& job, const Setup& setup) {
  TissueConfig config;
  config.shape = {Vec3::Zero(), kExtent};
  config.spacing = setup.spacing;
  config.material.spring_stiffness = setup.stiffness;
  if (job.bottom_fixed) config.fixed.push_back({Vec3(-1.0, -1.0, 0.0), Vec3(1.0, 1.0, 0.0)});
  return config;
}

LoadingPatch patchOf(const Job& job, const Setup& setup, const Lattice& lattice) {
  const Vec3 half(0.5 * setup.patch, 0.5 * setup.patch, 0.0);
  const Vec3 center(0.5 * kExtent.x(), 0.5 * kExtent.y(), kExtent.z());
  LoadingPatch patch;
  patch.nodes = lattice.nodesIn({center - half, center + half});
  patch.drive = job.drive;
  return patch;
}

// Difference to the image mirrored in the plane x = y, and for a straight load in x = 0.05 m.
double asymmetryOf(const Lattice& lattice, const LatticeState& state, bool straight) {
  double difference = 0.0;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const auto [i, j, k] = lattice.gridIndex(node);
    const Vec3& here = state.displacement[at(node)];
    const Vec3& swapped = state.displacement[at(lattice.node(j, i, k))];
    difference = std::max(difference, (here - Vec3(swapped.y(), swapped.x(), swapped.z())).norm());
    if (!straight) continue;
    const Vec3& image = state.displacement[at(lattice.node(lattice.size()[0] - 1 - i, j, k))];
    difference = std::max(difference, (here - Vec3(-image.x(), image.y(), image.z())).norm());
  }
  return difference;
}

void describeShape(const Lattice& lattice, const LatticeState& state, bool straight,
                   Outcome& outcome) {
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3& moved = state.displacement[at(node)];
    const auto index = lattice.gridIndex(node);
    outcome.greatest = std::max(outcome.greatest, moved.norm());
    outcome.mean += moved / lattice.nodeCount();
    if (moved.norm() > kMoved * lattice.spacing()) ++outcome.moved;
    if (index[2] == 0) outcome.bottom = std::max(outcome.bottom, -moved.z());
    for (int axis = 0; axis < 2; ++axis) {
      if (index[at(axis)] == 0) outcome.side = std::max(outcome.side, -moved[axis]);
      if (index[at(axis)] + 1 == lattice.size()[at(axis)]) {
        outcome.side = std::max(outcome.side, moved[axis]);
      }
    }
  }
  outcome.asymmetry = asymmetryOf(lattice, state, straight) / outcome.greatest;
  const TissueSurface surface = extractSurface(lattice, state);
  std::vector<Vec3> vertices;
  deform(surface, state.displacement, vertices);
  outcome.volume_ratio = enclosedVolume(surface, vertices) / enclosedVolume(surface, surface.rest);
}

// As Tissue::load does it: equal steps from rest. `share` of the job's load.
Outcome runOnce(const Job& job, const Setup& setup, double share) {
  const Lattice lattice(configOf(job, setup));
  const SixSpringModel model(lattice, Vec3::Zero());
  PaperMethod method(lattice, model, setup.options);
  LatticeState state = lattice.restState();
  LoadingPatch patch = patchOf(job, setup, lattice);
  const int steps = setup.steps > 0 ? setup.steps : job.steps;
  Outcome outcome;
  for (int step = 1; step <= steps; ++step) {
    const Vec3 load = share * step / steps * job.load;
    if (job.drive == Drive::kForce) patch.force = load;
    if (job.drive == Drive::kDisplacement) patch.displacement.assign(patch.nodes.size(), load);
    std::vector<LoadingPatch> patches = {patch};
    const SolveReport report = method.solve(patches, {}, state);
    outcome.ms += report.wall_ms;
    outcome.layers = std::max(outcome.layers, report.layers);
    outcome.residual = report.residual;
    outcome.patch_force = report.patches[0].force;
    outcome.patch_displacement = report.patches[0].displacement;
    outcome.status = std::max(outcome.status, report.status);
    if (countInvertedCells(lattice, state) > 0) outcome.status = SolveStatus::kInverted;
  }
  describeShape(lattice, state, job.load.head<2>().isZero(), outcome);
  return outcome;
}

Outcome runMedian(const Job& job, const Setup& setup, double share) {
  Outcome outcome;
  std::vector<double> times;
  double total = 0.0;
  while (times.size() < at(kRuns) && total < kLongEnough) {
    outcome = runOnce(job, setup, share);
    times.push_back(outcome.ms);
    total += outcome.ms;
  }
  std::sort(times.begin(), times.end());
  outcome.ms = times[times.size() / 2];
  return outcome;
}

template <typename Value>
void vary(std::vector<Variation>& all, const std::string& choice, const std::vector<Value>& values,
          const std::function<void(Setup&, Value)>& apply, const std::string& only_job = "") {
  for (const Value value : values) {
    char text[32];
    std::snprintf(text, sizeof(text), "%g", static_cast<double>(value));
    all.push_back({choice, text, [=](Setup& setup) { apply(setup, value); }, only_job});
  }
}

std::vector<Variation> methodVariations() {
  std::vector<Variation> all = {{"base", "", [](Setup&) {}, ""}};
  vary<int>(all, "steps", {1, 3, 5, 6, 12, 24, 50, 100},
            [](Setup& setup, int steps) { setup.steps = steps; });
  vary<double>(all, "balance_tolerance", {0.1, 0.03, 0.01, 0.003, 0.001},
               [](Setup& setup, double x) { setup.options.balance_tolerance = x; });
  all.push_back({"order", "two_color", [](Setup&) {}, ""});
  all.push_back({"order", "by_index", [](Setup& s) { s.options.order = Order::kByIndex; }, ""});
  vary<double>(all, "step_in_spacings", {0.05, 0.1, 0.2, 0.5, 1.0},
               [](Setup& setup, double x) { setup.options.step_in_spacings = x; });
  vary<int>(all, "passes", {1, 2, 5, 20, 100},
            [](Setup& setup, int passes) { setup.options.passes = passes; });
  for (const Order order : {Order::kTwoColor, Order::kByIndex}) {
    const auto iterate = [order](Setup& setup, int passes) {
      setup.options.passes = passes;
      setup.options.balance_tolerance = 1e-5;
      setup.options.order = order;
    };
    const bool by_color = order == Order::kTwoColor;
    vary<int>(all, by_color ? "passes_to_1e-5_two_color" : "passes_to_1e-5_by_index",
              {1, 10, 100, 1000}, iterate, "press");
  }
  return all;
}

std::vector<Variation> blockVariations() {
  std::vector<Variation> all;
  // Spacing in mm for 11 x 11 x 6, 21 x 21 x 11 and 41 x 41 x 21 nodes. A spring's stiffness
  // times its length over its share of the cross section is the material's: k over h stays.
  vary<double>(all, "spacing_same_modulus", {10.0, 5.0, 2.5}, [](Setup& setup, double mm) {
    setup.stiffness *= 1e-3 * mm / setup.spacing;
    setup.spacing = 1e-3 * mm;
  });
  vary<double>(all, "spacing_same_spring", {10.0, 5.0, 2.5},
               [](Setup& setup, double mm) { setup.spacing = 1e-3 * mm; });
  vary<double>(all, "stiffness_factor", {0.5, 2.5 / 3.0, 1.0, 2.0, 4.0},
               [](Setup& setup, double factor) { setup.stiffness *= factor; });
  vary<double>(all, "patch_mm", {0.0, 20.0, 40.0, 60.0},
               [](Setup& setup, double mm) { setup.patch = 1e-3 * mm; });
  return all;
}

void measure(const Variation& variation, const Job& job) {
  Setup setup;
  variation.apply(setup);
  std::vector<Outcome> outcomes;
  double ms_of_all = 0.0;
  int ok = 0;
  bool grows = true;
  for (int load = 1; load <= kLoads; ++load) {
    outcomes.push_back(runMedian(job, setup, static_cast<double>(load) / kLoads));
    ms_of_all += outcomes.back().ms;
    if (outcomes.back().status == SolveStatus::kOk) ++ok;
    if (load > 1 && outcomes.back().greatest <= outcomes[at(load) - 2].greatest) grows = false;
  }
  const Outcome& full = outcomes.back();
  std::printf("%s,%s,%s,%d,%s,%d,%s,%.4f,%.4f,%.4f,%.4f,%.6f,%.4f,%.4f,%.3f,%.3f,%d,%d,%.2g,%.2g\n",
              variation.choice.c_str(), variation.value.c_str(), job.name.c_str(),
              setup.steps > 0 ? setup.steps : job.steps, toString(full.status), ok,
              grows ? "yes" : "no", 1e3 * full.patch_displacement.norm(), full.patch_force.norm(),
              1e3 * full.greatest, 1e3 * full.mean.norm(), full.volume_ratio, 1e3 * full.bottom,
              1e3 * full.side, full.ms, ms_of_all, full.layers, full.moved, full.asymmetry,
              full.residual);
  std::fflush(stdout);
}

void printChoices() {
  std::cout << "# Every job at 1/6 to 6/6 of its load; all columns but loads_ok, grows and "
               "ms_of_six_loads are those of the full load.\n"
               "# loads_ok: loads of six with status OK. grows: the greatest displacement grew "
               "from load to load. ms: median.\n"
               "choice,value,job,steps,status,loads_ok,grows,patch_mm,force_n,greatest_mm,mean_mm,"
               "volume_ratio,bottom_bulge_mm,side_bulge_mm,ms,ms_of_six_loads,layers,nodes_moved,"
               "asymmetry,residual"
            << std::endl;
  std::vector<Variation> all = methodVariations();
  const std::vector<Variation> of_block = blockVariations();
  all.insert(all.end(), of_block.begin(), of_block.end());
  for (const Variation& variation : all) {
    for (const Job& job : jobs()) {
      if (!variation.only_job.empty() && variation.only_job != job.name) continue;
      std::cerr << variation.choice << ' ' << variation.value << ", " << job.name << std::endl;
      measure(variation, job);
    }
  }
}

// Stiffness matrix over the nodes that are neither fixed nor in the patch, from central
// differences of the node forces.
Eigen::MatrixXd stiffnessMatrix(const Lattice& lattice, const SixSpringModel& model,
                                LatticeState state, const std::vector<int>& held) {
  std::vector<int> unknown(at(lattice.nodeCount()), -1);
  int count = 0;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    if (lattice.isFixed(node) || std::binary_search(held.begin(), held.end(), node)) continue;
    unknown[at(node)] = 3 * count++;
  }
  const double small = 1e-6 * lattice.spacing();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * count, 3 * count);
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    if (unknown[at(node)] < 0) continue;
    std::vector<int> touched = {node};
    for (int direction = 0; direction < kNeighbors; ++direction) {
      const int other = lattice.neighbor(node, direction);
      if (other >= 0 && unknown[at(other)] >= 0) touched.push_back(other);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double start = state.displacement[at(node)][axis];
      for (const double sign : {1.0, -1.0}) {
        state.displacement[at(node)][axis] = start + sign * small;
        for (const int other : touched) {
          matrix.block<3, 1>(unknown[at(other)], unknown[at(node)] + axis) -=
              sign / (2.0 * small) * model.nodeForce(state, other);
        }
      }
      state.displacement[at(node)][axis] = start;
    }
  }
  return 0.5 * (matrix + matrix.transpose());
}

// `depth`: press of the patch in one step before (m).
void printModesOf(const std::string& name, const Job& job, bool patch_held, double depth) {
  std::cerr << name << std::endl;
  const Setup setup;
  const Lattice lattice(configOf(job, setup));
  const SixSpringModel model(lattice, Vec3::Zero());
  LatticeState state = lattice.restState();
  LoadingPatch patch = patchOf(job, setup, lattice);
  if (depth > 0.0) {
    patch.drive = Drive::kDisplacement;
    patch.displacement.assign(patch.nodes.size(), Vec3(0.0, 0.0, -depth));
    std::vector<LoadingPatch> patches = {patch};
    PaperMethod(lattice, model, setup.options).solve(patches, {}, state);
  }
  const Eigen::MatrixXd matrix =
      stiffnessMatrix(lattice, model, state, patch_held ? patch.nodes : std::vector<int>());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
  const Eigen::ArrayXd relative = solver.eigenvalues().array() / setup.stiffness;
  constexpr double kZero = 1e-6;
  std::printf("%s,%d,%d,%d,%.3g,%.3g\n", name.c_str(), static_cast<int>(relative.size()),
              static_cast<int>((relative.abs() <= kZero).count()),
              static_cast<int>((relative < -kZero).count()), relative.minCoeff(),
              relative.maxCoeff());
  std::fflush(stdout);
}

void printModes() {
  std::cout << "# 11 x 11 x 6 nodes; eigenvalues over a spring's stiffness; zero: below 1e-6\n"
               "block,unknowns,zero_modes,negative_modes,smallest,greatest"
            << std::endl;
  const Job& floating = jobs()[0];
  const Job& fixed = jobs()[2];
  printModesOf("floating at rest", floating, false, 0.0);
  printModesOf("bottom fixed at rest", fixed, false, 0.0);
  printModesOf("bottom fixed and patch held at rest", fixed, true, 0.0);
  printModesOf("bottom fixed and patch pressed by 0.01 mm", fixed, true, 1e-5);
  printModesOf("bottom fixed and patch pressed by 1 mm", fixed, true, 1e-3);
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.compare(0, 10, "model name") == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string compiler() {
#ifdef __clang__
  return __VERSION__;  // names itself
#else
  return std::string("GCC ") + __VERSION__;
#endif
}

int run(const std::string& what) {
  if (what != "choices" && what != "modes") {
    std::cerr << "usage: paper_choices choices|modes" << std::endl;
    return 2;
  }
  std::cout << "# processor: " << processor() << ", one thread\n# compiler: " << compiler() << "\n";
  what == "choices" ? printChoices() : printModes();
  return 0;
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) { return robot_tissue::run(argc == 2 ? argv[1] : ""); }
