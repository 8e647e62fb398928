#include "robot_tissue/core/layered_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace robot_tissue {
namespace {

constexpr double kSinglePrecision = 1e-3;  // tolerance that single precision reaches
constexpr double kStill = 1e-6;            // of the spacing: off rest by less, a node is at rest
constexpr double kMostLeft = 0.9;          // of the length left before cycles, to learn from them
constexpr double kMostFactor = 8.0;        // that they may show
constexpr double kRemembered = 0.9;        // of the factor, from cycle to cycle
constexpr double kBlownUp = 100.0;         // times the length left when a solve begins
constexpr double kSlow = 0.3;              // of the length left before a cycle: then gradients help
constexpr double kFlatEnough = 0.3;  // of the slope along a direction: no need to look further
constexpr double kDip = 0.5;         // of the length left before a cycle: counts as left after it
constexpr double kWorthKeeping = 0.05;  // of the last direction, beside a new one
constexpr int kFewestSteps = 3;         // of the smoother in a cycle
constexpr double kStepsOfRoot = 1.6;    // of the greatest stiffness, in nodes' stiffnesses
constexpr int kTrialCycles = 6;         // that show how much of what is left they see
constexpr double kTrialMotion = 1e-3;   // in spacings
constexpr double kLeastAfter = 0.6;     // of the length left before a cycle: is after it
constexpr double kFirstLayers = 6;      // around patches and contacts
constexpr double kMoreLayers = 1.5;     // times those there are
constexpr double kPatchBalance = 1e-5;  // of the force on a patch: what single precision knows
constexpr double kFalling = 0.5;        // of the given force: unbalanced, where nothing holds
constexpr int kTrials = 8;              // of the length along it
constexpr int kMostTurns = 20;          // solves, until turning patches have settled
constexpr double kTurned = 1e-4;        // rad
constexpr int kPlainSteps = 8;          // of the smoother, where a cycle led nowhere

template <typename Real>
class CourseIn : public LayeredCourse {
 public:
  CourseIn(const Lattice& lattice, const ElasticModel& model, const LayeredOptions& options)
      : lattice_(lattice), model_(model), options_(options) {}

  SolveReport run(LoadedShape& shape, const PatchHold& hold, const Budget& budget) override;
  void beginStep(const LatticeState& state) override;
  void forget() override;

 private:
  // Positions, or forces that do work in a motion.
  struct Vector {
    Field<Real> nodes;
    std::vector<GroupVector> groups;
  };

  void prepare(LoadedShape& shape, const PatchHold& hold);
  void findLevels(const LatticeState& state);
  void findLeastFactor(const LatticeState& state);
  LevelBox wholeBox() const;
  void findSeeds(const LoadedShape& shape, const PatchHold& hold);
  LevelBox aroundSeeds() const;
  bool raiseLayers();
  bool isOutermost(std::size_t axis, int place) const;
  double layerMotion() const;
  bool isBalanced() const;
  void writeBack(LoadedShape& shape, const PatchHold& hold) const;
  bool carryOn();
  SolveStatus iterate(bool touched, bool carried_on, const Budget& budget);
  SolveStatus look(bool touched);
  void learn(double trend_before);
  void advance();
  bool searchAlong(const Vector& way, double slope, double slope_here);
  bool settlePatches(LoadedShape& shape, const PatchHold& hold);
  void keep(Vector& vector) const;
  void putBack(const Vector& vector);
  void answer(LoadedShape& shape, const PatchHold& hold, SolveReport& report) const;

  LatticeLevel<Real>& finest() { return levels_->finest(); }
  const LatticeLevel<Real>& finest() const { return levels_->finest(); }
  static double work(const Vector& force, const Vector& motion);
  static void add(const Vector& other, double share, Vector& to);
  double workOf(const Vector& motion) const;
  double lengthOf(const Field<Real>& field) const;
  double lengthLeft() const;
  double longestSmooth() const;
  double distanceFrom(const Vector& vector) const;

