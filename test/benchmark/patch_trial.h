// A patch of 20 x 20 mm on a block of SCALE times 100 x 100 x 50 mm, bottom fixed: what programs
// that time method `layered` under loads share.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "robot_tissue/core/tissue.h"
#include "timing.h"

namespace robot_tissue {

constexpr double kExact = 1e-5;  // tolerance of what counts as right

struct PatchJob {
  double spacing, scale, poisson_ratio, tolerance;
  int threads;
};

inline TissueConfig blockOf(const PatchJob& job) {
  TissueConfig config;
  config.model = "elastic";
  config.shape.max() = job.scale * Vec3(0.1, 0.1, 0.05);
  config.spacing = job.spacing;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = job.poisson_ratio;
  Box bottom = config.shape;
  bottom.max().z() = 0.0;
  config.fixed.push_back(bottom);
  return config;
}

inline SolverConfig solverOf(const PatchJob& job, double tolerance) {
  SolverConfig solver;
  solver.tolerance = tolerance;
  solver.threads = job.threads;
  return solver;
}

inline LoadStep stepTo(const PatchJob& job, const Vec3& place) {
  const Vec3 middle = job.scale * Vec3(0.05, 0.05, 0.05), reach(0.01, 0.01, 0.0);
  PatchConfig patch;
  patch.name = "punch";
  patch.box = {middle - reach, middle + reach};
  patch.displacement = {place.x(), place.y(), place.z()};
  LoadStep step;
  step.increments = 1;
  step.patches.push_back(patch);
  return step;
}

// Of the calling thread: the linear algebra library has one of its own that waits busily at first.
inline double errorOf(const Tissue& tissue, const Tissue& exact) {
  double missed = 0.0, moved = 0.0;
  for (std::size_t node = 0; node < exact.state().displacement.size(); ++node) {
    const Vec3& right = exact.state().displacement[node];
    missed += (tissue.state().displacement[node] - right).squaredNorm();
    moved += right.squaredNorm();
  }
  return std::sqrt(missed / moved);
}

}  // namespace robot_tissue
