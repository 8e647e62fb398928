#include "solvers/paper/paper_method.h"

#include <algorithm>
#include <cmath>

namespace robot_tissue {
namespace {

// Of the loading force (1): left on a patch by force, which counts as balance. Less: more moves of
// the patch. Chosen: far below solver.tolerance.
constexpr double kPatchBalance = 1e-6;
// Of a spring's stiffness times its length (1): forces below are rounding, and count as balance.
// Less: patches without a load move for ever. Chosen.
constexpr double kRounding = 1e-13;

std::uint8_t maskOf(const LoadingPatch& patch) {
  std::uint8_t mask = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (holds(patch, axis)) mask = static_cast<std::uint8_t>(mask | 1U << axis);
  }
  return mask;
}

Vec3 keepAxes(const Vec3& vector, std::uint8_t mask) {
  return {(mask & 1) != 0 ? vector.x() : 0.0, (mask & 2) != 0 ? vector.y() : 0.0,
          (mask & 4) != 0 ? vector.z() : 0.0};
}

}  // namespace

PaperMethod::PaperMethod(const Lattice& lattice, const TissueModel& model,
                         const PaperOptions& options)
    : lattice_(lattice),
      model_(model),
      options_(options),
      walk_(lattice),
      locked_(at(lattice.nodeCount()), 0) {
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    if (lattice.isFixed(node)) locked_[at(node)] = kAllAxes;
  }
  for (const Spring spring : lattice.springs()) {
    rounding_force_ =
        std::max(rounding_force_, kRounding * lattice.springStiffness(spring) * lattice.spacing());
  }
}

SolveReport PaperMethod::solve(std::vector<LoadingPatch>& patches,
                               const std::vector<int>& disturbed, LatticeState& state) {
  clock_.start();
  SolveReport report;
  active_.clear();
  lockNodes(patches);
  placeDisplacedPatches(patches, state);
  for (int pass = 0; pass < options_.passes; ++pass) {
    pushForcedPatches(patches, state, report);
    spreadOutwards(patches, disturbed, state, report);
  }
  // The layers gave way, so the springs answer less than the load: the patch follows (own; the
  // paper does so at the start of the next load step).
  pushForcedPatches(patches, state, report);
  describe(patches, state, report);
  unlockNodes(patches);
  report.wall_ms = clock_.elapsedMs();
  return report;
}

double PaperMethod::patchStep() const { return options_.step_in_spacings * lattice_.spacing(); }

// Section 4.3 and figure 4: the loading area is "a single hard surface patch"; its nodes do not
// move by themselves.
void PaperMethod::lockNodes(const std::vector<LoadingPatch>& patches) {
  for (const LoadingPatch& patch : patches) {
    for (const int node : patch.nodes) locked_[at(node)] |= maskOf(patch);
  }
}

void PaperMethod::unlockNodes(const std::vector<LoadingPatch>& patches) {
  for (const LoadingPatch& patch : patches) {
    for (const int node : patch.nodes) locked_[at(node)] = 0;
  }
}

void PaperMethod::placeDisplacedPatches(const std::vector<LoadingPatch>& patches,
                                        LatticeState& state) const {
  for (const LoadingPatch& patch : patches) {
    if (byForce(patch)) continue;
    const AxisMask mask = maskOf(patch);
    for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
      Vec3& displacement = state.displacement[at(patch.nodes[i])];
      displacement += keepAxes(patch.displacement[i] - displacement, mask);
    }
  }
}

// Section 4.3: "the surface patch repositioning is performed until cumulative link force is equal
// to the loading force".
void PaperMethod::pushForcedPatches(const std::vector<LoadingPatch>& patches, LatticeState& state,
                                    SolveReport& report) const {
  // Springs may join two patches: what one moves, the other feels.
  bool moved = true;
  for (int round = 0; moved && round < options_.max_patch_moves; ++round) {
    moved = false;
    for (const LoadingPatch& patch : patches) {
      if (patch.drive != LoadingPatch::Drive::kForce) continue;
      const int moves_before = report.iterations;
      if (!balancePatch(patch, state, report.iterations)) {
        report.status = SolveStatus::kUnconverged;
        return;
      }
      moved = moved || report.iterations != moves_before;
    }
  }
  if (moved) report.status = SolveStatus::kUnconverged;
}

