// A scene of one load on a box, solved by Bullet instead of the package, for the study
// speed_accuracy: reads what `simulate` reads and writes the files that it writes. doc/baselines.md
// says what Bullet is given and what came of it.
//
//   bullet_peer SCENE.yaml --out DIR --method METHOD [--tolerance T] [--steps N] [--quiet]
//     [--time-step S] [--iterations N] [--ramp N] [--damping D] [--stiffness K]
//   bullet_peer --list-methods
//
// An increment is done when no node goes farther in a step than T of the increment (0.01), or after
// N steps (2000): UNCONVERGED. The second line of options tries other settings than the best found.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "bullet_body.h"
#include "bullet_options.h"
#include "output_folder.h"
#include "result_text.h"
#include "robot_tissue/scene/command_line.h"
#include "robot_tissue/scene/scene_parser.h"
#include "robot_tissue/scene/value_text.h"
#include "run_scene.h"
#include "simulate.h"
#include "timing.h"

namespace robot_tissue {
namespace {

// The greatest number of steps an increment, and how far a step may still go (of the increment).
struct Rest {
  double tolerance = 0.01;
  int most_steps = 2000;
};

BulletSettings settingsOf(const CommandLine& line, const Lattice& lattice) {
  BulletSettings settings = bestSettings(line.value("--method").value_or(""), lattice);
  settings.time_step = numberOf(line, "--time-step", settings.time_step);
  settings.iterations = wholeNumberOf(line, "--iterations", settings.iterations);
  settings.ramp = wholeNumberOf(line, "--ramp", settings.ramp);
  settings.damping = numberOf(line, "--damping", settings.damping);
  settings.stiffness = numberOf(line, "--stiffness", settings.stiffness);
  return settings;
}

const LoadStep& loadOf(const Scene& scene) {
  const auto* load = scene.steps.size() == 1 ? std::get_if<LoadStep>(&scene.steps[0]) : nullptr;
  if (load == nullptr || scene.tissue.mesh || !load->increments) {
    throw InputError("steps: Bullet is given one load with a number of increments, on a box");
  }
  for (const PatchConfig& patch : load->patches) {
    if (!patch.displacement) throw InputError("patches: Bullet is given displacements alone");
  }
  return *load;
}

class Peer {
 public:
  Peer(const Scene& scene, const CommandLine& line, const Rest& rest)
      : load_(loadOf(scene)), lattice_(scene.tissue), rest_(rest), held_(heldNodes(scene)) {
    const BulletSettings settings = settingsOf(line, lattice_);
    ramp_ = settings.ramp;
    body_ = line.value("--method") == "bullet_soft"
                ? makeBulletSoft(lattice_, held_, settings)
                : makeBulletDeformable(lattice_, held_, scene.tissue.material, settings);
    tetrahedra_ = tetrahedraOf(lattice_);
    shape_.assign(held_.size(), Vec3::Zero());
    rest_volume_ = measureVolume().total;
    body_->step();  // what the first builds is not of an increment
  }

  RunResult run() {
    RunResult result;
    for (int increment = 1; increment <= *load_.increments; ++increment) {
      IncrementRow row;
      row.increment = increment;
      row.report = advance(increment);
      result.increments.push_back(row);
      keepForces(increment, result);
    }
    for (int node = 0; node < lattice_.nodeCount(); ++node) {
      result.rest.push_back(lattice_.restPosition(node));
    }
    result.displacement = shape_;
    return result;
  }

  double processorMs() const { return processor_ms_; }

 private:
  struct Volume {
    double total = 0.0;
    int inverted = 0;
  };

  std::vector<BulletBody::Axes> heldNodes(const Scene& scene) const {
    std::vector<BulletBody::Axes> held(at(lattice_.nodeCount()), {{false, false, false}});
    for (const PatchConfig& patch : load_.patches) {
      for (const int node : lattice_.nodesIn(patch.box)) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          held[at(node)][axis] = (*patch.displacement)[axis].has_value();
        }
      }
    }
    for (const Box& box : scene.tissue.fixed) {
      for (const int node : lattice_.nodesIn(box)) held[at(node)] = {{true, true, true}};
    }
    return held;
  }

