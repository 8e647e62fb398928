#include "robot_tissue/core/newton_method.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace robot_tissue {
namespace {

// Added to the matrix's diagonal, in mean stiffnesses of a node: keeps pieces that nothing holds
// from drifting with rounding errors. More where the matrix is not positive definite with it.
constexpr double kHold = 1e-7;
constexpr double kFirmestHold = 1e-2;
constexpr double kFirmer = 100.0;

constexpr double kRoundingForce = 1e-12;   // of a node's stiffness times the spacing
constexpr double kRoundingEnergy = 1e-15;  // of the stiffness times the spacing squared, a node
constexpr double kShareOfExpected = 1e-4;  // of the decrease that the slope promises
constexpr int kHalvings = 30;

// The nearest matrix without a negative eigenvalue.
CellHessian positivePart(const CellHessian& hessian) {
  const Eigen::SelfAdjointEigenSolver<CellHessian> solver(hessian);
  if (solver.eigenvalues().minCoeff() >= 0.0) return hessian;
  const auto values = solver.eigenvalues().cwiseMax(0.0);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

NewtonMethod::NewtonMethod(const Lattice& lattice, const EnergyModel& model,
                           const NewtonOptions& options)
    : lattice_(lattice), model_(model), options_(options) {
  const LatticeState rest = lattice.restState();
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    stiffness_ += model.nodeStiffness(rest, node).mean() / lattice.nodeCount();
  }
}

SolveReport NewtonMethod::solve(const std::vector<LoadingPatch>& patches, const std::vector<int>&,
                                LatticeState& state) {
  started_ = std::chrono::steady_clock::now();
  factorized_ = false;
  SolveReport report;
  countUnknowns(patches, state);
  carryPatches(patches, state);
  balance_ = balanceOf(patches, state);
  report.status = iterate(patches, state, report.iterations);
  describe(patches, state, report);
  report.wall_ms = elapsedMs();
  return report;
}

double NewtonMethod::patchStep() const { return options_.patch_step * lattice_.spacing(); }

void NewtonMethod::countUnknowns(const std::vector<LoadingPatch>& patches,
                                 const LatticeState& state) {
  Unknowns unknowns(lattice_, model_, patches, state);
  if (analyzed_ && unknowns == unknowns_ && state.springs_cut == springs_cut_) return;
  unknowns_ = std::move(unknowns);
  springs_cut_ = state.springs_cut;
  analyzed_ = false;
}

// Moves the patches by displacement to their places, and the nodes around them with them, as far
// as the second derivative can tell; if that is worse than leaving the others behind, does so.
void NewtonMethod::carryPatches(const std::vector<LoadingPatch>& patches, LatticeState& state) {
  std::vector<Vec3> moved(state.displacement.size(), Vec3::Zero());
  bool any = false;
  for (const LoadingPatch& patch : patches) {
    if (patch.drive != LoadingPatch::Drive::kDisplacement) continue;
    for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
      const std::size_t node = at(patch.nodes[i]);
      for (int axis = 0; axis < 3; ++axis) {
        if (!holds(patch, at(axis))) continue;
        moved[node][axis] = patch.displacement[i][axis] - state.displacement[node][axis];
        any = any || moved[node][axis] != 0.0;
      }
    }
  }
  if (!any) return;
  const bool predicted = unknowns_.count() > 0 && factorize(state, moved);
  const Balance before = balanceOf(patches, state);
  for (const LoadingPatch& patch : patches) {
    if (patch.drive != LoadingPatch::Drive::kDisplacement) continue;
    for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!holds(patch, at(axis))) continue;
        state.displacement[at(patch.nodes[i])][axis] = patch.displacement[i][axis];
      }
    }
  }
  if (!predicted) return;
  const Eigen::VectorXd step = solveFor(before.unbalanced - carried_);
  LatticeState carried = state;
  unknowns_.addTo(carried.displacement, step, capped(step));
  if (potentialOf(patches, carried) < potentialOf(patches, state)) state = carried;
}

