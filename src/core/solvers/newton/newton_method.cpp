#include "solvers/newton/newton_method.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "membrane/membrane.h"
#include "solvers/newton/tuning.h"

namespace robot_tissue {
NewtonMethod::NewtonMethod(const Lattice& lattice, const EnergyModel& model,
                           const NewtonOptions& options)
    : lattice_(lattice), model_(model), options_(options) {
  const LatticeState rest = lattice.restState();
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    stiffness_ += model.nodeStiffness(rest, node).mean() / lattice.nodeCount();
  }
  hold_ = stiffness_;
  if (model.membrane() == nullptr) return;
  // Where cells are much softer than membranes, what holds pieces must not hold back cells.
  for (const int node : model.membrane()->nodes()) {
    hold_ -= model.membrane()->restStiffness(node) / lattice.nodeCount();
  }
}

SolveReport NewtonMethod::solve(std::vector<LoadingPatch>& patches, const std::vector<int>&,
                                LatticeState& state) {
  clock_.start();
  factorized_ = false;
  SolveReport report;
  ConstrainedState shape{state, patches};
  countUnknowns(shape);
  carryPatches(shape);
  takeBalance(balanceOf(model_, unknowns_, shape));
  report.status = iterate(shape, report.iterations);
  describe(shape, report);
  state = std::move(shape.state);
  patches = std::move(shape.patches);
  report.wall_ms = clock_.elapsedMs();
  return report;
}

int NewtonMethod::usualIterations() const { return tuning::kUsualSteps; }

double NewtonMethod::patchStep() const { return options_.patch_step * lattice_.spacing(); }

void NewtonMethod::countUnknowns(const ConstrainedState& shape) {
  DofMap unknowns(lattice_, model_, shape);
  std::vector<int> rims;
  for (const LoadingPatch& patch : shape.patches) {
    for (const RimSpring& spring : patch.rim) rims.push_back(spring.node);
    for (const ContactSpring& spring : patch.contacts) {
      for (const NodeWeight& carrier : spring.carriers) rims.push_back(carrier.node);
    }
    rims.push_back(-1);
  }
  if (analyzed_ && unknowns == unknowns_ && rims == rims_ && shape.state.cells == cells_) return;
  unknowns_ = std::move(unknowns);
  rims_ = std::move(rims);
  cells_ = shape.state.cells;
  analyzed_ = false;
}

// The first guess: patches by displacement go to their places, and the free nodes by one Newton
// step of the shape before, K du = f - K_uh du_h, with du_h the motion of the held components.
// Where that has more energy than the free nodes left where they are, they are left.
void NewtonMethod::carryPatches(ConstrainedState& shape) {
  std::vector<Vec3> moved(shape.state.displacement.size(), Vec3::Zero());
  bool any = false;
  ConstrainedState placed = shape;
  for (const LoadingPatch& patch : shape.patches) {
    if (byForce(patch)) continue;
    any = any || !patch.rim.empty();
    for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
      const std::size_t node = at(patch.nodes[i]);
      for (int axis = 0; axis < 3; ++axis) {
        if (unknowns_.of(patch.nodes[i], axis) != DofMap::kHeld) continue;
        moved[node][axis] = patch.displacement[i][axis] - shape.state.displacement[node][axis];
        placed.state.displacement[node][axis] = patch.displacement[i][axis];
        any = any || moved[node][axis] != 0.0;
      }
    }
  }
  if (!any) return;
  const bool predicted = unknowns_.count() > 0 && factorize(shape, moved);
  if (predicted) {
    const Balance before = balanceOf(model_, unknowns_, shape);
    const Eigen::VectorXd step = solveFor(before.unbalanced - carried_);
    ConstrainedState carried = placed;
    unknowns_.move(carried, step, capped(placed, step));
    if (potentialOf(model_, carried) < potentialOf(model_, placed)) placed = std::move(carried);
  }
  shape = std::move(placed);
}

SolveStatus NewtonMethod::iterate(ConstrainedState& shape, int& iterations) {
  const std::vector<Vec3> unmoved(shape.state.displacement.size(), Vec3::Zero());
  for (iterations = 0; relative_ > options_.residual; ++iterations) {
    if (iterations >= std::min(options_.max_iterations, most_iterations_))
      return SolveStatus::kUnconverged;
    const bool is_over = clock_.isOver(options_.max_ms);
    if (is_over && iterations > 0) return SolveStatus::kLate;
    if (!factorize(shape, unmoved)) return SolveStatus::kUnconverged;
    if (!search(solveFor(balance_.unbalanced), shape)) return SolveStatus::kUnconverged;
  }
  return SolveStatus::kOk;
}

// The second derivative K, if it is positive definite; else the sum of the cells' own, each without
// its negative eigenvalues; else that with more and more on its diagonal. With a positive definite
// matrix any short enough step lowers the energy.
bool NewtonMethod::factorize(const ConstrainedState& shape, const std::vector<Vec3>& moved) {
  factorized_ = true;
  for (const bool convex : {false, true}) {
    TangentStiffness curvature = tangentStiffnessOf(model_, unknowns_, shape, moved, convex);
    matrix_.swap(curvature.matrix);
    carried_ = std::move(curvature.carried);
    diagonal_shift_ = 0.0;
    diagonalShift(tuning::kHold * hold_);
    if (!analyzed_) factor_->analyze(matrix_);
    analyzed_ = true;
    if (factor_->factorize(matrix_)) return true;
  }
  while (diagonal_shift_ < tuning::kFirmestHold * stiffness_) {
    diagonalShift(tuning::kFirmer * diagonal_shift_);
    if (factor_->factorize(matrix_)) return true;
  }
  return false;
}

