#include "robot_tissue/core/layered_method.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace robot_tissue {
namespace {

constexpr double kRounding = 1e-13;      // of a node's stiffness times the spacing
constexpr double kStill = 1e-6;          // of the spacing: off rest by less, a node is at rest
constexpr double kMostLeft = 0.9;        // of the length left before cycles, to learn from them
constexpr double kMostFactor = 4.0;      // that they may show
constexpr double kRemembered = 0.9;      // of the factor, from cycle to cycle
constexpr std::size_t kLongestPast = 8;  // cycles
constexpr double kBlownUp = 100.0;       // times the length left when a solve begins
constexpr int kPlainCycles = 8;

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
  hold_.place(shape);
  goes_on_ =
      !past_.empty() && shape.state.cells == left_cells_ && shape.state.displacement == left_;
  layOut(shape);
  report.status = iterate(shape, report);
  state = std::move(shape.state);
  patches = std::move(shape.patches);
  first_of_step_ = false;
  left_ = state.displacement;
  left_cells_ = state.cells;
  report.wall_ms = elapsedMs();
  return report;
}

// Remembers the way of the last step, if anything moved in it.
void LayeredMethod::beginStep(const LatticeState& state) {
  first_of_step_ = true;
  const std::vector<Vec3>& now = state.displacement;
  if (step_start_.size() == now.size() && step_start_ != now) {
    last_way_.resize(now.size());
    for (std::size_t node = 0; node < now.size(); ++node) {
      last_way_[node] = now[node] - step_start_[node];
    }
  }
  step_start_ = now;
}

void LayeredMethod::forget() {
  coarse_.forget();
  factor_ = 1.0;
  pending_.clear();
  patch_nodes_.clear();
  past_.clear();
  step_start_.clear();
  last_way_.clear();
  left_.clear();
  left_cells_.reset();
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
  first.insert(first.end(), hold_.touched().begin(), hold_.touched().end());
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
      hold_.addSprings(shape, node, balance);
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
void LayeredMethod::calibrate(const std::vector<Past>& past, const LoadedShape& shape,
                              double left) {
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
  if (status != SolveStatus::kOk && !goes_on_ && first_of_step_ && carryOn(shape, course.forces)) {
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
  // Contacts change in ways that are small beside the displacement, but not to them.
  const bool untried = course.cycles == 0 && !hold_.touched().empty();
  if (course.error <= options_.tolerance && !untried) return SolveStatus::kOk;
  const bool hopeless =
      course.cycles >= options_.max_cycles || course.cycles > course.best_cycle + options_.patience;
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

// The shape that one more cycle would give. What a patch meets is read off it: the force is then
// wrong by what is left of the error after that cycle, and the shape itself stays. A cycle that
// runs into contacts may lead away: then the shape it is.
LatticeState LayeredMethod::balancedAhead(const LoadedShape& shape, const Motion& forces) const {
  LatticeState ahead = shape.state;
  if (shape.patches.empty() || outOfBudget() || greatest(forces) == 0.0) return ahead;
  const Motion motion = cycle(shape);
  if (!std::isfinite(longest(motion))) return ahead;
  LoadedShape next = shape;
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) next.state.displacement[at(node)] += motion.nodes[at(node)];
  }
  const bool nearer = localLength(forcesOf(next)) < localLength(forces);
  return nearer ? next.state : ahead;
}

void LayeredMethod::describe(const LoadedShape& shape, const Motion& forces, SolveReport& report) {
  const std::vector<Vec3>& displacement = shape.state.displacement;
  const LatticeState ahead = balancedAhead(shape, forces);
  double held = 0.0, unbalanced = 0.0;
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    const LatticeState& state = byForce(patch) ? shape.state : ahead;
    std::vector<Vec3> raw(displacement.size(), Vec3::Zero());
    std::vector<Vec3> contact_forces(displacement.size(), Vec3::Zero());
    for (const LoadingPatch& other : shape.patches) {
      if (hold_.hardOf(index).empty()) break;
      addContactForces(other, state.displacement, contact_forces);
    }
    for (const int node : hold_.hardOf(index)) {
      raw[at(node)] = model_.nodeForce(state, node) + contact_forces[at(node)];
      held = std::max(held, raw[at(node)].norm());
    }
    for (const RimSpring& spring : patch.rim) {
      const Vec3 stretch = spring.anchor - state.displacement[at(spring.node)];
      held = std::max(held, (stiffnessOf(patch, spring) * stretch).norm());
    }
    for (const ContactSpring& spring : patch.contacts) {
      held = std::max(held, forceOf(spring, state.displacement).norm());
    }
    report.patches.push_back(answerOf(lattice_, state, patch, raw));
    report.patches.back().displacement = meanDisplacement(patch, displacement);
    unbalanced = std::max(unbalanced, forces.patches[index].shift.norm());
  }
  pending_.clear();
  for (const auto& layer : layers_.all()) {
    for (const int node : layer) {
      const double force = forces.nodes[at(node)].norm();
      unbalanced = std::max(unbalanced, force);
      const double firm = stiffness_[at(node)] * lattice_.spacing();
      if (force > kRounding * firm) pending_.push_back(node);
      held = std::max(held, kStill * firm);  // what no force holds is off by rounding alone
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
