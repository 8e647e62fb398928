// Blocks of tissue, patches and checks that the core tests share.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "cutting/blade_surface.h"
#include "material/six_spring_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/loading_patch.h"
#include "solvers/paper/paper_method.h"

namespace robot_tissue {

// A block of so many cells from the origin; 10 kPa, 1000 kg/m^3; floating.
inline TissueConfig blockOf(int cells_x, int cells_y, int cells_z, double spacing = 0.01) {
  TissueConfig config;
  config.model = "six_spring";
  config.shape.max() = Vec3(cells_x, cells_y, cells_z) * spacing;
  config.spacing = spacing;
  config.material.young_modulus = 1e4;
  config.material.density = 1000.0;
  return config;
}

inline SolverConfig paperSolver() {
  SolverConfig solver;
  solver.method = "paper";
  return solver;
}

// Box of the nodes first..last (grid indices).
inline Box nodeBox(const TissueConfig& config, const std::array<int, 3>& first,
                   const std::array<int, 3>& last) {
  Box box;
  box.min() = config.shape.min() + config.spacing * Vec3(first[0], first[1], first[2]);
  box.max() = config.shape.min() + config.spacing * Vec3(last[0], last[1], last[2]);
  return box;
}

inline Box everywhere() {
  constexpr double kFar = std::numeric_limits<double>::max();
  return {Vec3::Constant(-kFar), Vec3::Constant(kFar)};
}

inline TissueConfig withFixedBottom(TissueConfig config) {
  Box bottom = config.shape;
  bottom.max().z() = bottom.min().z();
  config.fixed.push_back(bottom);
  return config;
}

inline std::vector<int> nodesOf(const Lattice& lattice) { return lattice.nodesIn(everywhere()); }

inline std::vector<int> springsOf(const std::vector<Crossing>& crossings) {
  std::vector<int> springs;
  for (const Crossing& crossing : crossings) springs.push_back(crossing.spring);
  return springs;
}

inline LoadingPatch displaced(const std::vector<int>& nodes, const Vec3& displacement) {
  LoadingPatch patch;
  patch.name = "punch";
  patch.nodes = nodes;
  patch.displacement.assign(nodes.size(), displacement);
  return patch;
}

inline LoadingPatch forced(const std::vector<int>& nodes, const Vec3& force) {
  LoadingPatch patch;
  patch.name = "punch";
  patch.nodes = nodes;
  patch.drive = LoadingPatch::Drive::kForce;
  patch.force = force;
  return patch;
}

// A lattice of six springs a node with the paper's method on it.
struct PaperBlock {
  explicit PaperBlock(const TissueConfig& config, const PaperOptions& options = {})
      : lattice(config),
        model(lattice, config.gravity),
        method(lattice, model, options),
        state(lattice.restState()) {}

  SolveReport solve(std::vector<LoadingPatch> patches, const std::vector<int>& disturbed = {}) {
    return method.solve(patches, disturbed, state);
  }

  Lattice lattice;
  SixSpringModel model;
  PaperMethod method;
  LatticeState state;
};

// what() of the InputError that the call throws; empty when it throws none.
template <typename Call>
std::string inputErrorOf(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline bool isOneLine(const std::string& text) {
  return !text.empty() && text.find('\n') == std::string::npos;
}

inline bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace robot_tissue