SolveStatus NewtonMethod::iterate(const std::vector<LoadingPatch>& patches, LatticeState& state,
                                  int& iterations) {
  const std::vector<Vec3> unmoved(state.displacement.size(), Vec3::Zero());
  for (iterations = 0; balance_.relative > options_.residual; ++iterations) {
    if (iterations == options_.max_iterations) return SolveStatus::kUnconverged;
    if (options_.max_ms > 0.0 && elapsedMs() > options_.max_ms) return SolveStatus::kLate;
    if (!factorize(state, unmoved)) return SolveStatus::kUnconverged;
    if (!search(patches, solveFor(balance_.unbalanced), state)) {
      return SolveStatus::kUnconverged;
    }
  }
  return SolveStatus::kOk;
}

// The second derivative, if it is positive definite; else that of each cell without its negative
// curvatures, which makes any step lower the energy.
bool NewtonMethod::factorize(const LatticeState& state, const std::vector<Vec3>& moved) {
  factorized_ = true;
  for (const bool positive : {false, true}) {
    assemble(state, moved, positive);
    if (!analyzed_) factor_.analyze(matrix_);
    analyzed_ = true;
    if (factor_.factorize(matrix_)) return true;
  }
  while (hold_ < kFirmestHold * stiffness_) {
    for (int unknown = 0; unknown < unknowns_.count(); ++unknown) {
      matrix_.coeffRef(unknown, unknown) += (kFirmer - 1.0) * hold_;
    }
    hold_ *= kFirmer;
    if (factor_.factorize(matrix_)) return true;
  }
  return false;
}

// One step of refinement takes most of what the hold holds back.
Eigen::VectorXd NewtonMethod::solveFor(const Eigen::VectorXd& force) const {
  const Eigen::VectorXd step = factor_.solve(force);
  return step + hold_ * factor_.solve(step);
}

void NewtonMethod::assemble(const LatticeState& state, const std::vector<Vec3>& moved,
                            bool positive) {
  std::vector<Eigen::Triplet<double>> entries;
  carried_ = Eigen::VectorXd::Zero(unknowns_.count());
  model_.visitHessians(state, [&](const auto& corners, const CellHessian& exact) {
    const CellHessian hessian = positive ? positivePart(exact) : exact;
    std::array<int, 3 * kCorners> unknown;
    Eigen::Matrix<double, 3 * kCorners, 1> motion;
    for (int i = 0; i < 3 * kCorners; ++i) {
      unknown[at(i)] = unknowns_.of(corners[at(i / 3)], i % 3);
      motion[i] = moved[at(corners[at(i / 3)])][i % 3];
    }
    const Eigen::Matrix<double, 3 * kCorners, 1> force = hessian * motion;
    for (int i = 0; i < 3 * kCorners; ++i) {
      const int row = unknown[at(i)];
      if (row == Unknowns::kHeld) continue;
      carried_[row] += force[i];
      for (int j = 0; j < 3 * kCorners; ++j) {
        const int column = unknown[at(j)];
        if (column == Unknowns::kHeld || column > row) continue;
        entries.emplace_back(row, column, hessian(i, j));
      }
    }
  });
  hold_ = kHold * stiffness_;
  for (int unknown = 0; unknown < unknowns_.count(); ++unknown) {
    entries.emplace_back(unknown, unknown, hold_);
  }
  matrix_.resize(unknowns_.count(), unknowns_.count());
  matrix_.setFromTriplets(entries.begin(), entries.end());
}

// Goes along the step as far as the potential falls.
bool NewtonMethod::search(const std::vector<LoadingPatch>& patches, const Eigen::VectorXd& step,
                          LatticeState& state) {
  const double promised = balance_.unbalanced.dot(step);  // decrease a full step begins with (J)
  if (!std::isfinite(promised)) return false;
  LatticeState trial = state;
  double share = capped(step);
  for (int halving = 0; halving < kHalvings; ++halving, share *= 0.5) {
    trial.displacement = state.displacement;
    unknowns_.addTo(trial.displacement, step, share);
    const Balance balance = balanceOf(patches, trial);
    if (!improves(balance, share * promised)) continue;
    state.displacement = trial.displacement;
    balance_ = balance;
    return true;
  }
  return false;
}

