#include "solvers/baselines/explicit_method.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/steady_numbers.h"
#include "solvers/baselines/soa_field.h"
#include "solvers/baselines/tuning.h"

namespace robot_tissue {
namespace {

// Spare arrays of the field. kSoftness: the first axis of it, for all three.
constexpr int kStart = kOfMethod, kVelocity = kOfMethod + 1, kLastForce = kOfMethod + 2,
              kSoftness = kOfMethod + 3;

}  // namespace

ExplicitMethod::ExplicitMethod(const Lattice& lattice, const ElasticModel& model,
                               const RelaxationOptions& options)
    : RelaxationMethod(lattice, model, options, TimeSteps::kGoneThrough) {}

void ExplicitMethod::forget() {
  RelaxationMethod::forget();
  cells_.reset();
}

void ExplicitMethod::measureContacts() {
  contact_stiffness_.assign(shape_.state.displacement.size(), 0.0);
  for (const LoadingPatch& patch : shape_.patches) {
    for (const ContactSpring& spring : patch.contacts) {
      for (const NodeWeight& carrier : spring.carriers) {
        contact_stiffness_[at(carrier.node)] +=
            endsOf(spring) * std::abs(carrier.weight) *
            (spring.stiffness + spring.friction_stiffness + spring.turning.norm());
      }
    }
  }
}

void ExplicitMethod::begin(int care) {
  patch_steps_.assign(shape_.patches.size(), {});
  measureContacts();
  weigh();
  findFastest();
  fastest_ = std::pow(tuning::kCare, care) * measured_;
  findForces();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float* velocity = field_->spare(kVelocity)[axis];
    std::fill(velocity, velocity + field_->size(), 0.0F);
    const float* force = field_->force()[axis];
    std::copy(force, force + field_->size(), field_->spare(kLastForce)[axis]);
  }
  slowest_ = fastest_;
  steps_ = 0;
}

void ExplicitMethod::iterate() {
  if (steps_ % tuning::kWeighings == 0 && steps_ > 0) weigh();
  if (steps_ > 0) findForces();
  ++steps_;
  const double share = std::sqrt(slowest_ / fastest_);
  const double keep = std::pow((1.0 - share) / (1.0 + share), 2);
  const double push = 4.0 / (fastest_ * std::pow(1.0 + share, 2));
  const double most = tuning::kMostStep * lattice_.spacing() / field_->unit();
  QuotientSums sums;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    roll(static_cast<float>(keep), static_cast<float>(push), static_cast<float>(most),
         field_->size(), field_->force()[axis], field_->spare(kSoftness)[0], field_->free()[axis],
         field_->spare(kLastForce)[axis], field_->spare(kVelocity)[axis], field_->moved()[axis],
         sums);
  }
  rollPatches(keep, push);
  if (sums.mass > 0.0 && sums.work > 0.0) {
    slowest_ = std::min(sums.work / sums.mass, fastest_);
  }
}

void ExplicitMethod::rollPatches(double keep, double push) {
  for (std::size_t index = 0; index < shape_.patches.size(); ++index) {
    if (!byForce(shape_.patches[index])) continue;
    const Motion::OfPatch answer = patchAnswer(index);
    Motion::OfPatch& step = patch_steps_[index];
    step.shift = keep * step.shift + push * answer.shift;
    step.turn = keep * step.turn + push * answer.turn;
    movePatchBy(index, step);
  }
}

// Masses, as their inverses (softness): the time step is 1, and a node's mass a bound of its
// stiffness in the present shape, the greatest row sum of its block, so that all are near the limit
// of stability.
void ExplicitMethod::weigh() {
  float* softness = field_->spare(kSoftness)[0];
  field_->giveWatched(shape_.state);
  field_->findSoftness(softness);
  for (const int node : field_->oddNodes()) {
    NodeBalance balance = model_.nodeBalance(shape_.state, node);
    hold_.addSprings(shape_, node, balance);
    const double stiffness =
        balance.block.cwiseAbs().rowwise().sum().maxCoeff() + contact_stiffness_[at(node)];
    softness[field_->slotOf(node)] =
        stiffness > 0.0 ? static_cast<float>(field_->stiffnessUnit() / stiffness) : 0.0F;
  }
}

// Greatest eigenvalue of stiffness over mass by power iterations about the present shape, from a
// random motion of sign +-; the shape is put back afterwards. Known where it was found for the same
// nodes.
void ExplicitMethod::findFastest() {
  if (cells_ == shape_.state.cells && held_ == hold_.dirichletMask()) return;
  cells_ = shape_.state.cells;
  held_ = hold_.dirichletMask();
  const int size = field_->size();
  const auto probe = static_cast<float>(tuning::kPowerProbe * lattice_.spacing() / field_->unit());
  findForces();
  SteadyNumbers random;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::copy(field_->moved()[axis], field_->moved()[axis] + size, field_->spare(kStart)[axis]);
    std::copy(field_->force()[axis], field_->force()[axis] + size, field_->spare(kLastForce)[axis]);
    for (int slot = 0; slot < size; ++slot) {
      const float sign = (random.next() >> 31U) != 0 ? probe : -probe;
      field_->spare(kVelocity)[axis][slot] = sign * field_->free()[axis][slot];
    }
  }
  for (int power = 0; power < tuning::kPowers; ++power) {
    const double eigenvalue = takePower();
    if (eigenvalue <= 0.0) break;
    measured_ = tuning::kMargin * eigenvalue;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* start = field_->spare(kStart)[axis];
    std::copy(start, start + size, field_->moved()[axis]);
  }
}