  const Lattice& lattice_;
  const ElasticModel& model_;
  LayeredOptions options_;
  std::unique_ptr<LatticeLevels<Real>> levels_;
  std::shared_ptr<const CellSet> cells_;
  double free_nodes_ = 0.0;
  LevelBox seeds_;  // what the layers grow around
  bool has_seeds_ = false;
  double layers_ = kFirstLayers;  // around them, that were raised last
  int steps_ = kFewestSteps;      // of the smoother in a cycle
  double least_factor_ = 1.0;
  double factor_ =
      1.0;  // of the length left: what cycles showed to be left, least_factor_ at least

  // Of the solve under way; lengths in spacings.
  int cycles_ = 0;
  double left_ = 0.0, left_before_ = 0.0, first_left_ = 0.0;
  double error_ = 0.0, error_after_ = 0.0;  // estimates: now, after one more cycle
  double trend_ = 0.0;                      // of the length left
  double least_ = 0.0, best_error_ = 1.0;
  int best_cycle_ = 0;
  double greatest_ = 0.0;  // unbalanced force at its start
  Vector start_, before_, best_;
  Vector force_before_, way_, direction_, earlier_force_;
  double promised_ = 0.0;   // work of earlier_force_ in the cycle's own motion
  bool fresh_ = true;       // no direction yet
  bool conjugate_ = false;  // the last cycle went on with the one before

  Field<Real> step_start_, last_way_;
  bool has_start_ = false, has_way_ = false, first_of_step_ = false;
};

template <typename Real>
void CourseIn<Real>::forget() {
  factor_ = least_factor_;
  layers_ = kFirstLayers;
  has_start_ = has_way_ = false;
}

// Remembers the way of the last step, if anything moved in it.
template <typename Real>
void CourseIn<Real>::beginStep(const LatticeState& state) {
  first_of_step_ = true;
  findLevels(state);
  levels_->setDisplacement(state.displacement);
  const Field<Real>& now = finest().displacement;
  if (has_start_ && step_start_ != now) {
    last_way_ = now;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < now[axis].size(); ++i) last_way_[axis][i] -= step_start_[axis][i];
    }
    has_way_ = true;
  }
  step_start_ = now;
  has_start_ = true;
}

template <typename Real>
SolveReport CourseIn<Real>::run(LoadedShape& shape, const PatchHold& hold, const Budget& budget) {
  prepare(shape, hold);
  SolveReport report;
  const bool carried_on = first_of_step_ && has_way_ && greatest_ > 0.0 && carryOn();
  for (int round = 0; round < kMostTurns; ++round) {
    report.status = iterate(!hold.touched().empty(), carried_on, budget);
    writeBack(shape, hold);
    if (!settlePatches(shape, hold) || report.status != SolveStatus::kOk) break;
  }
  first_of_step_ = false;
  report.iterations = cycles_;
  report.error_estimate = std::isfinite(error_) ? error_ : 1.0;
  answer(shape, hold, report);
  return report;
}

template <typename Real>
void CourseIn<Real>::writeBack(LoadedShape& shape, const PatchHold& hold) const {
  for (std::size_t node = 0; node < shape.state.displacement.size(); ++node) {
    if (hold.held()[node] == kAllHeld) continue;
    const Vec3 moved = levels_->displacementOf(static_cast<int>(node));
    Vec3& place = shape.state.displacement[node];
    for (int axis = 0; axis < 3; ++axis) {
      if ((hold.held()[node] >> axis & 1) == 0) place[axis] = moved[axis];
    }
  }
}

template <typename Real>
void CourseIn<Real>::findLevels(const LatticeState& state) {
  if (cells_ == state.cells) return;
  levels_ = std::make_unique<LatticeLevels<Real>>(lattice_, model_, *state.cells);
  cells_ = state.cells;
  has_start_ = has_way_ = false;
  steps_ = std::max(
      kFewestSteps,
      static_cast<int>(std::lround(kStepsOfRoot * std::sqrt(finest().greatestStiffness()))));
  findLeastFactor(state);
}

