#include "robot_tissue/core/layered_method.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace robot_tissue {
namespace {

constexpr double kRounding = 1e-13;  // of a node's stiffness times the spacing
constexpr double kSoftest = 0.05;    // of a node's stiffest direction: its others count as no less
constexpr double kFlatEnough = 0.25;  // of the slope along a direction: no need to look further
constexpr double kMostLeft = 0.9;   // of the length left before a cycle, to learn from it
constexpr double kMostFactor = 4.0;
constexpr double kRemembered = 0.9;  // of the factor, from cycle to cycle
constexpr std::size_t kLongestPast = 8;  // cycles
constexpr double kStill = 1e-6;    // of the spacing, a node: a shape that is off rest by less is at rest
constexpr int kTrials = 8;
constexpr int kPlainCycles = 8;
constexpr double kBlownUp = 100.0;  // times the unbalanced force that a solve begins with
constexpr double kMostTurn = 0.2;    // of a patch in one visit (rad)
constexpr double kProbe = 1e-4;     // motion that measures a patch's stiffness, in spacings

bool byForce(const LoadingPatch& patch) { return patch.drive == LoadingPatch::Drive::kForce; }

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

LayeredMethod::LayeredMethod(const Lattice& lattice, const EnergyModel& model,
                             const LayeredOptions& options)
    : lattice_(lattice),
      model_(model),
      options_(options),
      hold_(lattice, model),
      coarse_(lattice, model) {}

double LayeredMethod::patchStep() const { return options_.patch_step * lattice_.spacing(); }

SolveReport LayeredMethod::solve(std::vector<LoadingPatch>& patches,
                                 const std::vector<int>& disturbed, LatticeState& state) {
  started_ = std::chrono::steady_clock::now();
  SolveReport report;
  LoadedShape shape{state, patches};
  hold_.bind(shape);
  findDisturbed(shape, disturbed);
  const std::vector<Vec3> start = shape.state.displacement;
  hold_.place(shape);
  goes_on_ = !past_.empty() && shape.state.cells == left_cells_ && shape.state.displacement == left_;
  layOut(shape);
  report.status = iterate(shape, report);
  state = std::move(shape.state);
  patches = std::move(shape.patches);
  rememberWay(start, state.displacement);
  left_ = state.displacement;
  left_cells_ = state.cells;
  report.wall_ms = elapsedMs();
  return report;
}

// Pending are nodes that the last solve left so, and all that something has happened to since.
void LayeredMethod::findDisturbed(const LoadedShape& shape, const std::vector<int>& disturbed) {
  const LatticeState& state = shape.state;
  const CellSet& cells = *state.cells;
  std::vector<std::uint8_t> pending(state.displacement.size(), 0);
  if (left_cells_ != state.cells) {
    stiffness_.clear();
    for (int node = 0; node < cells.nodeCount(); ++node) {
      stiffness_.push_back(model_.nodeStiffness(state, node).mean());
    }
    const std::vector<Vec3> forces = model_.nodeForces(state);
    for (std::size_t node = 0; node < forces.size(); ++node) {
      const double rounding = kRounding * stiffness_[node] * lattice_.spacing();
      if (forces[node].norm() > rounding) pending[node] = 1;
    }
  } else {
    for (const int node : pending_) pending[at(node)] = 1;
    for (std::size_t node = 0; node < pending.size(); ++node) {
      if (state.displacement[node] == left_[node]) continue;
      for (auto met = cells.first(static_cast<int>(node));
           met != cells.last(static_cast<int>(node)); ++met) {
        for (const int other : cells.all()[at(met->cell)].nodes) pending[at(other)] = 1;
      }
    }
  }
  for (const int node : disturbed) pending[at(node)] = 1;
  for (const int node : patch_nodes_) pending[at(node)] = 1;
  pending_.clear();
  for (std::size_t node = 0; node < pending.size(); ++node) {
    if (pending[node] != 0 && hold_.held()[node] != kAllHeld) {
      pending_.push_back(static_cast<int>(node));
    }
  }
}

// The layer around the patches, then layers as far as nodes are pending.
void LayeredMethod::layOut(const LoadedShape& shape) {
  std::vector<int> seeds, first;
  patch_nodes_.clear();
  for (std::size_t patch = 0; patch < shape.patches.size(); ++patch) {
    const std::vector<int>& hard = hold_.hardOf(patch);
    seeds.insert(seeds.end(), hard.begin(), hard.end());
    first.insert(first.end(), hard.begin(), hard.end());  // those that slide
    for (const RimSpring& spring : shape.patches[patch].rim) first.push_back(spring.node);
  }
  patch_nodes_ = first;
  if (seeds.empty() && first.empty()) first = pending_;
  layers_.start(shape.state.cells, hold_.held(), seeds, first);
  std::vector<std::uint8_t> pending(hold_.held().size(), 0);
  for (const int node : pending_) pending[at(node)] = 1;
  while (true) {
    std::vector<int> layer;
    for (const int node : layers_.next()) {
      if (pending[at(node)] != 0) layer.push_back(node);
    }
    if (layer.empty()) break;
    layers_.raise(layer);
  }
  std::vector<int> apart;
  for (const int node : pending_) {
    if (!layers_.has(node)) apart.push_back(node);
  }
  if (!apart.empty()) layers_.raise(apart);
}

// Whether a layer was raised: the smooth motion (m) of its nodes is more than a share of the
// tolerance. `length`: of the displacement, L2 (m).
bool LayeredMethod::raiseLayers(const Motion& smooth, double length) {
  const auto isStill = [&](int node) {
    const double mean = length / std::sqrt(layers_.nodeCount() + 1.0);
    return smooth.nodes[at(node)].norm() <= options_.layer_share * options_.tolerance * mean;
  };
  bool raised = false;
  while (!std::all_of(layers_.next().begin(), layers_.next().end(), isStill)) {
    layers_.raise();
    raised = true;
  }
  return raised;
}

// Of what may move: nodes in layers, patches by force. Others have zero.
Motion LayeredMethod::forcesOf(const LoadedShape& shape) const {
  std::vector<Vec3> raw(shape.state.displacement.size(), Vec3::Zero());
  model_.addForces(shape.state, layers_.cells(), raw);
  Motion forces;
  forces.nodes.assign(raw.size(), Vec3::Zero());
  forces.patches.assign(shape.patches.size(), {});
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) {
      NodeBalance balance;
      balance.force = raw[at(node)];
      hold_.addRims(shape, node, balance);
      forces.nodes[at(node)] = hold_.freePart(node, balance.force);
    }
  }
  for (std::size_t patch = 0; patch < shape.patches.size(); ++patch) {
    if (byForce(shape.patches[patch])) forces.patches[patch] = hold_.forceOn(shape, patch);
  }
  return forces;
}

