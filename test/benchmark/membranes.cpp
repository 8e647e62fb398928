// A hollow sphere that is a membrane alone, on a filling as soft as allowed, against closed forms
// (doc/accuracy.md, "Membranes"): blown up a little and far; pinched at two poles. And how many
// cycles `layered` takes as a membrane gets stiffer, on a block and around a ball.
//   membranes blown|pinched|cycles|ball
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "core/membrane_fixtures.h"
#include "core/mesh_fixtures.h"
#include "robot_tissue/core/tissue.h"

using namespace robot_tissue;

namespace {

constexpr double kRadius = 0.03;   // m
constexpr double kModulus = 1e5;   // Pa
constexpr double kFilling = 1e-2;  // Pa; contrast to the membranes below: 1e6 to 2e6

// `rounds` of sphereMesh: edges of about 1.5 R / 2^rounds, in the lattice at most a spacing.
TissueConfig ball(double spacing, int rounds) {
  TissueConfig config;
  config.model = "elastic";
  config.spacing = spacing;
  config.material.young_modulus = kFilling;
  config.material.poisson_ratio = 0.25;
  const Vec3 off(0.13 * spacing, 0.29 * spacing, 0.41 * spacing);
  config.mesh = std::make_shared<const TriangleMesh>(moved(sphereMesh(kRadius, rounds), off));
  return config;
}

const char* nameOf(SolveStatus status) {
  return status == SolveStatus::kOk ? "OK" : status == SolveStatus::kLate ? "LATE" : "UNCONVERGED";
}

// W = mu t / 2 [tr C - 2 + (det C^-s - 1) / s] of a sphere stretched by L: p = 2 mu t / R (1 / L -
// L^(-3 - 4 s)); at small strain p = 2 E t / ((1 - nu) R) (L - 1).
void blow(double spacing, double ratio, double pressure) {
  constexpr double kThickness = 1e-3;
  TissueConfig config = ball(spacing, 4);
  config.membranes = {skin(kThickness, kModulus, ratio)};
  config.membranes[0].pressure = pressure;
  SolverConfig solver;
  solver.method = "newton";
  Tissue tissue(config, solver);
  const double rest = radiusOf(tissue);
  const SolveReport report = tissue.settle();
  const double stretch = radiusOf(tissue) / rest;
  const double mu = kModulus / (2.0 * (1.0 + ratio)), s = ratio / (1.0 - ratio);
  const double expected =
      2.0 * mu * kThickness / kRadius * (1.0 / stretch - std::pow(stretch, -3.0 - 4.0 * s));
  std::printf("blown,%g,%g,%g,%.5f,%.4f,%s,%d\n", spacing, ratio, pressure, stretch,
              pressure / expected, nameOf(report.status), report.iterations);
  std::fflush(stdout);
}

// A thread draws two poles together by a twentieth of the thickness each. Reissner (1946): a point
// force on a shallow sphere meets k = 4 E t^2 / (R sqrt(3 (1 - nu^2))).
void pinch(double spacing, int rounds, double thickness) {
  constexpr double kRatio = 0.3;
  TissueConfig config = ball(spacing, rounds);
  config.membranes = {skin(thickness, kModulus, kRatio)};
  SolverConfig solver;
  solver.method = "newton";
  Tissue tissue(config, solver);
  const Vec3 off(0.13 * spacing, 0.29 * spacing, 0.41 * spacing);
  SutureConfig thread;
  thread.name = "pinch";
  thread.from = off + Vec3(0, 0, -kRadius);
  thread.to = off + Vec3(0, 0, kRadius);
  thread.rest_length = 2.0 * kRadius - 0.1 * thickness;
  thread.stiffness = 1e4;
  const SutureResult result = tissue.suture(thread);
  const double way = 0.5 * (2.0 * kRadius - result.suture.length);
  const double expected =
      4.0 * kModulus * thickness * thickness / (kRadius * std::sqrt(3.0 * (1.0 - kRatio * kRatio)));
  std::printf("pinched,%g,%d,%g,%.5f,%.4f,%s,%d\n", spacing, rounds, thickness, way / thickness,
              result.suture.tension / way / expected, nameOf(result.solve.status),
              tissue.lattice().nodeCount());
  std::fflush(stdout);
}

// In one increment, at a tolerance of 1e-3.
SolveReport pushedDown(const TissueConfig& config, const char* method, const Box& patch_box,
                       double way) {
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = 1e-3;
  Tissue tissue(config, solver);
  LoadStep step;
  PatchConfig patch;
  patch.name = "push";
  patch.box = patch_box;
  patch.displacement = {{0.0, 0.0, -way}};
  step.increments = 1;
  step.patches = {patch};
  tissue.load(step);
  return tissue.lastReport();
}

// A block pressed at its top, 1/12 of its width wide, with a capsule of so many times the stiffness
// of a layer of its cells.
void press(const char* method, double contrast) {
  TissueConfig config;
  config.model = "elastic";
  config.spacing = 0.005;
  config.shape.max() = Vec3(0.09, 0.09, 0.045);
  config.material.young_modulus = 1e4;
  config.fixed = {{Vec3(-1, -1, -1), Vec3(1, 1, 1e-6)}};
  if (contrast > 0.0) {
    config.membranes = {skin(1e-3, kModulus)};
    config.membranes[0].young_modulus = contrast * 1e4 * config.spacing / 1e-3;
  }
  const Box at_top = {Vec3(0.04, 0.04, 0.045), Vec3(0.05, 0.05, 0.045)};
  const SolveReport report = pushedDown(config, method, at_top, 0.002);
  std::printf("cycles,%s,%g,%.5f,%s,%d,%.1f\n", method, contrast, -report.patches[0].force.z(),
              nameOf(report.status), report.iterations, report.wall_ms);
  std::fflush(stdout);
}

// A ball held at its bottom, its top pushed down, with a capsule of 1 mm off the grid.
void push(const char* method, double contrast, double way) {
  TissueConfig config = ball(0.004, 4);
  config.material.young_modulus = 4e3;
  config.material.poisson_ratio = 0.45;
  config.fixed = {{Vec3(-1, -1, -1), Vec3(1, 1, -0.8 * kRadius)}};
  constexpr double kThickness = 1e-3;
  const double stiffness = contrast * config.material.young_modulus * config.spacing;
  config.membranes = {skin(kThickness, stiffness / kThickness)};
  const Box at_top = {Vec3(-1, -1, 0.9 * kRadius), Vec3(1, 1, 1)};
  const SolveReport report = pushedDown(config, method, at_top, way);
  std::printf("ball,%s,%g,%g,%.6f,%s,%d,%.1f\n", method, contrast, way,
              -report.patches[0].force.z(), nameOf(report.status), report.iterations,
              report.wall_ms);
  std::fflush(stdout);
}

bool isAsked(int count, char** words, const char* part) {
  return count < 2 || std::strcmp(words[1], part) == 0;
}

}  // namespace