  void place(double share) {
    for (const PatchConfig& patch : load_.patches) {
      Vec3 displacement = Vec3::Zero();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        displacement[static_cast<int>(axis)] = share * (*patch.displacement)[axis].value_or(0.0);
      }
      for (const int node : lattice_.nodesIn(patch.box)) body_->hold(node, displacement);
    }
  }

  double wayOfIncrement() const {
    double longest = 0.0;
    for (const PatchConfig& patch : load_.patches) {
      double way = 0.0;
      for (const auto& part : *patch.displacement) way += part.value_or(0.0) * part.value_or(0.0);
      longest = std::max(longest, std::sqrt(way) / *load_.increments);
    }
    return longest;
  }

  // Of the longest way that a node went since the last look (m).
  double look() {
    double longest = 0.0;
    for (int node = 0; node < lattice_.nodeCount(); ++node) {
      const Vec3 now = body_->displacement(node);
      longest = std::max(longest, (now - shape_[at(node)]).norm());
      shape_[at(node)] = now;
    }
    return longest;
  }

  SolveReport advance(int increment) {
    SolveReport report;
    const double still = rest_.tolerance * wayOfIncrement();
    const Clock::time_point began = Clock::now();
    const double processor_began = robot_tissue::processorMs();
    report.status = SolveStatus::kUnconverged;
    while (report.iterations < rest_.most_steps && report.status != SolveStatus::kOk) {
      ++report.iterations;
      const int to_come = std::max(0, ramp_ - report.iterations);
      place((increment - static_cast<double>(to_come) / ramp_) / *load_.increments);
      look();
      body_->step();
      if (look() < still && to_come == 0) report.status = SolveStatus::kOk;
    }
    processor_ms_ += robot_tissue::processorMs() - processor_began;
    report.wall_ms = millisecondsSince(began);
    const Volume volume = measureVolume();
    report.volume_ratio = volume.total / rest_volume_;
    report.inverted_cells = volume.inverted;
    if (volume.inverted > 0) report.status = SolveStatus::kInverted;
    report.active_nodes = lattice_.nodeCount();
    return report;
  }

  void keepForces(int increment, RunResult& result) {
    for (const PatchConfig& patch : load_.patches) {
      const auto force = body_->force(lattice_.nodesIn(patch.box));
      if (!force) continue;
      PatchRow row;
      row.increment = increment;
      row.patch = patch.name;
      row.answer.force = *force;
      row.answer.displacement = shape_[at(lattice_.nodesIn(patch.box).front())];
      result.patches.push_back(row);
    }
  }

  Volume measureVolume() const {
    Volume volume;
    for (const auto& nodes : tetrahedra_) {
      std::array<Vec3, 4> corners;
      for (std::size_t i = 0; i < 4; ++i) {
        corners[i] = lattice_.restPosition(nodes[i]) + shape_[at(nodes[i])];
      }
      const double own =
          (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[3] - corners[0]) /
          6.0;
      volume.total += own;
      if (own <= 0.0) ++volume.inverted;
    }
    return volume;
  }

  const LoadStep& load_;
  Lattice lattice_;
  Rest rest_;
  int ramp_ = 1;                        // steps
  std::vector<BulletBody::Axes> held_;  // per node
  std::unique_ptr<BulletBody> body_;
  std::vector<std::array<int, 4>> tetrahedra_;
  std::vector<Vec3> shape_;   // displacement per node (m)
  double rest_volume_ = 0.0;  // m^3
  double processor_ms_ = 0.0;
};

void write(const RunResult& result, OutputFolder& folder) {
  folder.write("nodes.csv", nodesCsv(result));
  folder.write("patches.csv", patchesCsv(result));
  folder.write("increments.csv", incrementsCsv(result));
  folder.write("tools.csv", toolsCsv(result));
  folder.commit();
}

void tell(const RunResult& result, double processor_ms) {
  int steps = 0;
  double wall_ms = 0.0;
  for (const IncrementRow& row : result.increments) {
    steps += row.report.iterations;
    wall_ms += row.report.wall_ms;
  }
  const auto increments = static_cast<double>(result.increments.size());
  std::cout << "an increment took " << steps / increments << " steps, " << wall_ms / increments
            << " ms, of the processor " << processor_ms / increments << " ms\n";
}

int solve(const CommandLine& line) {
  Rest rest;
  rest.tolerance = numberOf(line, "--tolerance", rest.tolerance);
  rest.most_steps = static_cast<int>(numberOf(line, "--steps", rest.most_steps));
  if (line.file(0).empty() || !line.value("--out"))
    throw InputError("SCENE.yaml and --out are needed");
  const Scene scene = loadScene(line.file(0));
  OutputFolder folder(*line.value("--out"),
                      {"nodes.csv", "patches.csv", "increments.csv", "tools.csv"});
  Peer peer(scene, line, rest);
  const RunResult result = peer.run();
  write(result, folder);
  if (!line.has("--quiet")) tell(result, peer.processorMs());
  return result.allOk() ? kExitOk : kExitNotAllOk;
}

int run(const std::vector<std::string>& words) {
  return exitCodeOf("bullet_peer", std::cerr, [&words] {
    const CommandLine line =
        readCommandLine(words, {{"--out", "--method", "--tolerance", "--steps", "--time-step",
                                 "--iterations", "--ramp", "--damping", "--stiffness"},
                                {"--quiet", "--list-methods"}});
    if (!line.has("--list-methods")) return solve(line);
    for (const std::string& method : bulletMethods()) std::cout << method << '\n';
    return kExitOk;
  });
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  return robot_tissue::run(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
}
