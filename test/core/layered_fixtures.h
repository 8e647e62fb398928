// A block with method `layered` on it, next to one with the exact method.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "elastic_fixtures.h"
#include "loads/patch_rim.h"
#include "solvers/multigrid/cycle/layered_method.h"

namespace robot_tissue {

struct LayeredBlock {
  explicit LayeredBlock(const TissueConfig& config, const LayeredOptions& options = {})
      : lattice(config),
        model(lattice, config),
        method(lattice, model, options),
        state(lattice.restState()) {}

  // Patches by force go on from where the last solve moved them.
  SolveReport solve(std::vector<LoadingPatch> loads, const std::vector<int>& disturbed = {}) {
    patches = std::move(loads);
    return method.solve(patches, disturbed, state);
  }

  Lattice lattice;
  ElasticModel model;
  LayeredMethod method;
  LatticeState state;
  std::vector<LoadingPatch> patches;
};

inline LayeredOptions within(double tolerance) {
  LayeredOptions options;
  options.tolerance = tolerance;
  return options;
}

// Relative L2 over the nodes that are not fixed and not held in a patch.
inline double errorOf(const Lattice& lattice, const std::vector<LoadingPatch>& patches,
                      const std::vector<Vec3>& displacement, const std::vector<Vec3>& exact) {
  std::vector<char> counts(displacement.size(), 1);
  for (const int node : nodesOf(lattice)) {
    if (lattice.isFixed(node)) counts[at(node)] = 0;
  }
  for (const LoadingPatch& patch : patches) {
    const bool free = patch.free_axis[0] || patch.free_axis[1] || patch.free_axis[2];
    if (free || patch.drive == LoadingPatch::Drive::kForce) continue;
    for (const int node : hardNodes(patch)) counts[at(node)] = 0;
  }
  double missed = 0.0, moved = 0.0;
  for (std::size_t node = 0; node < exact.size(); ++node) {
    if (counts[node] == 0) continue;
    missed += (displacement[node] - exact[node]).squaredNorm();
    moved += exact[node].squaredNorm();
  }
  return std::sqrt(missed / moved);
}

// The layered shape against the exact one, each under the same loads.
inline void expectHonest(const LayeredBlock& block, const SolveReport& report,
                         const ElasticBlock& exact, double tolerance, double most = 10.0) {
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_LE(report.error_estimate, tolerance);
  const double error =
      errorOf(block.lattice, block.patches, block.state.displacement, exact.state.displacement);
  EXPECT_GE(report.error_estimate, error / 3.0);
  EXPECT_LE(report.error_estimate, most * error);
}

inline TissueConfig pressBlock(double poisson_ratio) {
  return withFixedBottom(elasticBlockOf(8, 8, 4, poisson_ratio));
}

// A patch on the middle of the top, joined by its rim.
inline LoadingPatch punchOn(const Lattice& lattice, const TissueModel& model,
                            const LatticeState& state, const TissueConfig& config,
                            const Vec3& displacement) {
  const Box box = nodeBox(config, {3, 3, 4}, {5, 5, 4});
  LoadingPatch patch = displaced(lattice.nodesIn(box), displacement);
  patch.rim = rimOf(lattice, model, state, box, patch.nodes);
  for (RimSpring& spring : patch.rim) spring.anchor = displacement;
  return patch;
}

inline LoadingPatch punchByForce(const LayeredBlock& block, const TissueConfig& config,
                                 const Vec3& force, bool turns) {
  LoadingPatch patch = punchOn(block.lattice, block.model, block.state, config, Vec3(Vec3::Zero()));
  patch.drive = LoadingPatch::Drive::kForce;
  patch.displacement.clear();
  patch.force = force;
  patch.turns = turns;
  for (const int node : patch.nodes) {
    patch.center += block.lattice.restPosition(node) / static_cast<double>(patch.nodes.size());
  }
  return patch;
}

}  // namespace robot_tissue
