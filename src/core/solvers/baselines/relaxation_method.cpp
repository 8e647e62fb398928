#include "solvers/baselines/relaxation_method.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "simd/field_kernel.h"
#include "solvers/baselines/node_step.h"
#include "solvers/baselines/soa_field.h"
#include "solvers/baselines/tuning.h"

namespace robot_tissue {

// The state of one solve. A look compares the shape with that of the look before, stride()
// iterations ago. Lengths are L2 over the free nodes (m).
struct RelaxationMethod::Course {
  int iterations = 0;
  int looks = 0;
  std::vector<double> ways;  // from look to look, the last ones
  double error = 1.0;        // error_estimate
  double least = kInfinity;  // correctionNorm of the best shape
  int best_look = 0;
  std::vector<LoadingPatch> best_patches;
  int care = 0;  // how often forces grew tenfold, or did not fall: begin() goes on with care
  bool stalled =
      false;  // no look has been better for long, and the method cannot do with more care
};

RelaxationMethod::RelaxationMethod(const Lattice& lattice, const ElasticModel& model,
                                   const RelaxationOptions& options, TimeSteps time_steps)
    : lattice_(lattice),
      model_(model),
      options_(options),
      hold_(lattice, model),
      field_(std::make_unique<SoaField>(lattice, model,
                                        time_steps == TimeSteps::kSolved
                                            ? SoaField::Inertia::kOfTimeSteps
                                            : SoaField::Inertia::kNone)),
      time_steps_(time_steps) {
  const double count = static_cast<double>(lattice.cells().size());
  const double volume = std::pow(lattice.spacing(), 3);
  double softness = 0.0;
  for (const Cell& cell : lattice.cells()) {
    const Moduli moduli = model.cellModuli(cell);
    mean_.shear += moduli.shear / count;
    mean_.bulk += moduli.bulk / count;
    softness += cell.stiffnessShare() / moduli.shear / count;
    for (int corner = 0; corner < kCorners; ++corner) {
      mean_density_ += model.cornerMass(cell, corner) / (count * volume);
    }
  }
  soft_shear_ = 1.0 / softness;
}

RelaxationMethod::~RelaxationMethod() = default;

double RelaxationMethod::patchStep() const { return options_.patch_step * lattice_.spacing(); }

void RelaxationMethod::forget() { left_.clear(); }

SolveReport RelaxationMethod::solve(std::vector<LoadingPatch>& patches, const std::vector<int>&,
                                    LatticeState& state) {
  clock_.start();
  SolveReport report;
  Course course;
  shape_ = {state, patches};
  hold_.bind(shape_);
  hold_.place(shape_);
  field_->bind(shape_, hold_);
  measurePatches();
  findDepth();
  findWave();
  const bool goes_through = model_.inertia() != nullptr && time_steps_ == TimeSteps::kGoneThrough;
  report.status = goes_through ? goThrough(course.iterations) : run(course);
  if (goes_through && report.status == SolveStatus::kUnconverged) shape_.patches = patches;
  if (goes_through) course.error = 0.0;
  if (course.iterations > 0) field_->give(shape_.state);
  findForces();
  left_ = shape_.state.displacement;
  if (model_.inertia() != nullptr) left_.clear();  // at rest it has another balance
  left_length_ = correctionNorm();
  left_error_ = course.error;
  describe(course, report);
  state = std::move(shape_.state);
  patches = std::move(shape_.patches);
  report.wall_ms = clock_.elapsedMs();
  return report;
}

SolveStatus RelaxationMethod::run(Course& course) {
  findForces();
  keep(course);
  const bool as_left = model_.inertia() == nullptr && shape_.state.displacement == left_ &&
                       course.least <= tuning::kSame * left_length_;
  if (as_left) course.error = left_error_;
  if (isRounding(course.least)) course.error = std::min(relative(course.least), options_.tolerance);
  if (course.error <= options_.tolerance) return SolveStatus::kOk;
  seen_wave_ = 1.0;
  begin(course.care);
  wayFromMark();
  findForces();
  lookAtWave(WaveLook::kFirst);
  while (course.care <= tuning::kMostCare && !course.stalled &&
         course.iterations < mostIterations()) {
    iterate();
    ++course.iterations;
    if (course.iterations % stride() == 0 && look(course)) return SolveStatus::kOk;
    if (!isLate()) continue;
    findForces();
    if (!std::isfinite(correctionNorm())) goBack(course);
    return SolveStatus::kLate;
  }
  if (!course.stalled) goBack(course);
  return SolveStatus::kUnconverged;
}

// Whether the shape is near enough: how far it still goes (lengthToGo) and the motion that would
// balance each node alone (correctionNorm) are both within the tolerance. Forces, which cost as
// much as an iteration, are looked at when the first is, or every kLooksApart looks.
bool RelaxationMethod::look(Course& course) {
  ++course.looks;
  const double way = wayFromMark();
  course.ways.push_back(way);
  double to_go = lengthToGo(course.ways);
  const bool settled = settles(to_go);
  course.error = std::min(relative(to_go), 1.0);
  const bool near = course.error <= options_.tolerance;
  if (std::isfinite(way) && !near && course.looks % tuning::kLooksApart != 0) return false;
  const bool surprised = std::isfinite(way) && field_->findSqueezed();
  findForces();
  lookAtWave(course.ways.size() < 2 ? WaveLook::kFirst : WaveLook::kAgain);
  if (near) course.error = std::min(relative(lengthToGo(course.ways)), 1.0);
  const double left = correctionNorm();
  if (left < course.least) keep(course);
  const bool stuck = course.looks - course.best_look > tuning::kPatience;
  if (stuck && !balances()) course.stalled = true;
  if (!(left <= tuning::kGrown * course.least) || (stuck && balances())) {
    goBack(course);
    course.best_look = course.looks;
    course.ways.clear();
    begin(++course.care);
    wayFromMark();
    return false;
  }
  course.error = std::max(course.error, relative(left));
  const bool tiny =
      movedLength() <= tuning::kTiny * lattice_.spacing() * std::sqrt(field_->nodeCount());
  if (tiny && isRounding(left)) course.error = std::min(relative(left), options_.tolerance);
  return course.error <= options_.tolerance && settled && !surprised;
}

// What is left to go if each way is q times the one before: last * q / (1 - q). q is the greater of
// the last ratio and the geometric mean of the last two; and no less than a share of what the
// method's slowest wave leaves in the end, as early ways shrink faster than late ones.
double RelaxationMethod::lengthToGo(const std::vector<double>& ways) const {
  const std::size_t count = ways.size();
  const double last = ways.back();
  if (last == 0.0) return 0.0;
  if (count < 3) return kInfinity;
  const double share = std::max(last / ways[count - 2], std::sqrt(last / ways[count - 3]));
  const double seen = share < 1.0 ? share / (1.0 - share) : kInfinity;
  const double in_the_end = std::pow(shrinkage(), stride());
  return last * std::max(seen, tuning::kShareOfEnd * in_the_end / (1.0 - in_the_end));
}

void RelaxationMethod::findForces() {
  field_->giveWatched(shape_.state);
  field_->findForces(shape_.state);
  patch_forces_.assign(shape_.patches.size(), {});
  std::vector<Vec3>& forces = scratch_;
  forces.resize(shape_.state.displacement.size(), Vec3::Zero());
  for (std::size_t index = 0; index < shape_.patches.size(); ++index) {
    if (!byForce(shape_.patches[index])) continue;
    for (const int node : hold_.hardOf(index)) forces[at(node)] = field_->forceOn(node);
    patch_forces_[index] = hold_.forceOn(shape_, index, forces);
  }
  const std::vector<int>& touched = hold_.touched();
  if (touched.empty()) return;
  for (const int node : touched) forces[at(node)].setZero();
  for (const LoadingPatch& patch : shape_.patches) {
    addContactForces(patch, shape_.state.displacement, forces);
  }
  for (const int node : touched) field_->addForce(node, forces[at(node)]);
}

// L2 of the motions that would balance each node, and each patch by force, were all others to stand
// (m).
double RelaxationMethod::correctionNorm() const {
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    squared += squaredProduct(field_->force()[axis], field_->free()[axis], field_->compliance(),
                              field_->size());
  }
  squared *= field_->unit() * field_->unit();
  for (std::size_t patch = 0; patch < shape_.patches.size(); ++patch) {
    if (!byForce(shape_.patches[patch])) continue;
    // One of rim springs alone, as on a node, has no hard node.
    const double nodes = static_cast<double>(std::max<std::size_t>(1, hold_.hardOf(patch).size()));
    squared += nodes * patchAnswer(patch).shift.squaredNorm();
  }
  return std::sqrt(squared);
}