template <typename Real>
void CourseIn<Real>::prepare(LoadedShape& shape, const PatchHold& hold) {
  findLevels(shape.state);
  levels_->bind(shape, hold);
  levels_->setDisplacement(shape.state.displacement);
  levels_->confine(wholeBox());
  finest().findForces(true);
  free_nodes_ = 0.0;
  for (const std::uint8_t held : hold.held()) free_nodes_ += held != kAllHeld ? 1.0 : 0.0;
  findSeeds(shape, hold);
  levels_->confine(aroundSeeds());
  finest().findForces(true);
  cycles_ = 0;
  fresh_ = true;
  greatest_ = 0.0;
  for (const auto& values : finest().force) {
    for (const Real value : values) {
      greatest_ = std::max(greatest_, std::abs(static_cast<double>(value)));
    }
  }
}

template <typename Real>
LevelBox CourseIn<Real>::wholeBox() const {
  LevelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) box.high[axis] = lattice_.size()[axis] - 1;
  return box;
}

// Motion (spacings) of a node below which no layer is raised for it.
template <typename Real>
double CourseIn<Real>::layerMotion() const {
  const double mean = lengthOf(finest().displacement) / std::sqrt(free_nodes_ + 1.0);
  return std::max(options_.layer_share * options_.tolerance * mean, kStill * options_.tolerance);
}

// Nodes in patches and contacts, and nodes out of balance: the box around them.
template <typename Real>
void CourseIn<Real>::findSeeds(const LoadedShape& shape, const PatchHold& hold) {
  seeds_ = {lattice_.size(), {-1, -1, -1}};
  const auto add = [this](int entry) {
    const std::array<int, 3> place = finest().placeOf(entry);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      seeds_.low[axis] = std::min(seeds_.low[axis], place[axis]);
      seeds_.high[axis] = std::max(seeds_.high[axis], place[axis]);
    }
  };
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    for (const int node : hold.hardOf(index)) add(levels_->entryOf(node));
    for (const RimSpring& spring : shape.patches[index].rim) add(levels_->entryOf(spring.node));
  }
  for (const int node : hold.touched()) add(levels_->entryOf(node));
  const double still = layerMotion();
  for (const int entry : finest().nodesOutOfBalance(still)) add(entry);
  has_seeds_ = seeds_.high[0] >= 0;
}

template <typename Real>
LevelBox CourseIn<Real>::aroundSeeds() const {
  LevelBox box = seeds_;
  if (!has_seeds_) return {{1, 1, 1}, {0, 0, 0}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int layers = static_cast<int>(layers_);
    box.low[axis] = std::max(0, (box.low[axis] - layers) & ~1);
    box.high[axis] = std::min(lattice_.size()[axis] - 1, (box.high[axis] + layers + 1) & ~1);
  }
  return box;
}

// Whether layers were raised: the outermost moves by more than layerMotion.
template <typename Real>
bool CourseIn<Real>::raiseLayers() {
  const LevelBox& box = finest().box();
  const LevelGrid& grid = finest().grid();
  const double still = layerMotion();
  const auto moves = [&](int i, int j, int k) {
    double squared = 0.0;
    for (const auto& values : levels_->motion) {
      const double moved = static_cast<double>(values[at(grid.index(i, j, k))]);
      squared += moved * moved;
    }
    return squared > still * still;
  };
  bool any = false;
  for (int k = box.low[2]; k <= box.high[2]; ++k) {
    for (int j = box.low[1]; j <= box.high[1]; ++j) {
      const bool face = isOutermost(2, k) || isOutermost(1, j);
      for (int i = box.low[0]; !any && i <= box.high[0]; ++i) {
        if (face || isOutermost(0, i)) any = moves(i, j, k);
      }
    }
  }
  if (!any) return false;
  layers_ = std::ceil(kMoreLayers * layers_);
  levels_->confine(aroundSeeds());
  return true;
}

// On a side of the box that is none of the lattice's, or next to it.
template <typename Real>
bool CourseIn<Real>::isOutermost(std::size_t axis, int place) const {
  const LevelBox& box = finest().box();
  if (box.low[axis] > 0 && place <= box.low[axis] + 1) return true;
  return box.high[axis] < lattice_.size()[axis] - 1 && place >= box.high[axis] - 1;
}

