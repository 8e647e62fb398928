// LayeredMethod: the sweeps through the layers, and the way they are strung together.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "robot_tissue/core/layered_method.h"

namespace robot_tissue {
namespace {

constexpr double kSoftest = 0.05;     // of a node's stiffest direction: its others count as no less
constexpr double kFlatEnough = 0.25;  // of the slope along a direction: no need to look further
constexpr int kTrials = 8;            // of the length along it
constexpr double kMostTurn = 0.2;     // of a patch in one visit (rad)
constexpr double kProbe = 1e-4;       // motion that measures a patch's stiffness, in spacings

// Without directions that are soft or negative, which cells pressed flat may have.
Eigen::Matrix3d firm(const Eigen::Matrix3d& block) {
  const double area = block(0, 0) * block(1, 1) - block(0, 1) * block(1, 0);
  const double stiffest = block.trace();
  if (block(0, 0) > 0.0 && area > 0.0 &&
      block.determinant() > kSoftest * kSoftest * stiffest * stiffest * stiffest) {
    return block;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(block);
  const double least = kSoftest * solver.eigenvalues().cwiseAbs().maxCoeff();
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(least).asDiagonal() *
         solver.eigenvectors().transpose();
}

Vec3 capped(const Vec3& step, double length) {
  const double norm = step.norm();
  return norm > length ? Vec3(step * (length / norm)) : step;
}

}  // namespace

// Goes on, or back, the way that the last solve went, as far as the forces work along it.
bool LayeredMethod::carryOn(LoadedShape& shape, Motion& forces) const {
  if (last_way_.size() != shape.state.displacement.size()) return false;
  Motion way;
  for (std::size_t node = 0; node < last_way_.size(); ++node) {
    way.nodes.push_back(hold_.freePart(static_cast<int>(node), last_way_[node]));
  }
  way.patches.assign(shape.patches.size(), {});
  double slope = dot(forces, way);
  if (slope < 0.0) {
    for (Vec3& moved : way.nodes) moved = -moved;
    slope = -slope;
  }
  return slope > 0.0 && goAlong(way, slope, shape, forces);
}

// One cycle and a step of conjugate gradients along it (Polak and Ribiere). False when that led
// nowhere; the shape is as before then.
bool LayeredMethod::advance(LoadedShape& shape, Motion& forces, Search& search) const {
  if (search.plain > 0) {
    --search.plain;
    Motion moved;
    sweep(shape, true, moved);
    sweep(shape, false, moved);
    forces = forcesOf(shape);
    return true;
  }
  const Motion step = cycle(shape);
  const double promised = dot(forces, step);
  if (!(promised > 0.0)) return false;
  double share = 0.0;
  if (!search.fresh) share = (promised - dot(search.force, step)) / search.promised;
  if (share > 0.0) {
    add(step, share, search.direction);
  } else {
    search.direction = step;
  }
  double slope = dot(forces, search.direction);
  if (!(slope > 0.0)) {
    search.direction = step;
    slope = promised;
  }
  search.fresh = false;
  search.promised = promised;
  search.force = forces;
  return goAlong(search.direction, slope, shape, forces);
}

// To where the forces no longer work along the direction. `slope`: what they do at its start.
bool LayeredMethod::goAlong(const Motion& direction, double slope, LoadedShape& shape,
                            Motion& forces) const {
  const double cap = options_.line_step * lattice_.spacing() / std::max(longest(direction), 1e-300);
  const LoadedShape start = shape;
  double low = 0.0, low_slope = slope, high = 0.0, high_slope = 0.0;
  bool bracketed = false;
  double share = std::min(1.0, cap);
  for (int trial = 0; trial < kTrials; ++trial) {
    shape = start;
    move(shape, direction, share);
    forces = forcesOf(shape);
    const double here = dot(forces, direction);
    if (std::abs(here) <= kFlatEnough * slope) return true;
    if (here > 0.0 && std::isfinite(here)) {
      if (share >= cap) return true;
      low = share;
      low_slope = here;
    } else {
      high = share;
      high_slope = here;
      bracketed = true;
    }
    if (!bracketed) {
      const double secant = low_slope < slope ? share * slope / (slope - low_slope) : 2.0 * share;
      share = std::min({std::max(secant, 1.1 * share), 4.0 * share, cap});
    } else if (std::isfinite(high_slope)) {
      const double across = low_slope / (low_slope - high_slope);
      share = low + std::min(std::max(across, 0.1), 0.9) * (high - low);
    } else {
      share = 0.5 * (low + high);
    }
  }
  shape = start;
  if (low > 0.0) move(shape, direction, low);
  forces = forcesOf(shape);
  return low > 0.0;
}

// Where a sweep outwards, a smooth motion and a sweep inwards lead.
Motion LayeredMethod::cycle(const LoadedShape& shape) const {
  LoadedShape trial = shape;
  Motion moved;
  moved.patches.assign(shape.patches.size(), {});
  sweep(trial, true, moved);
  Motion smooth = smoothMotion(forcesOf(trial), trial);
  const double furthest = options_.line_step * lattice_.spacing();
  const double share = std::min(1.0, furthest / std::max(longest(smooth), 1e-300));
  move(trial, smooth, share);
  for (std::size_t patch = 0; patch < moved.patches.size(); ++patch) {
    moved.patches[patch].shift += share * smooth.patches[patch].shift;
    moved.patches[patch].turn += share * smooth.patches[patch].turn;
  }
  sweep(trial, false, moved);
  moved.nodes.assign(shape.state.displacement.size(), Vec3::Zero());
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) {
      moved.nodes[at(node)] =
          trial.state.displacement[at(node)] - shape.state.displacement[at(node)];
    }
  }
  return moved;
}