double RelaxationMethod::relative(double length) const {
  return length == 0.0 ? 0.0 : length / movedLength();
}

double RelaxationMethod::movedLength() const {
  if (model_.inertia() != nullptr) return std::max(wayByForces(), model_.inertia()->least_way);
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    squared += squaredProduct(field_->moved()[axis], field_->free()[axis], field_->free()[axis],
                              field_->size());
  }
  squared *= field_->unit() * field_->unit();
  for (std::size_t node = 0; node < hold_.dirichletMask().size(); ++node) {
    if (hold_.carrierOf(node) >= 0) squared += shape_.state.displacement[node].squaredNorm();
  }
  const double still = tuning::kStill * lattice_.spacing();
  return std::sqrt(std::max(squared, still * still * (field_->nodeCount() + 1.0)));
}

bool RelaxationMethod::isRounding(double length) const {
  return length <= tuning::kRounding * lattice_.spacing() * std::sqrt(field_->nodeCount());
}

// L2 of the nodes' way since this was last asked (m).
double RelaxationMethod::wayFromMark() {
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* now = field_->moved()[axis];
    float* mark = field_->spare(kMark)[axis];
    squared += squaredDistance(now, mark, field_->size());
    std::copy(now, now + field_->size(), mark);
  }
  return field_->unit() * std::sqrt(squared);
}

void RelaxationMethod::keep(Course& course) const {
  course.least = correctionNorm();
  course.best_look = course.looks;
  course.best_patches = shape_.patches;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* now = field_->moved()[axis];
    std::copy(now, now + field_->size(), field_->spare(kBest)[axis]);
  }
}