bool PaperMethod::balancePatch(const LoadingPatch& patch, LatticeState& state, int& moves) const {
  // Springs inside the patch keep their length as it moves; only those at its border resist, "the
  // force contribution due to links attached to the patch border".
  Vec3 stiffness = Vec3::Zero();
  for (const int node : patch.nodes) {
    for (int direction = 0; direction < kNeighbors; ++direction) {
      const int spring = lattice_.springOf(node, direction);
      if (spring < 0 || state.severed[at(spring)] != 0) continue;
      if (std::binary_search(patch.nodes.begin(), patch.nodes.end(),
                             lattice_.neighbor(node, direction))) {
        continue;
      }
      stiffness[direction / 2] += lattice_.springStiffness(lattice_.springs()[at(spring)]);
    }
  }
  const double enough = std::max(kPatchBalance * patch.force.norm(), rounding_force_);
  for (int move = 0; move < options_.max_patch_moves; ++move) {
    const Vec3 unanswered = patch.force - patchForce(patch, state);
    if (unanswered.norm() <= enough) return true;
    const Vec3 step = moveTowardsBalance(unanswered, stiffness);
    for (const int node : patch.nodes) state.displacement[at(node)] += step;
    ++moves;
  }
  return false;
}

// Figure 3, with section 4.2: "outward direction for untouched node is done sequentially from
// previously found layer until the effect of acting force is small enough".
void PaperMethod::spreadOutwards(const std::vector<LoadingPatch>& patches,
                                 const std::vector<int>& disturbed, LatticeState& state,
                                 SolveReport& report) {
  reference_force_ = referenceForce(patches, disturbed, state);
  balanced_below_ = std::max(options_.balance_tolerance * reference_force_, rounding_force_);
  std::vector<int> loading_area;
  std::vector<int> sliding;
  for (const LoadingPatch& patch : patches) {
    loading_area.insert(loading_area.end(), patch.nodes.begin(), patch.nodes.end());
    if (maskOf(patch) == kAllAxes) continue;
    sliding.insert(sliding.end(), patch.nodes.begin(), patch.nodes.end());
  }
  walk_.start(loading_area);
  for (const int node : disturbed) {
    if (locked_[at(node)] == 0) walk_.add(node);
  }
  report.layers = 0;
  active_.clear();
  // "Start at layer immediately surrounding the loading area."
  std::vector<int> layer = walk_.next(state);
  // Nodes that slide are balanced with it: the layer around them is disturbed even if they are not.
  layer.insert(layer.end(), sliding.begin(), sliding.end());
  // "If position change disrupts neighboring node balance: raise need to check next layer." The
  // terminating condition is a layer in which no node is disturbed.
  while (!layer.empty() && isDisturbed(layer, state)) {
    ++report.layers;
    if (outOfBudget()) {
      report.status = SolveStatus::kLate;
      return;
    }
    if (!balanceLayer(layer, state, report)) {
      if (report.status == SolveStatus::kOk) report.status = SolveStatus::kUnconverged;
    }
    active_.insert(active_.end(), layer.begin(), layer.end());
    layer = walk_.next(state);
  }
}

// Figure 3: "Until all nodes in current layer reached equilibrium: for every node in current
// layer ..."
bool PaperMethod::balanceLayer(std::vector<int>& layer, LatticeState& state,
                               SolveReport& report) const {
  const auto color = [this](int node) {
    const auto index = lattice_.gridIndex(node);
    return (index[0] + index[1] + index[2]) % 2;
  };
  std::sort(layer.begin(), layer.end(), [&](int left, int right) {
    if (options_.order == PaperOptions::Order::kByIndex) return left < right;
    return std::make_pair(color(left), left) < std::make_pair(color(right), right);
  });
  for (int sweep = 0; sweep < options_.max_sweeps_per_layer; ++sweep) {
    if (!isDisturbed(layer, state)) return true;
    if (outOfBudget()) {
      report.status = SolveStatus::kLate;
      return false;
    }
    ++report.iterations;
    for (const int node : layer) balanceNode(node, state);
  }
  return !isDisturbed(layer, state);
}