// One power iteration: v = M^-1 (f(x) - f(x + v)). Returns |v after| / |v before| in the masses'
// norm, 0 where there is no motion.
double ExplicitMethod::takePower() {
  const int size = field_->size();
  const float* softness = field_->spare(kSoftness)[0];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int slot = 0; slot < size; ++slot) {
      field_->moved()[axis][slot] =
          field_->spare(kStart)[axis][slot] + field_->spare(kVelocity)[axis][slot];
    }
  }
  findForces();
  double before = 0.0, after = 0.0;
  float greatest = 0.0F;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int slot = 0; slot < size; ++slot) {
      if (softness[slot] <= 0.0F) continue;
      float& motion = field_->spare(kVelocity)[axis][slot];
      before += static_cast<double>(motion * motion / softness[slot]);
      const float answer = field_->spare(kLastForce)[axis][slot] - field_->force()[axis][slot];
      motion = softness[slot] * answer * field_->free()[axis][slot];
      after += static_cast<double>(motion * motion / softness[slot]);
      greatest = std::max(greatest, std::abs(motion));
    }
  }
  if (!(before > 0.0 && after > 0.0)) return 0.0;
  const auto probe = static_cast<float>(tuning::kPowerProbe * lattice_.spacing() / field_->unit());
  for (float* motions : field_->spare(kVelocity)) {
    for (int slot = 0; slot < size; ++slot) motions[slot] *= probe / greatest;
  }
  return std::sqrt(after / before);
}

// Per node: N, m, m/s, kg.
struct ExplicitMethod::Passage {
  Passage(const InertialTerm& inertia, std::vector<double> node_masses, std::vector<Vec3> at_end,
          ConstrainedState& shape)
      : term(inertia),
        masses(std::move(node_masses)),
        before(shape.state.displacement),
        end(std::move(at_end)),
        contacts(shape) {}

  bool isDamped() const { return term.damping_time > 0.0; }

  const InertialTerm& term;
  std::vector<double> masses;
  std::vector<Vec3> before,
      end;  // of the time step; what is held goes evenly from one to the other
  std::vector<Vec3> force, elastic_before;
  double step = 0.0;  // s
  ContactPassage contacts;
};

SolveStatus ExplicitMethod::goThrough(int& steps) {
  const InertialTerm& term = *model_.inertia();
  std::vector<Vec3>& place = shape_.state.displacement;
  const std::vector<Vec3> end = place;
  for (std::size_t node = 0; node < place.size(); ++node) {
    place[node] = term.free_motion[node] - term.duration * term.velocity[node];
  }
  Passage passage(term, model_.nodeMasses(*shape_.state.cells), end, shape_);
  field_->takeAll(shape_.state);
  field_->findSqueezed();
  measureContacts();
  weigh();
  findFastest();
  fastest_ = measured_;
  const double longest = longestStableStep(passage.masses, passage.term.damping_time);
  const double count = std::max(1.0, std::ceil(term.duration / longest));
  SolveStatus status = SolveStatus::kUnconverged;
  if (count <= mostIterations()) {
    steps = static_cast<int>(count);
    passage.step = term.duration / count;
    status = pass(passage, steps);
  }
  if (status != SolveStatus::kUnconverged) return status;
  velocity_.assign(place.size(), Vec3::Zero());
  place = passage.before;
  field_->takeAll(shape_.state);
  return status;
}