// A shape thrown off rest by little goes back to it: there the length left is known, and with it
// what share of it a cycle sees. Slow motions, the last to go, are seen least.
template <typename Real>
void CourseIn<Real>::findLeastFactor(const LatticeState& state) {
  LoadedShape rest{state, {}};
  std::fill(rest.state.displacement.begin(), rest.state.displacement.end(), Vec3::Zero());
  PatchHold fixed(lattice_, model_);
  fixed.bind(rest);
  std::uint32_t number = 1;
  for (std::size_t node = 0; node < rest.state.displacement.size(); ++node) {
    if (fixed.held()[node] == kAllHeld) continue;
    for (int axis = 0; axis < 3; ++axis) {
      number = 1664525U * number + 1013904223U;
      const double share = static_cast<double>(number >> 8) / (1 << 24) - 0.5;
      rest.state.displacement[node][axis] = kTrialMotion * lattice_.spacing() * share;
    }
  }
  levels_->bind(rest, fixed);
  finest().clearLoad();
  levels_->setDisplacement(rest.state.displacement);
  finest().findForces(true);
  least_factor_ = 1.0;
  for (int cycle = 0; cycle < kTrialCycles; ++cycle) {
    levels_->findSmoothMotion();
    const double left = lengthLeft();
    if (cycle > 0 && left > 0.0) {
      least_factor_ = std::max(least_factor_, lengthOf(finest().displacement) / left);
    }
    finest().moveBy(levels_->motion, levels_->group_motion, 1.0);
    finest().findForces(true);
    finest().smooth(steps_, true);
  }
  least_factor_ = std::min(least_factor_, kMostFactor);
  factor_ = least_factor_;
}

// Of the motion that the coarse lattices, and each node alone, say is left.
template <typename Real>
double CourseIn<Real>::lengthLeft() const {
  double squared = finest().squaredLocalMotion();
  squared += finest().squaredMotionOf(levels_->group_motion);
  for (const auto& values : levels_->motion) {
    squared += dotOf(values.data(), values.data(), finest().count());
  }
  return std::sqrt(squared);
}

template <typename Real>
void CourseIn<Real>::keep(Vector& vector) const {
  vector.nodes = finest().displacement;
  vector.groups = finest().group_motion;
}

template <typename Real>
void CourseIn<Real>::putBack(const Vector& vector) {
  finest().displacement = vector.nodes;
  finest().group_motion = vector.groups;
}

template <typename Real>
double CourseIn<Real>::work(const Vector& force, const Vector& motion) {
  double work = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    work += dotOf(force.nodes[axis].data(), motion.nodes[axis].data(),
                  static_cast<int>(motion.nodes[axis].size()));
  }
  for (std::size_t group = 0; group < motion.groups.size(); ++group) {
    work += force.groups[group].dot(motion.groups[group]);
  }
  return work;
}

template <typename Real>
void CourseIn<Real>::add(const Vector& other, double share, Vector& to) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < to.nodes[axis].size(); ++i) {
      to.nodes[axis][i] += static_cast<Real>(share) * other.nodes[axis][i];
    }
  }
  for (std::size_t group = 0; group < to.groups.size(); ++group) {
    to.groups[group] += share * other.groups[group];
  }
}

template <typename Real>
double CourseIn<Real>::workOf(const Vector& motion) const {
  double work = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    work += dotOf(finest().force[axis].data(), motion.nodes[axis].data(), finest().count());
  }
  for (std::size_t group = 0; group < motion.groups.size(); ++group) {
    work += finest().group_force[group].dot(motion.groups[group]);
  }
  return work;
}

template <typename Real>
double CourseIn<Real>::lengthOf(const Field<Real>& field) const {
  double squared = 0.0;
  for (const auto& values : field) {
    squared += dotOf(values.data(), values.data(), finest().count());
  }
  return std::sqrt(squared);
}

template <typename Real>
double CourseIn<Real>::distanceFrom(const Vector& vector) const {
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < vector.nodes[axis].size(); ++i) {
      const double apart =
          static_cast<double>(finest().displacement[axis][i] - vector.nodes[axis][i]);
      squared += apart * apart;
    }
  }
  return std::sqrt(squared);
}