// Close to the equilibrium the potential changes by less than its rounding error: there the
// unbalanced force decides.
bool NewtonMethod::improves(const Balance& trial, double promised) const {
  if (trial.potential <= balance_.potential - kShareOfExpected * promised) {
    return std::isfinite(trial.relative);
  }
  const double rounding =
      kRoundingEnergy * stiffness_ * std::pow(lattice_.spacing(), 2) * lattice_.nodeCount();
  return trial.potential <= balance_.potential + rounding &&
         trial.unbalanced.norm() < balance_.unbalanced.norm();
}

double NewtonMethod::potentialOf(const std::vector<LoadingPatch>& patches,
                                 const LatticeState& state) const {
  double potential = model_.energy(state);
  for (const LoadingPatch& patch : patches) {
    if (patch.drive != LoadingPatch::Drive::kForce) continue;
    potential -= patch.force.dot(meanDisplacement(patch, state.displacement));
  }
  return potential;
}

NewtonMethod::Balance NewtonMethod::balanceOf(const std::vector<LoadingPatch>& patches,
                                              const LatticeState& state) const {
  Balance balance;
  balance.potential = potentialOf(patches, state);
  std::vector<Vec3> forces = model_.nodeForces(state);
  double holding = unknowns_.heldNorm(forces);
  for (const LoadingPatch& patch : patches) {
    if (patch.drive != LoadingPatch::Drive::kForce) continue;
    forces[at(patch.nodes.front())] += patch.force;
    holding = std::max(holding, patch.force.norm());
  }
  balance.unbalanced = unknowns_.gather(forces);
  const double floor = kRoundingForce * stiffness_ * lattice_.spacing();
  balance.relative = balance.unbalanced.norm() / std::max(holding, floor / options_.residual);
  return balance;
}

// Share of the step in which no node moves further than allowed.
double NewtonMethod::capped(const Eigen::VectorXd& step) const {
  std::vector<Vec3> motion(at(lattice_.nodeCount()), Vec3::Zero());
  unknowns_.addTo(motion, step, 1.0);
  double longest = 0.0;
  for (const Vec3& move : motion) longest = std::max(longest, move.norm());
  const double allowed = options_.node_step * lattice_.spacing();
  return longest > allowed ? allowed / longest : 1.0;
}

void NewtonMethod::describe(const std::vector<LoadingPatch>& patches, const LatticeState& state,
                            SolveReport& report) {
  report.residual = balance_.relative;
  const std::vector<Vec3> forces = model_.nodeForces(state);
  for (const LoadingPatch& patch : patches) {
    PatchAnswer answer;
    answer.displacement = meanDisplacement(patch, state.displacement);
    for (const int node : patch.nodes) {
      for (int axis = 0; axis < 3; ++axis) {
        if (holds(patch, at(axis))) answer.force[axis] -= forces[at(node)][axis];
      }
    }
    report.patches.push_back(answer);
  }
  double moved = 0.0;
  for (int node = 0; node < lattice_.nodeCount(); ++node) {
    moved += state.displacement[at(node)].squaredNorm();
    bool solved = false;
    for (int axis = 0; axis < 3; ++axis) solved = solved || unknowns_.of(node, axis) >= 0;
    if (solved) ++report.active_nodes;
  }
  if (moved == 0.0 || balance_.unbalanced.isZero(0.0)) return;
  if (!factorized_ &&
      !factorize(state, std::vector<Vec3>(state.displacement.size(), Vec3::Zero()))) {
    report.status = SolveStatus::kUnconverged;
    return;
  }
  std::vector<Vec3> missing(state.displacement.size(), Vec3::Zero());
  unknowns_.addTo(missing, solveFor(balance_.unbalanced), 1.0);
  double squared = 0.0;
  for (const Vec3& move : missing) squared += move.squaredNorm();
  report.error_estimate = std::sqrt(squared / moved);
}

double NewtonMethod::elapsedMs() const {
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - started_;
  return elapsed.count();
}

}  // namespace robot_tissue