// Figure 3: "Until acting force at current node is stabilized: accumulate acting force at current
// node; move node in effective force direction axis."
bool PaperMethod::balanceNode(int node, LatticeState& state) const {
  const Vec3 stiffness = model_.nodeStiffness(state, node);
  Vec3& displacement = state.displacement[at(node)];
  Vec3 force = freeForce(node, state);
  double share = 1.0;  // of the full move; smaller after a move that made things worse
  for (int move = 0; move < options_.max_moves_per_node; ++move) {
    if (force.norm() <= balanced_below_) return true;
    const Vec3 before = displacement;
    displacement +=
        keepAxes(share * moveTowardsBalance(force, stiffness), ~locked_[at(node)] & kAllAxes);
    const Vec3 force_after = freeForce(node, state);
    if (force_after.norm() < force.norm()) {
      force = force_after;
    } else {
      displacement = before;
      share *= 0.5;
    }
  }
  return false;
}

bool PaperMethod::isDisturbed(const std::vector<int>& layer, const LatticeState& state) const {
  return std::any_of(layer.begin(), layer.end(),
                     [&](int node) { return freeForce(node, state).norm() > balanced_below_; });
}

// Net force along the axes that the node may move on.
Vec3 PaperMethod::freeForce(int node, const LatticeState& state) const {
  return keepAxes(model_.nodeForce(state, node), ~locked_[at(node)] & kAllAxes);
}

// Force of the patch on the tissue (N): what its nodes' springs leave unbalanced. Springs inside
// the patch cancel.
Vec3 PaperMethod::patchForce(const LoadingPatch& patch, const LatticeState& state) const {
  Vec3 force = Vec3::Zero();
  for (const int node : patch.nodes) force -= model_.nodeForce(state, node);
  return keepAxes(force, maskOf(patch));
}

// The move that balances the force if the springs' directions stay: force over stiffness, axis by
// axis; no longer than one step (the paper's step size, on which it is silent).
Vec3 PaperMethod::moveTowardsBalance(const Vec3& force, const Vec3& stiffness) const {
  const double stiffest = stiffness.maxCoeff();
  if (stiffest <= 0.0) return Vec3::Zero();
  Vec3 move = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    move[axis] = force[axis] / (stiffness[axis] > 0.0 ? stiffness[axis] : stiffest);
  }
  const double length = move.norm();
  return length > patchStep() ? Vec3(move * (patchStep() / length)) : move;
}

// The greatest force on one node that the loading event brought in: the scale of "balanced".
double PaperMethod::referenceForce(const std::vector<LoadingPatch>& patches,
                                   const std::vector<int>& disturbed,
                                   const LatticeState& state) const {
  double greatest = 0.0;
  for (const LoadingPatch& patch : patches) {
    for (const int node : patch.nodes) {
      greatest = std::max(greatest, model_.nodeForce(state, node).norm());
    }
  }
  for (const int node : disturbed) {
    greatest = std::max(greatest, freeForce(node, state).norm());
  }
  return greatest;
}

void PaperMethod::describe(const std::vector<LoadingPatch>& patches, const LatticeState& state,
                           SolveReport& report) const {
  report.active_nodes = static_cast<int>(active_.size());
  std::vector<Vec3> forces(state.displacement.size(), Vec3::Zero());
  for (const LoadingPatch& patch : patches) {
    for (const int node : patch.nodes) forces[at(node)] = model_.nodeForce(state, node);
    report.patches.push_back(answerOf(lattice_, state, patch, onHardNodes(patch, forces)));
    if (maskOf(patch) == kAllAxes) report.active_nodes += static_cast<int>(patch.nodes.size());
  }
  double greatest_force = 0.0, missing_squared = 0.0, moved_squared = 0.0;
  for (const int node : active_) {
    const Vec3 force = freeForce(node, state);
    greatest_force = std::max(greatest_force, force.norm());
    missing_squared += moveTowardsBalance(force, model_.nodeStiffness(state, node)).squaredNorm();
    moved_squared += state.displacement[at(node)].squaredNorm();
  }
  if (reference_force_ > 0.0) report.residual = greatest_force / reference_force_;
  if (moved_squared > 0.0) report.error_estimate = std::sqrt(missing_squared / moved_squared);
}

bool PaperMethod::outOfBudget() const { return clock_.isOver(options_.max_ms); }

}  // namespace robot_tissue