template <typename Real>
double CourseIn<Real>::longestSmooth() const {
  Real longest = 0;
  for (const auto& values : levels_->motion) {
    for (const Real value : values) longest = std::max(longest, std::abs(value));
  }
  return static_cast<double>(longest);
}

// Goes on, or back, the way that the last step went, as far as the forces work along it.
template <typename Real>
bool CourseIn<Real>::carryOn() {
  keep(before_);
  way_.nodes = last_way_;
  way_.groups.assign(finest().groups.size(), GroupVector::Zero());
  const double slope = workOf(way_);
  if (slope == 0.0 || !std::isfinite(slope)) return false;
  const double share = slope > 0.0 ? 1.0 : -1.0;
  finest().moveBy(way_.nodes, way_.groups, share);
  finest().findForces(true);
  const double here = workOf(way_);
  if (std::abs(here) <= kFlatEnough * std::abs(slope)) return true;
  const double best = slope / (slope - here);  // of `share`, were the energy quadratic
  if (!std::isfinite(here) || !(best > 0.0)) {
    putBack(before_);
    finest().findForces(true);
    return false;
  }
  finest().moveBy(way_.nodes, way_.groups, share * (std::min(best, 2.0) - 1.0));
  finest().findForces(true);
  return true;
}

template <typename Real>
SolveStatus CourseIn<Real>::iterate(bool touched, bool carried_on, const Budget& budget) {
  keep(start_);
  first_left_ = -1.0;
  fresh_ = true;
  conjugate_ = false;
  SolveStatus status = look(touched);
  for (; status == SolveStatus::kLate; status = look(touched)) {
    if (cycles_ > 0 && budget.isSpent()) break;
    advance();
    ++cycles_;
  }
  if (status == SolveStatus::kUnconverged) {
    putBack(best_);
    finest().findForces(true);
    error_ = best_error_;
    return status;
  }
  // What is in balance stays, bit for bit.
  const bool moves = cycles_ > 0 || carried_on || error_ > options_.tolerance;
  if (status == SolveStatus::kOk && moves && left_ > 0.0) {
    error_ = error_after_;
    finest().moveBy(levels_->motion, levels_->group_motion, 1.0);
    finest().findForces(true);
    finest().smooth(1, true);
  }
  return status;
}

// Where the course stands: kOk, kLate while there is hope, kUnconverged.
template <typename Real>
SolveStatus CourseIn<Real>::look(bool touched) {
  levels_->findSmoothMotion();
  const bool raised = raiseLayers();
  if (raised) {
    finest().findForces(true);
    levels_->findSmoothMotion();
  }
  left_before_ = left_;
  left_ = lengthLeft();
  // Under conjugate gradients it rises and falls on its way down.
  const double trend_before = trend_;
  trend_ = conjugate_ ? std::max(left_, kDip * trend_) : left_;
  if (cycles_ > 0) learn(trend_before);
  const double moved = lengthOf(finest().displacement);
  const double unit = std::max(moved, kStill * std::sqrt(free_nodes_ + 1.0));
  error_ = factor_ * trend_ / unit;
  const double gain = cycles_ > 0 ? factor_ * std::min(trend_ / trend_before, 1.0) : 0.0;
  error_after_ = std::max({factor_ - 1.0, gain, kLeastAfter}) * trend_ / unit;
  if (first_left_ < 0.0) {
    first_left_ = left_;
    least_ = std::numeric_limits<double>::infinity();
  }
  if (left_ < least_) {
    least_ = left_;
    keep(best_);
    best_error_ = error_;
    best_cycle_ = cycles_;
  }
  // Contacts change in ways that are small beside the displacement, but not to them.
  const bool untried = cycles_ == 0 && touched;
  if (!untried && !raised && error_after_ <= options_.tolerance && isBalanced())
    return SolveStatus::kOk;
  const bool hopeless = cycles_ >= options_.max_cycles || cycles_ > best_cycle_ + options_.patience;
  return hopeless ? SolveStatus::kUnconverged : SolveStatus::kLate;
}