void NewtonMethod::diagonalShift(double stiffness) {
  for (int unknown = 0; unknown < unknowns_.count(); ++unknown) {
    matrix_.coeffRef(unknown, unknown) += stiffness - diagonal_shift_;
  }
  diagonal_shift_ = stiffness;
}

// Solves K x = f with the factor of K + s, s the diagonal shift: x0 = (K + s)^-1 f, and one step of
// refinement, x = x0 + (K + s)^-1 s x0, which leaves an error of (s / (k + s))^2 for an eigenvalue
// k.
Eigen::VectorXd NewtonMethod::solveFor(const Eigen::VectorXd& force) const {
  const Eigen::VectorXd step = factor_->solve(force);
  return step + diagonal_shift_ * factor_->solve(step);
}

// Backtracking: halves the step until the potential has fallen by a share of what its slope
// foretells (Armijo's condition; Nocedal and Wright 2006, 3.1). False: no such share of it does.
bool NewtonMethod::search(const Eigen::VectorXd& step, ConstrainedState& shape) {
  const double promised = balance_.unbalanced.dot(step);  // decrease a full step begins with (J)
  if (!std::isfinite(promised)) return false;
  double share = capped(shape, step);
  for (int halving = 0; halving < tuning::kHalvings; ++halving, share *= 0.5) {
    ConstrainedState trial = shape;
    unknowns_.move(trial, step, share);
    const Balance balance = balanceOf(model_, unknowns_, trial);
    if (!improves(balance, share * promised)) continue;
    shape = std::move(trial);
    takeBalance(balance);
    return true;
  }
  return false;
}

void NewtonMethod::takeBalance(const Balance& balance) {
  balance_ = balance;
  const double floor = tuning::kRoundingForce * stiffness_ * lattice_.spacing();
  relative_ = balance.unbalanced.norm() / std::max(balance.holding, floor / options_.residual);
}

// Close to the equilibrium the potential changes by less than its rounding error: there the
// unbalanced force decides.
bool NewtonMethod::improves(const Balance& trial, double promised) const {
  if (trial.potential <= balance_.potential - tuning::kShareOfExpected * promised) {
    return std::isfinite(trial.unbalanced.norm());
  }
  const double rounding =
      tuning::kRoundingEnergy * stiffness_ * std::pow(lattice_.spacing(), 2) * lattice_.nodeCount();
  return trial.potential <= balance_.potential + rounding &&
         trial.unbalanced.norm() < balance_.unbalanced.norm();
}

// Share of the step in which no node moves farther than options_.node_step spacings.
double NewtonMethod::capped(const ConstrainedState& shape, const Eigen::VectorXd& step) const {
  ConstrainedState moved = shape;
  unknowns_.move(moved, step, 1.0);
  double longest = 0.0;
  for (std::size_t node = 0; node < moved.state.displacement.size(); ++node) {
    const Vec3 motion = moved.state.displacement[node] - shape.state.displacement[node];
    longest = std::max(longest, motion.norm());
  }
  const double allowed = options_.node_step * lattice_.spacing();
  return longest > allowed ? allowed / longest : 1.0;
}

void NewtonMethod::describe(const ConstrainedState& shape, SolveReport& report) {
  report.residual = relative_;
  const std::vector<Vec3>& displacement = shape.state.displacement;
  std::vector<Vec3> forces = model_.nodeForces(shape.state);
  for (const LoadingPatch& patch : shape.patches) addContactForces(patch, displacement, forces);
  for (const LoadingPatch& patch : shape.patches) {
    report.patches.push_back(answerOf(lattice_, shape.state, patch, onHardNodes(patch, forces)));
  }
  double moved_squared = 0.0;
  for (int node = 0; node < static_cast<int>(displacement.size()); ++node) {
    moved_squared += displacement[at(node)].squaredNorm();
    bool solved = false;
    for (int axis = 0; axis < 3; ++axis) {
      solved = solved || unknowns_.of(node, axis) != DofMap::kHeld;
    }
    if (solved) ++report.active_nodes;
  }
  if (moved_squared == 0.0 || balance_.unbalanced.isZero(0.0)) return;
  if (!factorized_ && !factorize(shape, std::vector<Vec3>(displacement.size(), Vec3::Zero()))) {
    report.status = SolveStatus::kUnconverged;
    return;
  }
  ConstrainedState balanced = shape;
  unknowns_.move(balanced, solveFor(balance_.unbalanced), 1.0);
  double squared = 0.0;
  for (std::size_t node = 0; node < displacement.size(); ++node) {
    squared += (balanced.state.displacement[node] - displacement[node]).squaredNorm();
  }
  report.error_estimate = std::sqrt(squared / moved_squared);
}

}  // namespace robot_tissue
