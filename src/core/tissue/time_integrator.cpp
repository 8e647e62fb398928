#include "tissue/time_integrator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/split_cells.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

// Of the nodes that there are now: every part goes on as its cell did.
std::vector<Vec3> velocitiesIn(const LatticeState& state, const NodeMotion& before) {
  if (!before.cells) return {at(state.cells->nodeCount()), Vec3::Zero()};
  std::vector<Vec3> all = carriedOver(*before.cells, before.velocity, *state.cells);
  for (int node = 0; node < state.cells->nodeCount(); ++node) {
    if (isGone(state, node)) all[at(node)].setZero();
  }
  return all;
}

}  // namespace

void TimeIntegrator::rest() {
  motion_.reset();
  mark_.clear();
  error_ratio_ = 0.0;
}

void TimeIntegrator::wake(const LatticeState& state) {
  NodeMotion motion;
  if (motion_) motion = *motion_;
  motion.velocity = velocitiesIn(state, motion);
  motion.cells = state.cells;
  motion.acceleration.assign(motion.velocity.size(), Vec3::Zero());
  motion.begins = true;
  motion.next_duration = 0.0;
  motion_ = std::make_shared<const NodeMotion>(std::move(motion));
}

double TimeIntegrator::rateFactor() const {
  if (scheme_ == Scheme::kBackwardEuler) return 1.0;
  return !motion_ || motion_->begins ? 2.0 : 1.5;
}

void TimeIntegrator::expect(double duration, Scheme scheme, const LatticeState& state,
                            std::vector<double> masses) {
  if (motion_ && motion_->cells != state.cells) wake(state);
  duration_ = duration;
  scheme_ = scheme;
  masses_ = std::move(masses);
  stiffness_ = {1.0 + damping_time_ * rateFactor() / duration,
                massFactor() / (duration * duration)};
}

std::vector<Vec3> TimeIntegrator::rateFrom() const {
  std::vector<Vec3> from = before_;
  if (scheme_ == Scheme::kBackwardEuler) return from;
  const double h = duration_;
  for (std::size_t node = 0; node < from.size(); ++node) {
    const Vec3 &v = motion_->velocity[node], &a = motion_->acceleration[node];
    from[node] += motion_->begins ? Vec3(0.5 * h * v) : Vec3(h / 3.0 * v - h * h / 6.0 * a);
  }
  return from;
}

double TimeIntegrator::leastWay() const {
  double way = 0.0, displacement = 0.0;
  for (std::size_t node = 0; node < before_.size(); ++node) {
    way += (duration_ * motion_->velocity[node]).squaredNorm();
    displacement += before_[node].squaredNorm();
  }
  return std::max(
      {tuning::kSolvedOfWay * std::sqrt(way),
       tuning::kSolvedOfDisplacement * std::sqrt(displacement),
       tuning::kLeastSolved * spacing_ * std::sqrt(static_cast<double>(before_.size()))});
}

const InertialTerm& TimeIntegrator::begin(const LatticeState& state, Damping damping,
                                          const CellForces& cell_forces) {
  if (!motion_) wake(state);
  before_ = state.displacement;
  const std::size_t nodes = before_.size();
  const std::vector<Vec3>& v = motion_->velocity;
  const double h = duration_;
  term_.elastic_scale = stiffness_.elastic_scale;
  term_.per_mass = stiffness_.per_mass;
  term_.duration = h;
  term_.beside_contacts = scheme_ == Scheme::kBackwardEuler;
  term_.damping_time = damping_time_;
  term_.velocity = v;
  term_.free_motion.resize(nodes);
  term_.force.resize(nodes);
  for (std::size_t node = 0; node < nodes; ++node) {
    term_.free_motion[node] = before_[node] + h * v[node];
    term_.force[node] = masses_[node] * term_.per_mass * term_.free_motion[node];
  }
  term_.least_way = leastWay() / term_.elastic_scale;  // so that forces are as exact
  term_.rate_from.clear();
  if (damping_time_ == 0.0) return term_;
  if (damping == Damping::kOfStrain) {
    term_.rate_from = rateFrom();
    return term_;
  }
  LatticeState there = state;
  there.displacement = rateFrom();
  const std::vector<Vec3> forces = cell_forces(there);
  for (std::size_t node = 0; node < nodes; ++node) {
    term_.force[node] -= (term_.elastic_scale - 1.0) * forces[node];
  }
  return term_;
}

Vec3 TimeIntegrator::drift(const std::vector<int>& nodes, const LatticeState& state,
                           const Vec3& gravity) const {
  Vec3 moment = Vec3::Zero();
  double mass = 0.0;
  for (const int node : nodes) {
    moment += masses_[at(node)] * (state.displacement[at(node)] - term_.free_motion[at(node)]);
    mass += masses_[at(node)];
  }
  if (mass == 0.0) return Vec3::Zero();
  return moment / mass - duration_ * duration_ / massFactor() * gravity;
}

Vec3 TimeIntegrator::lead(const Vec3& gravity) const {
  return (1.0 / massFactor() - 0.5) * duration_ * duration_ * gravity;
}