// Forces on patches, and on the whole, have found their answer.
template <typename Real>
bool CourseIn<Real>::isBalanced() const {
  Vec3 given = Vec3::Zero(), net = Vec3::Zero();
  for (std::size_t group = 0; group < finest().groups.size(); ++group) {
    const Vec3 load = finest().group_load[group].template head<3>();
    const Vec3 left = finest().group_force[group].template head<3>();
    if (left.norm() > std::max(options_.tolerance, kPatchBalance) * load.norm()) return false;
    given += load;
    net += left;
  }
  if (given.isZero(0.0)) return true;
  for (int axis = 0; axis < 3; ++axis) {
    for (const Real force : finest().force[at(axis)]) net[axis] += static_cast<double>(force);
  }
  return net.norm() < kFalling * given.norm();
}

// Cycles went so far, and these were the lengths left before and after them: what was really left
// before is taken to be what they went and the same multiple of what is left after them.
template <typename Real>
void CourseIn<Real>::learn(double trend_before) {
  double factor = 0.0;
  if (trend_ < kMostLeft * trend_before) {
    factor = distanceFrom(before_) / (trend_before - trend_);
  }
  if (cycles_ > 1 && trend_ < kMostLeft * first_left_) {
    factor = std::max(factor, distanceFrom(start_) / (first_left_ - trend_));
  }
  if (factor == 0.0) return;
  factor = std::min(std::max(factor, least_factor_), kMostFactor);
  factor_ = std::max(factor, kRemembered * factor_);
}

// One cycle.
template <typename Real>
void CourseIn<Real>::advance() {
  if (!(left_ <= kBlownUp * first_left_)) {
    putBack(best_);
    for (auto& values : levels_->motion) std::fill(values.begin(), values.end(), Real(0));
    finest().findForces(true);
    finest().smooth(kPlainSteps, true);
    keep(before_);
    fresh_ = true;
    return;
  }
  keep(before_);
  force_before_.nodes = finest().force;
  force_before_.groups = finest().group_force;
  const double longest = longestSmooth();
  const double share = longest > options_.line_step ? options_.line_step / longest : 1.0;
  finest().moveBy(levels_->motion, levels_->group_motion, share);
  finest().findForces(true);
  finest().smooth(steps_, true);
  way_.nodes = finest().displacement;
  way_.groups = finest().group_motion;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < way_.nodes[axis].size(); ++i) {
      way_.nodes[axis][i] -= before_.nodes[axis][i];
    }
  }
  for (std::size_t group = 0; group < way_.groups.size(); ++group) {
    way_.groups[group] -= before_.groups[group];
  }
  const double promised = work(force_before_, way_);
  double slope = promised;
  const double share_kept = fresh_ ? 0.0 : (promised - work(earlier_force_, way_)) / promised_;
  if (share_kept > kWorthKeeping && left_ > kSlow * left_before_) {
    const double along = work(force_before_, direction_);
    if (promised + share_kept * along > 0.0) {
      slope += share_kept * along;
      add(direction_, share_kept, way_);
      putBack(before_);
      finest().moveBy(way_.nodes, way_.groups, 1.0);
      finest().findForces(true);
    }
  }
  conjugate_ = !fresh_ && left_ > kSlow * left_before_;
  fresh_ = false;
  promised_ = promised;
  std::swap(earlier_force_, force_before_);
  if (promised > 0.0 && searchAlong(way_, slope, workOf(way_))) {
    std::swap(direction_, way_);
  } else {
    putBack(before_);
    finest().calm();
    finest().findForces(true);
    finest().smooth(kPlainSteps, true);
    fresh_ = true;
  }
}