SolveStatus ExplicitMethod::pass(Passage& passage, int steps) {
  std::vector<Vec3>& place = shape_.state.displacement;
  velocity_ = passage.term.velocity;
  if (passage.isDamped()) {  // forces a step ago
    for (std::size_t node = 0; node < place.size(); ++node) {
      place[node] -= passage.step * velocity_[node];
    }
    field_->takeAll(shape_.state);
    findForcesOn(passage);
    place = passage.before;
    field_->takeAll(shape_.state);
  }
  findForcesOn(passage);
  accelerate(passage, 0.5 * passage.step);
  for (int step = 1; step <= steps; ++step) {
    const double share = static_cast<double>(step) / steps;
    for (std::size_t node = 0; node < place.size(); ++node) {
      const int index = static_cast<int>(node);
      const Vec3 held = passage.before[node] + share * (passage.end[node] - passage.before[node]);
      const Vec3 free = place[node] + passage.step * velocity_[node];
      if (hold_.carrierOf(node) >= 0) continue;  // moved with its patch
      place[node] = held + hold_.freePart(index, free - held);
    }
    pushTouches(passage, {share, 1.0 / steps});
    field_->takeAll(shape_.state);
    if (step % tuning::kWeighings == 0) field_->findSqueezed();
    findForcesOn(passage);
    accelerate(passage, step < steps ? passage.step : 0.5 * passage.step);
    if (isLate() && step < steps) return SolveStatus::kLate;
  }
  for (std::size_t node = 0; node < place.size(); ++node) {
    if (!place[node].allFinite()) return SolveStatus::kUnconverged;
    const int index = static_cast<int>(node);
    const Vec3 held = (place[node] - passage.before[node]) / passage.term.duration;
    velocity_[node] = held + hold_.freePart(index, velocity_[node] - held);
  }
  passage.contacts.tellMeans();
  return SolveStatus::kOk;
}

// Stress is elastic and damping_time times its rate, as the last step had it. Patches by force have
// no mass: they go to where their forces balance while the nodes around them stand.
void ExplicitMethod::findForcesOn(Passage& passage) {
  RelaxationMethod::findForces();
  for (std::size_t index = 0; index < shape_.patches.size(); ++index) {
    if (byForce(shape_.patches[index])) movePatchBy(index, patchAnswer(index));
  }
  const std::vector<Vec3>& place = shape_.state.displacement;
  passage.force.resize(place.size());
  for (std::size_t node = 0; node < place.size(); ++node) {
    passage.force[node] = field_->forceOn(static_cast<int>(node));
  }
  if (!passage.isDamped()) return;
  std::vector<Vec3> of_threads(place.size(), Vec3::Zero());
  for (const LoadingPatch& patch : shape_.patches) addContactForces(patch, place, of_threads);
  const bool first = passage.elastic_before.empty();
  passage.elastic_before.resize(place.size());
  for (std::size_t node = 0; node < place.size(); ++node) {
    const Vec3 elastic = passage.force[node] - of_threads[node];
    const Vec3 rate = (elastic - passage.elastic_before[node]) / passage.step;
    if (!first) passage.force[node] += passage.term.damping_time * rate;
    passage.elastic_before[node] = elastic;
  }
}

void ExplicitMethod::pushTouches(Passage& passage, const ContactPassage::SmallStep& step) {
  const auto mobility = [&](int node) -> Vec3 {
    const double mass = passage.masses[at(node)];
    if (mass <= 0.0 || hold_.carrierOf(at(node)) >= 0) return Vec3::Zero();
    return hold_.freePart(node, Vec3::Constant(passage.step * passage.step / mass));
  };
  const auto push = [&](int node, const Vec3& force) {
    const Vec3 motion = mobility(node).cwiseProduct(force);
    shape_.state.displacement[at(node)] += motion;
    velocity_[at(node)] += motion / passage.step;
  };
  passage.contacts.push(step, mobility, push);
}

void ExplicitMethod::accelerate(Passage& passage, double step) {
  for (std::size_t node = 0; node < velocity_.size(); ++node) {
    if (passage.masses[node] <= 0.0) continue;
    const Vec3 force = hold_.freePart(static_cast<int>(node), passage.force[node]);
    velocity_[node] += step / passage.masses[node] * force;
  }
}

// Of no frequency that nodes' stiffness over their masses, and the greatest eigenvalue of stiffness
// over masses that are the nodes' stiffness, allow (s).
double ExplicitMethod::longestStableStep(const std::vector<double>& masses,
                                         double damping_time) const {
  double greatest = 0.0;
  for (std::size_t node = 0; node < masses.size(); ++node) {
    const int slot = field_->slotOf(static_cast<int>(node));
    const double softness = static_cast<double>(field_->spare(kSoftness)[0][slot]);
    if (softness <= 0.0 || masses[node] <= 0.0) continue;
    greatest = std::max(greatest, field_->stiffnessUnit() / softness / masses[node]);
  }
  const double frequency = std::sqrt(fastest_ * greatest);
  if (!(frequency > 0.0)) return std::numeric_limits<double>::infinity();
  const double damping = 0.5 * damping_time * frequency;
  return tuning::kOfStable * 2.0 / frequency * (std::sqrt(1.0 + damping * damping) - damping);
}

int ExplicitMethod::usualIterations() const { return tuning::kUsualOfExplicit; }

// Of an error in the slowest wave a step leaves (1 - s) / (1 + s), s its frequency a step where the
// damping is critical for it. Damped for a faster one, that the motion shows, s is less in
// proportion.
double ExplicitMethod::shrinkage() const {
  const double slowest = std::sqrt(slowestWave() / fastest_);
  const double share = slowest * std::min(1.0, slowest / std::sqrt(slowest_ / fastest_));
  return std::max((1.0 - share) / (1.0 + share), 0.5);
}

}  // namespace robot_tissue