void TimeIntegrator::end(const LatticeState& state, const std::vector<Vec3>* velocities) {
  NodeMotion motion = *motion_;
  const double h = duration_;
  if (velocities != nullptr && velocities->size() == before_.size()) {
    for (std::size_t node = 0; node < before_.size(); ++node) {
      motion.acceleration[node] = ((*velocities)[node] - motion.velocity[node]) / h;
    }
    motion.velocity = *velocities;
    return judge(state, motion);
  }
  for (std::size_t node = 0; node < before_.size(); ++node) {
    const Vec3 by_forces = state.displacement[node] - term_.free_motion[node];
    Vec3 &v = motion.velocity[node], &a = motion.acceleration[node];
    if (scheme_ == Scheme::kBackwardEuler) {
      a = by_forces / (h * h);
      v += h * a;
    } else if (motion.begins) {
      a = 2.0 / (h * h) * by_forces;
      v += h * a;
    } else {
      const Vec3 now = by_forces / (h * h) + 0.5 * a;
      v += h * (1.5 * now - 0.5 * a);
      a = now;
    }
  }
  judge(state, motion);
}

// What touches a tool trembles as solves are not exact: it rests when it comes nowhere. What
// creeps, by its damping, goes on for about the damping time.
bool TimeIntegrator::comesNowhere(const LatticeState& state) {
  mark_age_ += duration_;
  const bool has_mark = mark_.size() == state.displacement.size();
  if (has_mark && mark_age_ < tuning::kRestTime) return false;
  double farthest = 0.0, greatest = 0.0;
  for (std::size_t node = 0; has_mark && node < mark_.size(); ++node) {
    farthest = std::max(farthest, (state.displacement[node] - mark_[node]).squaredNorm());
    greatest = std::max(greatest, state.displacement[node].squaredNorm());
  }
  mark_ = state.displacement;
  mark_age_ = 0.0;
  const double to_come = std::sqrt(farthest) * std::max(1.0, damping_time_ / tuning::kRestTime);
  return has_mark && to_come < negligibleWay(std::sqrt(greatest));
}

// m; of what is that far off rest.
double TimeIntegrator::negligibleWay(double displacement) const {
  return tuning::kTrembling * tolerance_ * displacement;
}

// A bound of the angle by which the tissue has turned in the step (rad), where it is damped: what
// is farther from the mean way than that over half of the tissue's width, of a cube of so many
// nodes.
double TimeIntegrator::turnOf(const LatticeState& state) const {
  if (damping_time_ == 0.0) return 0.0;
  const auto nodes = static_cast<double>(before_.size());
  Vec3 mean = Vec3::Zero();
  for (std::size_t node = 0; node < before_.size(); ++node) {
    mean += (state.displacement[node] - before_[node]) / nodes;
  }
  double farthest = 0.0;
  for (std::size_t node = 0; node < before_.size(); ++node) {
    farthest = std::max(farthest, (state.displacement[node] - before_[node] - mean).squaredNorm());
  }
  return std::sqrt(farthest) / (0.5 * spacing_ * std::cbrt(nodes));
}

// The local error of a step is h^2 |a' - a| / 3, or h^2 |a'| / 2 of Euler's (tuning.h); it is held
// against what moves: the way of the step, and the displacement.
void TimeIntegrator::judge(const LatticeState& state, NodeMotion& motion) {
  const double h = duration_;
  const bool is_first_order = scheme_ == Scheme::kBackwardEuler;
  const bool is_known = is_first_order || !motion_->begins;  // what its error is
  double way = 0.0, displacement = 0.0, error = 0.0, farthest = 0.0, fastest = 0.0, most = 0.0;
  for (std::size_t node = 0; node < before_.size(); ++node) {
    const Vec3 moved = state.displacement[node] - before_[node];
    way += moved.squaredNorm();
    displacement += state.displacement[node].squaredNorm();
    most = std::max(most, state.displacement[node].squaredNorm());
    fastest = std::max(fastest, motion.velocity[node].squaredNorm());
    Vec3 change = motion.acceleration[node];
    if (!is_first_order) change -= motion_->acceleration[node];
    if (is_known) error += change.squaredNorm();
    farthest = std::max({farthest, moved.squaredNorm(), (h * motion.velocity[node]).squaredNorm(),
                         (h * h * motion.acceleration[node]).squaredNorm()});
  }
  const double still = tuning::kAtRest * spacing_;
  const bool creeps =
      damping_time_ * std::sqrt(fastest) > std::max(still, negligibleWay(std::sqrt(most)));
  if ((std::sqrt(farthest) < still && !creeps) || comesNowhere(state)) return rest();
  const double least =
      tuning::kLeastMotion * spacing_ * std::sqrt(static_cast<double>(before_.size()));
  const double scale =
      std::max({std::sqrt(way), tuning::kShareOfDisplacement * std::sqrt(displacement), least});
  const double share = is_first_order ? tuning::kErrorOfEulersStep : tuning::kErrorOfStep;
  error_ratio_ = std::max(share * h * h * std::sqrt(error) / (tolerance_ * scale),
                          std::pow(turnOf(state) / tuning::kMostTurn, is_first_order ? 2.0 : 3.0));
  const double growth =
      std::pow(tuning::kSafety / std::max(error_ratio_, 1e-9), is_first_order ? 0.5 : 1.0 / 3.0);
  motion.next_duration =
      is_known ? h * std::clamp(growth, tuning::kMostShrink, tuning::kMostGrowthOfStep) : h;
  motion.begins = is_first_order;
  motion_ = std::make_shared<const NodeMotion>(std::move(motion));
}

bool TimeIntegrator::isRefused() const {
  return error_ratio_ > tuning::kRefusedError && duration_ > tuning::kShortestStep;
}

double TimeIntegrator::longestStep() const {
  if (!motion_ || motion_->next_duration == 0.0) return tuning::kFirstStep;
  return std::clamp(motion_->next_duration, tuning::kShortestStep, tuning::kLongestStep);
}

}  // namespace robot_tissue