// Having gone along the way once: further or back, to where the forces no longer work along it.
// `slope`: what they did at its start. False: it leads nowhere.
template <typename Real>
bool CourseIn<Real>::searchAlong(const Vector& way, double slope, double slope_here) {
  double low = 0.0, low_slope = slope, high = 0.0, high_slope = 0.0;
  bool bracketed = false;
  double share = 1.0, here = slope_here;
  for (int trial = 0; trial < kTrials; ++trial) {
    if (std::abs(here) <= kFlatEnough * slope) return true;
    if (here > 0.0 && std::isfinite(here)) {
      low = share;
      low_slope = here;
    } else {
      high = share;
      high_slope = here;
      bracketed = true;
    }
    if (!bracketed) {
      const double secant = low_slope < slope ? share * slope / (slope - low_slope) : 2.0 * share;
      if (trial > 1) return true;
      share = std::min({std::max(secant, 1.1 * share), 4.0 * share});
    } else if (std::isfinite(high_slope)) {
      const double across = low_slope / (low_slope - high_slope);
      share = low + std::min(std::max(across, 0.1), 0.9) * (high - low);
    } else {
      share = 0.5 * (low + high);
    }
    putBack(before_);
    finest().calm();
    finest().moveBy(way.nodes, way.groups, share);
    finest().findForces(true);
    here = workOf(way);
  }
  return low > 0.0 && std::isfinite(here);
}

// Patches by force go where the levels moved them, as rigid bodies do. True: one turned so far that
// its nodes are no longer where they were found to balance.
template <typename Real>
bool CourseIn<Real>::settlePatches(LoadedShape& shape, const PatchHold& hold) {
  bool any = false, turned = false;
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    LoadingPatch& patch = shape.patches[index];
    const GroupVector motion = finest().group_motion[index];
    if (!byForce(patch) || motion.isZero(0.0)) continue;
    movePatch(lattice_, patch, lattice_.spacing() * motion.template head<3>(),
              motion.template tail<3>(), shape.state);
    any = true;
    turned = turned || motion.template tail<3>().norm() > kTurned;
  }
  if (!any) return false;
  levels_->renewGroups(shape, hold);
  finest().findForces(true);
  return turned;
}

template <typename Real>
void CourseIn<Real>::answer(LoadedShape& shape, const PatchHold& hold, SolveReport& report) const {
  const std::vector<Vec3>& displacement = shape.state.displacement;
  const double unit = levels_->modulus() * lattice_.spacing() * lattice_.spacing();
  double held = greatest_, unbalanced = 0.0;
  std::vector<Vec3> raw(displacement.size(), Vec3::Zero());
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    for (const int node : hold.hardOf(index)) {
      raw[at(node)] = unit * finest().wholeForce(levels_->entryOf(node));
      held = std::max(held, raw[at(node)].norm() / unit);
    }
    for (const RimSpring& spring : patch.rim) {
      const Vec3 stretch = spring.anchor - displacement[at(spring.node)];
      held = std::max(held, (stiffnessOf(patch, spring) * stretch).norm() / unit);
    }
    for (const ContactSpring& spring : patch.contacts) {
      held = std::max(held, forceOf(spring, displacement).norm() / unit);
    }
    report.patches.push_back(answerOf(lattice_, shape.state, patch, raw));
    report.patches.back().displacement = meanDisplacement(patch, displacement);
    if (byForce(patch)) {
      unbalanced = std::max(unbalanced, finest().group_force[index].template head<3>().norm());
    }
  }
  for (const auto& values : finest().force) {
    for (const Real value : values) {
      unbalanced = std::max(unbalanced, std::abs(static_cast<double>(value)));
    }
  }
  held = std::max(held, kStill);  // what no force holds is off by rounding alone
  report.residual = unbalanced / held;
  for (int node = 0; has_seeds_ && node < static_cast<int>(displacement.size()); ++node) {
    const std::array<int, 3> place = finest().placeOf(levels_->entryOf(node));
    const bool moves = hold.held()[at(node)] != kAllHeld || hold.carriers()[at(node)] >= 0;
    if (moves && finest().box().has(place)) ++report.active_nodes;
  }
  for (std::size_t axis = 0; has_seeds_ && axis < 3; ++axis) {
    report.layers = std::max({report.layers, seeds_.low[axis] - finest().box().low[axis],
                              finest().box().high[axis] - seeds_.high[axis]});
  }
}

}  // namespace

std::unique_ptr<LayeredCourse> makeLayeredCourse(const Lattice& lattice, const ElasticModel& model,
                                                 const LayeredOptions& options) {
  if (options.tolerance >= kSinglePrecision) {
    return std::make_unique<CourseIn<float>>(lattice, model, options);
  }
  return std::make_unique<CourseIn<double>>(lattice, model, options);
}

}  // namespace robot_tissue