Motion LayeredMethod::smoothMotion(const Motion& forces, const LoadedShape& shape) const {
  Motion smooth;
  coarse_.solve(forces, shape, hold_, smooth);
  return smooth;
}

// Length (m) of the motions that would balance each node alone.
double LayeredMethod::localLength(const Motion& forces) const {
  double squared = 0.0;
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) {
      if (stiffness_[at(node)] <= 0.0) continue;
      squared += forces.nodes[at(node)].squaredNorm() / std::pow(stiffness_[at(node)], 2);
    }
  }
  return std::sqrt(squared);
}

// Length (m) of the motion that the coarse lattice and the nodes' stiffness say is left.
double LayeredMethod::lengthLeft(const Motion& forces, const Motion& smooth) const {
  double squared = std::pow(localLength(forces), 2);
  for (std::size_t node = 0; node < smooth.nodes.size(); ++node) {
    squared += smooth.nodes[node].squaredNorm();
    const int carrier = hold_.carriers()[node];
    if (carrier >= 0) squared += smooth.patches[at(carrier)].shift.squaredNorm();
  }
  return std::sqrt(squared);
}

// Some cycles went so far, and these were the lengths left before and after them: what was really
// left before is taken to be what they went and the same multiple of what is left after them. Many
// cycles show slow motions, few show the others.
void LayeredMethod::calibrate(const std::vector<Past>& past, const LoadedShape& shape, double left) {
  double factor = 0.0;
  for (std::size_t cycles = 1; cycles <= past.size(); cycles *= 2) {
    const Past& before = past[past.size() - cycles];
    if (!(left < kMostLeft * before.left)) continue;
    factor = std::max(factor, distance(shape, before.displacement) / (before.left - left));
  }
  if (factor == 0.0) return;
  factor = std::min(std::max(factor, 1.0), kMostFactor);
  factor_ = std::max(factor, kRemembered * factor_);
}

double LayeredMethod::distance(const LoadedShape& shape, const std::vector<Vec3>& from) const {
  double squared = 0.0;
  for (std::size_t node = 0; node < from.size(); ++node) {
    squared += (shape.state.displacement[node] - from[node]).squaredNorm();
  }
  return std::sqrt(squared);
}

double LayeredMethod::relative(double left, const LoadedShape& shape) const {
  if (left == 0.0) return 0.0;
  double moved = 0.0;
  for (std::size_t node = 0; node < shape.state.displacement.size(); ++node) {
    if (hold_.held()[node] == kAllHeld && hold_.carriers()[node] < 0) continue;
    moved += shape.state.displacement[node].squaredNorm();
  }
  const double still = kStill * lattice_.spacing();
  return factor_ * left / std::sqrt(std::max(moved, still * still * layers_.nodeCount()));
}