int main(int count, char** words) {
  if (isAsked(count, words, "blown")) {
    std::puts("# blown,spacing,ratio,pressure,stretch,over closed form,status,iterations");
    for (const double spacing : {0.01, 0.006}) {
      for (const double ratio : {0.0, 0.3, 0.5}) blow(spacing, ratio, 50.0);
      for (const double pressure : {800.0, 1200.0, 1300.0, 1500.0}) blow(spacing, 0.5, pressure);
    }
  }
  if (isAsked(count, words, "pinched")) {
    std::puts("# pinched,spacing,rounds,thickness,way over thickness,over Reissner,status,nodes");
    for (const double thickness : {0.003, 0.002}) {
      for (const double spacing : {0.006, 0.004, 0.003}) {
        if (thickness <= spacing) pinch(spacing, 5, thickness);
      }
    }
    for (const int rounds : {3, 4}) pinch(0.004, rounds, 0.003);
  }
  if (isAsked(count, words, "cycles")) {
    std::puts("# cycles,method,contrast,force,status,iterations,ms");
    for (const double contrast : {0.0, 0.1, 1.0, 10.0, 100.0, 1000.0}) {
      for (const char* method : {"layered", "newton"}) press(method, contrast);
    }
  }
  if (isAsked(count, words, "ball")) {
    std::puts("# ball,method,contrast,way,force,status,iterations,ms");
    for (const double way : {1e-5, 1e-4, 5e-4, 2e-3}) {
      for (const double contrast : {0.1, 1.0, 10.0, 100.0}) {
        for (const char* method : {"layered", "newton"}) push(method, contrast, way);
      }
    }
  }
}
