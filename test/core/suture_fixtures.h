// Blocks that are cut in two and sutured.
#pragma once

#include <string>
#include <vector>

#include "elastic_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue {

constexpr double kSutureSpacing = 0.005;
constexpr double kCutAt = 0.0225;  // m, halfway between two planes of nodes

// 45 x 20 x 20 mm, clamped at x = 0.
inline TissueConfig barOf(double poisson_ratio = 0.45) {
  TissueConfig config = blockOf(9, 4, 4, kSutureSpacing);
  config.model = "elastic";
  config.material.poisson_ratio = poisson_ratio;
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, 4, 4}));
  return config;
}

inline SolverConfig solverWith(const std::string& method, double tolerance = 1e-3) {
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = tolerance;
  return solver;
}

inline std::vector<Vec3> planeAt(double x, double low = -1.0) {
  return {{x, -1.0, low}, {x, 1.0, low}, {x, 1.0, 1.0}, {x, -1.0, 1.0}};
}

inline SutureConfig threadOf(const std::string& name, const Vec3& from, const Vec3& to) {
  SutureConfig config;
  config.name = name;
  config.from = from;
  config.to = to;
  return config;
}

// Across the cut, on the bar's four sides every 5 mm, as long as their ends are apart.
inline std::vector<SutureConfig> stitches() {
  std::vector<SutureConfig> all;
  for (int i = 0; i <= 4; ++i) {
    for (int j = 0; j <= 4; ++j) {
      if (i > 0 && i < 4 && j > 0 && j < 4) continue;
      const double y = kSutureSpacing * i, z = kSutureSpacing * j;
      all.push_back(threadOf("s" + std::to_string(all.size() + 1), {0.02, y, z}, {0.025, y, z}));
      all.back().rest_length = 0.005;
    }
  }
  return all;
}

// Draws the bar's free end along x.
inline LoadStep pullBy(const TissueConfig& config, double way) {
  return loadOf({displacedPatch("end", nodeBox(config, {9, 0, 0}, {9, 4, 4}), Vec3(way, 0, 0))});
}

inline double pullOf(const Tissue& tissue) { return tissue.lastReport().patches[0].force.x(); }

}  // namespace robot_tissue