void LayeredMethod::sweep(LoadedShape& shape, bool outwards, Motion& moved) const {
  const auto& layers = layers_.all();
  if (outwards) {
    balancePatches(shape, moved);
    for (const auto& layer : layers) {
      for (const int node : layer) balanceNode(shape, node);
    }
    return;
  }
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
    for (auto node = layer->rbegin(); node != layer->rend(); ++node) balanceNode(shape, *node);
  }
  balancePatches(shape, moved);
}

// One Newton step of the node alone.
void LayeredMethod::balanceNode(LoadedShape& shape, int node) const {
  NodeBalance balance = model_.nodeBalance(shape.state, node);
  hold_.addSprings(shape, node, balance);
  const std::uint8_t held = hold_.held()[at(node)];
  Eigen::Matrix3d block = firm(balance.block);
  for (int axis = 0; held != 0 && axis < 3; ++axis) {
    if ((held >> axis & 1) == 0) continue;
    block.row(axis).setZero();
    block.col(axis).setZero();
    block(axis, axis) = 1.0;
  }
  const Vec3 step = block.inverse() * hold_.freePart(node, balance.force);
  if (!step.allFinite()) return;
  shape.state.displacement[at(node)] += capped(step, options_.node_step * lattice_.spacing());
}

// One Newton step of each patch by force, the nodes around it held.
void LayeredMethod::balancePatches(LoadedShape& shape, Motion& moved) const {
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    LoadingPatch& patch = shape.patches[index];
    if (!byForce(patch)) continue;
    const Motion::OfPatch force = hold_.forceOn(shape, index);
    Motion::OfPatch step;
    Eigen::VectorXd load(patch.turns ? 6 : 3);
    load.head<3>() = force.shift;
    if (patch.turns) load.tail<3>() = force.turn;
    const Eigen::VectorXd answer = answers_[index].ldlt().solve(load);
    if (!answer.allFinite()) continue;
    step.shift = capped(answer.head<3>(), options_.node_step * lattice_.spacing());
    if (patch.turns) step.turn = capped(answer.tail<3>(), kMostTurn);
    movePatch(lattice_, patch, step.shift, step.turn, shape.state);
    if (moved.patches.empty()) continue;
    moved.patches[index].shift += step.shift;
    moved.patches[index].turn += step.turn;
  }
}

// Stiffness of each patch by force against its own motion, by differences.
void LayeredMethod::measurePatches(const LoadedShape& shape) {
  answers_.assign(shape.patches.size(), {});
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    if (!byForce(shape.patches[index])) continue;
    const int size = shape.patches[index].turns ? 6 : 3;
    const Motion::OfPatch here = hold_.forceOn(shape, index);
    Eigen::MatrixXd stiffness(size, size);
    double reach = lattice_.spacing();
    for (const int node : shape.patches[index].nodes) {
      reach = std::max(reach, hold_.armOf(shape, index, node).norm());
    }
    for (int axis = 0; axis < size; ++axis) {
      const double probe = kProbe * lattice_.spacing() / (axis < 3 ? 1.0 : reach);
      const Vec3 unit = probe * Vec3::Unit(axis % 3);
      LoadedShape probed = shape;
      movePatch(lattice_, probed.patches[index], axis < 3 ? unit : Vec3(Vec3::Zero()),
                axis < 3 ? Vec3(Vec3::Zero()) : unit, probed.state);
      const Motion::OfPatch there = hold_.forceOn(probed, index);
      stiffness.col(axis).head<3>() = (here.shift - there.shift) / probe;
      if (size == 6) stiffness.col(axis).tail<3>() = (here.turn - there.turn) / probe;
    }
    answers_[index] = 0.5 * (stiffness + stiffness.transpose());
  }
}

void LayeredMethod::move(LoadedShape& shape, const Motion& motion, double share) const {
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) {
      shape.state.displacement[at(node)] += share * motion.nodes[at(node)];
    }
  }
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    if (!byForce(shape.patches[index])) continue;
    movePatch(lattice_, shape.patches[index], share * motion.patches[index].shift,
              share * motion.patches[index].turn, shape.state);
  }
}

void LayeredMethod::add(const Motion& step, double share, Motion& direction) const {
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) {
      direction.nodes[at(node)] = step.nodes[at(node)] + share * direction.nodes[at(node)];
    }
  }
  for (std::size_t index = 0; index < step.patches.size(); ++index) {
    Motion::OfPatch& of_patch = direction.patches[index];
    of_patch.shift = step.patches[index].shift + share * of_patch.shift;
    of_patch.turn = step.patches[index].turn + share * of_patch.turn;
  }
}

double LayeredMethod::dot(const Motion& left, const Motion& right) const {
  double sum = 0.0;
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) sum += left.nodes[at(node)].dot(right.nodes[at(node)]);
  }
  for (std::size_t index = 0; index < left.patches.size(); ++index) {
    sum += left.patches[index].shift.dot(right.patches[index].shift);
    sum += left.patches[index].turn.dot(right.patches[index].turn);
  }
  return sum;
}

double LayeredMethod::longest(const Motion& motion) const {
  double squared = 0.0;
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) squared = std::max(squared, motion.nodes[at(node)].squaredNorm());
  }
  for (const Motion::OfPatch& patch : motion.patches) {
    squared = std::max(squared, patch.shift.squaredNorm());
    squared =
        std::max(squared, std::pow(lattice_.spacing() / kMostTurn, 2) * patch.turn.squaredNorm());
  }
  return std::sqrt(squared);
}

}  // namespace robot_tissue