SolveStatus LayeredMethod::iterate(LoadedShape& shape, SolveReport& report) {
  coarse_.build(shape, hold_);
  measurePatches(shape);
  Course course;
  if (goes_on_) course.past.swap(past_);
  course.forces = forcesOf(shape);
  greatest_ = greatest(course.forces);
  SolveStatus status = look(shape, course);
  if (status != SolveStatus::kOk && !goes_on_ && carryOn(shape, course.forces)) {
    course.past.clear();
    status = look(shape, course);
  }
  for (; status == SolveStatus::kLate; status = look(shape, course)) {
    if (course.cycles > 0 && outOfBudget()) break;
    if (course.cycles == options_.slow) coarse_.renew(shape, hold_);
    if (course.blown_up) {
      shape = course.best;
      course.forces = forcesOf(shape);
    }
    if (course.blown_up || !advance(shape, course.forces, course.search)) {
      course.search = Search();
      course.search.plain = kPlainCycles;
    }
    ++course.cycles;
  }
  if (status == SolveStatus::kUnconverged || course.blown_up) {
    shape = course.best;
    course.forces = forcesOf(shape);
    course.error = course.best_error;
  }
  past_.clear();
  if (status == SolveStatus::kLate) past_.swap(course.past);
  report.iterations = 2 * course.cycles;
  report.error_estimate = std::isfinite(course.error) ? course.error : 1.0;
  describe(shape, course.forces, report);
  return status;
}

// Where the course stands: kOk, kLate while there is hope, kUnconverged. Raises layers.
SolveStatus LayeredMethod::look(const LoadedShape& shape, Course& course) {
  Motion smooth = smoothMotion(course.forces, shape);
  if (raiseLayers(smooth, displacementLength(shape))) {
    course.forces = forcesOf(shape);
    smooth = smoothMotion(course.forces, shape);
  }
  const double left = lengthLeft(course.forces, smooth);
  calibrate(course.past, shape, left);
  course.error = relative(left, shape);
  if (course.first < 0.0) course.first = left;
  course.blown_up = !(left <= kBlownUp * course.first);
  course.past.push_back({shape.state.displacement, left});
  if (course.past.size() > kLongestPast) course.past.erase(course.past.begin());
  if (left < course.least) {
    course.least = left;
    course.best = shape;
    course.best_error = course.error;
    course.best_cycle = course.cycles;
  }
  if (course.error <= options_.tolerance) return SolveStatus::kOk;
  const bool hopeless = course.cycles >= options_.max_cycles ||
                        course.cycles > course.best_cycle + options_.patience;
  return hopeless ? SolveStatus::kUnconverged : SolveStatus::kLate;
}

double LayeredMethod::greatest(const Motion& forces) const {
  double squared = 0.0;
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) squared = std::max(squared, forces.nodes[at(node)].squaredNorm());
  }
  return std::sqrt(squared);
}

double LayeredMethod::displacementLength(const LoadedShape& shape) const {
  double squared = 0.0;
  for (const Vec3& moved : shape.state.displacement) squared += moved.squaredNorm();
  return std::sqrt(squared);
}

// Of a solve in which something moved.
void LayeredMethod::rememberWay(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  if (from == to) return;
  last_way_.resize(to.size());
  for (std::size_t node = 0; node < to.size(); ++node) last_way_[node] = to[node] - from[node];
}

// Goes on, or back, the way that the last solve went, as far as the forces work along it.
bool LayeredMethod::carryOn(LoadedShape& shape, Motion& forces) const {
  if (last_way_.size() != shape.state.displacement.size()) return false;
  Motion way;
  way.nodes = last_way_;
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
      moved.nodes[at(node)] = trial.state.displacement[at(node)] - shape.state.displacement[at(node)];
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
  hold_.addRims(shape, node, balance);
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
    squared = std::max(squared, std::pow(lattice_.spacing() / kMostTurn, 2) * patch.turn.squaredNorm());
  }
  return std::sqrt(squared);
}

void LayeredMethod::describe(const LoadedShape& shape, const Motion& forces, SolveReport& report) {
  const std::vector<Vec3>& displacement = shape.state.displacement;
  std::vector<Vec3> raw(displacement.size(), Vec3::Zero());
  double held = 0.0, unbalanced = 0.0;
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    for (const int node : hold_.hardOf(index)) {
      raw[at(node)] = model_.nodeForce(shape.state, node);
      held = std::max(held, raw[at(node)].norm());
    }
    for (const RimSpring& spring : shape.patches[index].rim) {
      const Vec3 stretch = spring.anchor - displacement[at(spring.node)];
      held = std::max(held, (stiffnessOf(shape.patches[index], spring) * stretch).norm());
    }
    report.patches.push_back(answerOf(shape.patches[index], raw, displacement));
    unbalanced = std::max(unbalanced, forces.patches[index].shift.norm());
  }
  pending_.clear();
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) {
      const double force = forces.nodes[at(node)].norm();
      unbalanced = std::max(unbalanced, force);
      if (force > kRounding * stiffness_[at(node)] * lattice_.spacing()) pending_.push_back(node);
    }
  }
  std::sort(pending_.begin(), pending_.end());
  held = std::max(held, greatest_);
  if (held > 0.0) report.residual = unbalanced / held;
  report.active_nodes = layers_.nodeCount();
  for (std::size_t node = 0; node < displacement.size(); ++node) {
    if (hold_.carriers()[node] >= 0) ++report.active_nodes;
  }
  report.layers = static_cast<int>(layers_.all().size());
}

bool LayeredMethod::outOfBudget() const {
  return options_.max_ms > 0.0 && elapsedMs() > options_.max_ms;
}

double LayeredMethod::elapsedMs() const {
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - started_;
  return elapsed.count();
}

}  // namespace robot_tissue
