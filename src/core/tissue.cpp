#include "robot_tissue/core/tissue.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/cut.h"
#include "robot_tissue/core/mesh_surface.h"
#include "robot_tissue/core/registry.h"
#include "robot_tissue/core/split_cells.h"

namespace robot_tissue {
namespace {

constexpr double kToolStep = 0.2;  // of the spacing

}  // namespace

Tissue::Tissue(const TissueConfig& tissue, const SolverConfig& solver)
    : lattice_(tissue),
      state_(lattice_.restState()),
      model_(makeModel(tissue, lattice_)),
      method_(makeMethod(solver, lattice_, *model_)),
      has_gravity_(!tissue.gravity.isZero()) {
  if (tissue.mesh) mesh_ = refined(*tissue.mesh, tissue.spacing);
  rebuildSurface();
}

Tissue::~Tissue() = default;

Vec3 Tissue::nodeForce(int node) const { return model_->nodeForce(state_, node); }

// Contacts are found anew after each step: what a tool meets on the way must not be far.
double Tissue::stepLength() const {
  return std::min(method_->patchStep(), kToolStep * lattice_.spacing());
}

SolveReport Tissue::settle() { return solve(freeNodes()); }

SolveReport Tissue::follow(std::vector<LoadingPatch> tool_patches,
                           const std::vector<int>& disturbed) {
  const auto first_tool = patches_.begin() + static_cast<std::ptrdiff_t>(named_patches_);
  const bool one_left = std::any_of(first_tool, patches_.end(), [&](const LoadingPatch& earlier) {
    return std::none_of(tool_patches.begin(), tool_patches.end(),
                        [&](const LoadingPatch& now) { return now.name == earlier.name; });
  });
  patches_.erase(first_tool, patches_.end());
  std::move(tool_patches.begin(), tool_patches.end(), std::back_inserter(patches_));
  return one_left ? solveFromRest() : solve(disturbed);
}

void Tissue::restore(const Shape& shape) {
  state_.displacement = carriedOver(*shape.cells, shape.displacement, *state_.cells);
  patches_ = shape.patches;
  named_patches_ = shape.named_patches;
  last_report_ = shape.report;
  deform(surface_, shownDisplacement(), vertices_);
}

CutReport Tissue::cut(const std::vector<Vec3>& corners) {
  const std::vector<int> crossing = springsAcross(lattice_, state_, corners);
  CutReport report;
  report.springs_cut = static_cast<int>(crossing.size());
  report.pieces = state_.pieces;
  report.solve = last_report_;
  if (crossing.empty()) return report;
  std::vector<int> disturbed;
  for (const int spring : crossing) {
    disturbed.push_back(lattice_.springs()[at(spring)].a);
    disturbed.push_back(lattice_.springs()[at(spring)].b);
  }
  sever(lattice_, crossing, state_, model_->splitCells());
  rebuildSurface();
  report.pieces = state_.pieces;
  report.solve = solve(disturbed);
  return report;
}

void Tissue::reset() {
  const bool was_cut = state_.springs_cut > 0;
  method_->forget();
  state_ = lattice_.restState();
  patches_.clear();
  named_patches_ = 0;
  last_report_ = SolveReport();
  if (was_cut) rebuildSurface();
  vertices_ = surface_.rest;
}

Vec3 Tissue::nodePosition(int node) const {
  return restPosition(lattice_, *state_.cells, node) + state_.displacement[at(node)];
}

std::vector<Vec3> Tissue::shownDisplacement() const {
  std::vector<Vec3> shown = state_.displacement;
  for (const LoadingPatch& patch : patches_) {
    if (patch.rim.empty()) continue;
    const std::vector<Vec3> own = ownDisplacement(patch, state_.displacement);
    for (std::size_t i = 0; i < own.size(); ++i) shown[at(patch.nodes[i])] = own[i];
  }
  return shown;
}

SolveReport Tissue::solve(const std::vector<int>& disturbed) {
  const std::vector<Vec3> last_good = state_.displacement;
  const std::vector<LoadingPatch> last_good_patches = patches_;
  SolveReport report = method_->solve(patches_, disturbed, state_);
  if (!hasOnlyFiniteNumbers(report)) {
    state_.displacement = last_good;
    patches_ = last_good_patches;
    report = SolveReport();
    report.status = SolveStatus::kUnconverged;
    report.patches.resize(patches_.size());
  }
  describeShape(report);
  last_report_ = report;
  return report;
}

// Without a load the rest shape is the equilibrium that every path ends in. The six-spring lattice
// holds sheared shapes without a force, so relaxing back from a deformed shape would not find it.
SolveReport Tissue::solveFromRest() {
  const std::vector<LoadingPatch> standing = patches_;
  method_->forget();
  std::fill(state_.displacement.begin(), state_.displacement.end(), Vec3::Zero());
  SolveReport report;
  if (has_gravity_) {
    std::vector<LoadingPatch> none;
    patches_.swap(none);
    report = settle();
    patches_.swap(none);
  }
  std::vector<Ramp> ramps;
  for (std::size_t patch = 0; patch < standing.size(); ++patch) {
    ramps.push_back(makeRamp(standing[patch], nullptr));
    ramps.back().patch = patch;
    ramps.back().start.force.setZero();
    patches_[patch] = ramps.back().start;
  }
  if (!ramps.empty()) {
    report = climb(ramps, chooseIncrements(ramps), {});
  } else if (!has_gravity_) {
    describeShape(report);
    last_report_ = report;
  }
  return report;
}

bool Tissue::hasOnlyFiniteNumbers(const SolveReport& report) const {
  const auto finite = [](const Vec3& vector) { return vector.allFinite(); };
  return std::isfinite(report.residual) && std::isfinite(report.error_estimate) &&
         std::all_of(report.patches.begin(), report.patches.end(),
                     [&](const PatchAnswer& patch) {
                       return finite(patch.force) && finite(patch.displacement);
                     }) &&
         std::all_of(state_.displacement.begin(), state_.displacement.end(), finite);
}

void Tissue::describeShape(SolveReport& report) {
  deform(surface_, shownDisplacement(), vertices_);
  report.volume_ratio = enclosedVolume(surface_, vertices_) / rest_volume_;
  report.inverted_cells = countInvertedCells(lattice_, state_);
  if (report.inverted_cells > 0) report.status = SolveStatus::kInverted;
}

void Tissue::rebuildSurface() {
  surface_ = mesh_.triangles.empty() ? extractSurface(lattice_, state_)
                                     : meshSurface(lattice_, state_, mesh_);
  ++surface_version_;
  rest_volume_ = enclosedVolume(surface_, surface_.rest);
  vertices_ = surface_.rest;
}

std::vector<int> Tissue::freeNodes() const {
  std::vector<int> nodes;
  for (int node = 0; node < lattice_.nodeCount(); ++node) {
    if (!lattice_.isFixed(node)) nodes.push_back(node);
  }
  return nodes;
}

}  // namespace robot_tissue