void RelaxationMethod::goBack(const Course& course) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* best = field_->spare(kBest)[axis];
    std::copy(best, best + field_->size(), field_->moved()[axis]);
  }
  field_->give(shape_.state);
  for (std::size_t index = 0; index < shape_.patches.size(); ++index) {
    shape_.patches[index] = course.best_patches[index];
    for (const int node : hold_.hardOf(index)) field_->giveAll(node, shape_.state);
  }
  field_->takeRims(shape_);
  field_->findSqueezed();
}

Motion::OfPatch RelaxationMethod::patchAnswer(std::size_t index) const {
  const bool turns = shape_.patches[index].turns;
  Eigen::VectorXd load(turns ? 6 : 3);
  load.head<3>() = patch_forces_[index].shift;
  if (turns) load.tail<3>() = patch_forces_[index].turn;
  const Eigen::VectorXd answer = answers_[index].ldlt().solve(load);
  Motion::OfPatch step;
  if (!answer.allFinite()) return step;
  step.shift = capped(answer.head<3>(), tuning::kPatchStep * lattice_.spacing());
  if (turns) step.turn = capped(answer.tail<3>(), tuning::kPatchTurn);
  return step;
}

void RelaxationMethod::movePatchBy(std::size_t index, const Motion::OfPatch& motion) {
  LoadingPatch& patch = shape_.patches[index];
  robot_tissue::movePatch(lattice_, patch, motion.shift, motion.turn, shape_.state);
  field_->take(shape_.state, hold_.hardOf(index));
  if (!patch.rim.empty()) field_->takeRims(shape_);
}

// Stiffness of each patch by force against its own motion while the other nodes stand: columns by
// forward differences of its force, made symmetric.
void RelaxationMethod::measurePatches() {
  answers_.assign(shape_.patches.size(), {});
  for (std::size_t index = 0; index < shape_.patches.size(); ++index) {
    if (!byForce(shape_.patches[index])) continue;
    const int size = shape_.patches[index].turns ? 6 : 3;
    const Motion::OfPatch here = hold_.forceOn(shape_, index);
    Eigen::MatrixXd stiffness(size, size);
    double reach = lattice_.spacing();
    for (const int node : shape_.patches[index].nodes) {
      reach = std::max(reach, hold_.armOf(shape_, index, node).norm());
    }
    for (int axis = 0; axis < size; ++axis) {
      const double probe = tuning::kPatchProbe * lattice_.spacing() / (axis < 3 ? 1.0 : reach);
      const Vec3 unit = probe * Vec3::Unit(axis % 3);
      ConstrainedState probed = shape_;
      robot_tissue::movePatch(lattice_, probed.patches[index], axis < 3 ? unit : Vec3(Vec3::Zero()),
                              axis < 3 ? Vec3(Vec3::Zero()) : unit, probed.state);
      const Motion::OfPatch there = hold_.forceOn(probed, index);
      stiffness.col(axis).head<3>() = (here.shift - there.shift) / probe;
      if (size == 6) stiffness.col(axis).tail<3>() = (here.turn - there.turn) / probe;
    }
    answers_[index] = 0.5 * (stiffness + stiffness.transpose());
  }
}

void RelaxationMethod::describe(const Course& course, SolveReport& report) {
  const LatticeState& state = shape_.state;
  report.iterations = course.iterations;
  report.error_estimate = std::isfinite(course.error) ? course.error : 1.0;
  report.active_nodes = field_->nodeCount();
  double held = 0.0, unbalanced = 0.0;
  std::vector<Vec3> forces(state.displacement.size(), Vec3::Zero());
  for (const LoadingPatch& patch : shape_.patches) {
    addContactForces(patch, state.displacement, forces);
  }
  for (std::size_t index = 0; index < shape_.patches.size(); ++index) {
    const LoadingPatch& patch = shape_.patches[index];
    for (const int node : hold_.hardOf(index)) {
      forces[at(node)] += model_.nodeForce(state, node);
      held = std::max(held, forces[at(node)].norm());
    }
    for (const RimSpring& spring : patch.rim) {
      const Vec3 stretch = spring.anchor - state.displacement[at(spring.node)];
      held = std::max(held, (stiffnessOf(patch, spring) * stretch).norm());
    }
    for (const ContactSpring& spring : patch.contacts) {
      held = std::max(held, forceOf(spring, state.displacement).norm());
    }
    report.patches.push_back(answerOf(lattice_, state, patch, onHardNodes(patch, forces)));
    unbalanced = std::max(unbalanced, patch_forces_[index].shift.norm());
  }
  for (std::size_t node = 0; node < state.displacement.size(); ++node) {
    const int index = static_cast<int>(node);
    const double force = hold_.freePart(index, field_->forceOn(index)).norm();
    unbalanced = std::max(unbalanced, force);
    held = std::max(held, tuning::kStill * lattice_.spacing() * field_->restStiffness(index));
  }
  if (held > 0.0) report.residual = unbalanced / held;
}

}  // namespace robot_tissue
