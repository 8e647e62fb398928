#include "solvers/baselines/vbd_method.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>

#include "solvers/baselines/node_step.h"
#include "solvers/baselines/soa_field.h"
#include "solvers/baselines/tuning.h"

namespace robot_tissue {
namespace {

constexpr int kLast = kOfMethod, kBefore = kOfMethod + 1;  // spare arrays of the field
// A sweep's complex eigenvalue that Chebyshev's method with a great radius damps least. By Fourier
// analysis of an endless lattice at rest (doc/baselines.md) for Poisson's ratios 0.25, 0.35 and
// 0.45; a line through these.
std::complex<double> turning(double poisson_ratio) {
  return {0.23 + 2.35 * (poisson_ratio - 0.25), 0.37 - 0.4 * (poisson_ratio - 0.25)};
}

// The share of an eigenvalue's part that a step of Chebyshev's method for real eigenvalues up to
// `radius` leaves after many steps: max |l +- sqrt(l^2 - r^2)| / (1 + sqrt(1 - r^2)).
double leftBy(double radius, const std::complex<double>& eigenvalue) {
  const std::complex<double> root = std::sqrt(eigenvalue * eigenvalue - radius * radius);
  return std::max(std::abs(eigenvalue + root), std::abs(eigenvalue - root)) /
         (1.0 + std::sqrt(1.0 - radius * radius));
}

// The radius for which as much is left of the slowest wave as of the complex eigenvalue, by
// bisection: with a smaller one the first dies out more slowly, with a greater one the second.
double bestRadius(double slowest, const std::complex<double>& turns) {
  double low = 0.0, high = slowest;
  for (int halving = 0; halving < 30; ++halving) {
    const double radius = 0.5 * (low + high);
    (leftBy(radius, slowest) > leftBy(radius, turns) ? low : high) = radius;
  }
  return low;
}

}  // namespace

VbdMethod::VbdMethod(const Lattice& lattice, const ElasticModel& model, const VbdOptions& options)
    : RelaxationMethod(lattice, model, options), vbd_(options) {}

void VbdMethod::begin(int care) {
  const double slack = tuning::kSlack + tuning::kSlackOfRatio * (poissonRatio() - 0.25);
  relaxation_ = 1.0;
  if (vbd_.acceleration == Acceleration::kOverRelaxed) {
    relaxation_ = std::max(1.0, 2.0 / (1.0 + std::ldexp(slack, care) / depth()));
  }
  radius_ = std::ldexp(
      tuning::kOfBest * bestRadius(1.0 - 2.0 * slowestWave(), turning(poissonRatio())), -care);
  sweeps_ = 0;
  patch_moves_.assign(shape_.patches.size(), {});
  if (vbd_.acceleration != Acceleration::kChebyshev) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* now = field_->moved()[axis];
    std::copy(now, now + field_->size(), field_->spare(kLast)[axis]);
    std::copy(now, now + field_->size(), field_->spare(kBefore)[axis]);
  }
}

void VbdMethod::iterate() {
  sweep();
  ++sweeps_;
  if (vbd_.acceleration != Acceleration::kChebyshev) return;
  const double squared = radius_ * radius_;
  weight_ = sweeps_ == 1   ? 1.0
            : sweeps_ == 2 ? 2.0 / (2.0 - squared)
                           : 4.0 / (4.0 - squared * weight_);
  extrapolate();
}

int VbdMethod::usualIterations() const { return tuning::kUsualOfVbd; }

// Gauss-Seidel damps a slow wave of eigenvalue w of D^-1 K by the factor 1 - 2 w a sweep,
// over-relaxed by r by 1 - 2 w r / (2 - r); at least one half is taken to be left.
double VbdMethod::shrinkage() const {
  const double plain = 1.0 - std::min(2.0 * slowestWave(), 0.5);
  if (vbd_.acceleration == Acceleration::kChebyshev) return leftBy(radius_, plain);
  return 1.0 - std::min(2.0 * slowestWave() * relaxation_ / (2.0 - relaxation_), 0.5);
}

void VbdMethod::sweep() {
  patch_steps_.assign(shape_.patches.size(), {});
  field_->giveWatched(shape_.state);
  for (std::size_t index = 0; index < shape_.patches.size(); ++index) {
    if (!byForce(shape_.patches[index])) continue;
    patch_forces_[index] = hold_.forceOn(shape_, index);
    patch_steps_[index] = patchAnswer(index);
    patch_steps_[index].shift *= relaxation_;
    patch_steps_[index].turn *= relaxation_;
    movePatchBy(index, patch_steps_[index]);
  }
  field_->relax(static_cast<float>(relaxation_),
                static_cast<float>(vbd_.node_step * lattice_.spacing() / field_->unit()));
  if (field_->oddNodes().empty()) return;
  field_->giveWatched(shape_.state);
  for (const int node : field_->oddNodes()) relaxNode(node);
  field_->take(shape_.state, field_->oddNodes());
}

// One Newton step of the node alone.
void VbdMethod::relaxNode(int node) {
  NodeBalance balance = model_.nodeBalance(shape_.state, node);
  hold_.addSprings(shape_, node, balance);
  const std::uint8_t held = hold_.dirichletMask()[at(node)];
  Eigen::Matrix3d block = firm(balance.block);
  for (int axis = 0; held != 0 && axis < 3; ++axis) {
    if ((held >> axis & 1) == 0) continue;
    block.row(axis).setZero();
    block.col(axis).setZero();
    block(axis, axis) = 1.0;
  }
  const bool smooth = !std::binary_search(hold_.touched().begin(), hold_.touched().end(), node);
  const Vec3 step =
      (smooth ? relaxation_ : 1.0) * block.inverse() * hold_.freePart(node, balance.force);
  if (!step.allFinite()) return;
  shape_.state.displacement[at(node)] += capped(step, vbd_.node_step * lattice_.spacing());
}

// Patches by force go the same way, but as a whole.
void VbdMethod::extrapolate() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    robot_tissue::extrapolate(static_cast<float>(weight_), field_->size(), field_->moved()[axis],
                              field_->spare(kLast)[axis], field_->spare(kBefore)[axis]);
  }
  for (std::size_t index = 0; index < shape_.patches.size(); ++index) {
    if (!byForce(shape_.patches[index])) continue;
    Motion::OfPatch further;
    further.shift = (weight_ - 1.0) * (patch_steps_[index].shift + patch_moves_[index].shift);
    further.turn = (weight_ - 1.0) * (patch_steps_[index].turn + patch_moves_[index].turn);
    movePatchBy(index, further);
    patch_moves_[index].shift = patch_steps_[index].shift + further.shift;
    patch_moves_[index].turn = patch_steps_[index].turn + further.turn;
  }
}

}  // namespace robot_tissue
