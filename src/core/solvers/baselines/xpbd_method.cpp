#include "solvers/baselines/xpbd_method.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simd/field_kernel.h"
#include "solvers/baselines/soa_field.h"
#include "solvers/baselines/tuning.h"

namespace robot_tissue {
namespace {

// Spare arrays of the field: the shape before the step, mobilities, the shape when the step was
// last shortened.
constexpr int kSweepStart = kOfMethod, kMobility = kOfMethod + 1, kShortened = kOfMethod + 2;

}  // namespace

XpbdMethod::XpbdMethod(const Lattice& lattice, const ElasticModel& model,
                       const RelaxationOptions& options)
    : RelaxationMethod(lattice, model, options, TimeSteps::kGoneThrough) {}

void XpbdMethod::weigh() {
  weight_.assign(shape_.state.displacement.size(), Vec3::Zero());
  for (const Cell& cell : shape_.state.cells->all()) {
    for (int corner = 0; corner < kCorners; ++corner) {
      weight_[at(cell.nodes[at(corner)])] += model_.cornerWeight(cell, corner);
    }
  }
}

void XpbdMethod::begin(int care) {
  refinements_ = 0;
  damping_ = 0.0;
  weigh();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* now = field_->moved()[axis];
    std::copy(now, now + field_->size(), field_->spare(kSweepStart)[axis]);
  }
  takeStep(std::pow(tuning::kShorter, care) *
           std::min(tuning::kFirstStretch * options_.tolerance, tuning::kMostStretch));
}

// Velocity that is kept from step to step for critical damping of the slowest wave: with the
// frequency s a step, ((1 - s) / (1 + s))^2.
void XpbdMethod::takeStep(double stretch) {
  stretch_ = stretch;
  sweeps_ = 0;
  offered_ = false;
  const double share = std::sqrt(stretch * slowestWave());
  keep_ = std::pow((1.0 - share) / (1.0 + share), 2);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float* mobility = field_->spare(kMobility)[axis];
    const float* now = field_->moved()[axis];
    for (int slot = 0; slot < field_->size(); ++slot) {
      mobility[slot] =
          static_cast<float>(stretch) * field_->compliance()[slot] * field_->free()[axis][slot];
    }
    std::copy(now, now + field_->size(), field_->spare(kShortened)[axis]);
  }
}

void XpbdMethod::iterate() {
  coast();
  pushPatches();
  field_->project(field_->spare(kMobility), nullptr);
  projectOddCells();
  projectRims();
  projectContacts();
}

// Inertia and gravity: moved += keep (moved - before) + mobility weight.
void XpbdMethod::coast() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    robot_tissue::coast(static_cast<float>(keep_), field_->size(), field_->free()[axis],
                        field_->spare(kSweepStart)[axis], field_->moved()[axis]);
  }
  for (std::size_t node = 0; node < weight_.size(); ++node) {
    if (!weight_[node].isZero(0.0)) push(static_cast<int>(node), weight_[node], 1.0);
  }
}

// Patches by force have no mass here: each goes to where its forces balance while the nodes around
// it stand.
void XpbdMethod::pushPatches() {
  for (std::size_t index = 0; index < shape_.patches.size(); ++index) {
    if (!byForce(shape_.patches[index])) continue;
    field_->giveWatched(shape_.state);
    patch_forces_[index] = hold_.forceOn(shape_, index);
    movePatchBy(index, patchAnswer(index));
  }
}

// A constraint C = sqrt(2 E) of compliance 1 (XPBD, equation 18): dx = m f / (1 + sum of m f^2 / 2
// E), f = -dE/dx the force on a node and m its mobility; damped as projectBlock.
void XpbdMethod::projectOddCells() {
  for (const int index : field_->oddCells()) {
    const Cell& cell = shape_.state.cells->all()[at(index)];
    const std::array<int, kMostReached> nodes = reachedNodes(cell);
    for (const int node : nodes) {
      if (node >= 0) field_->giveAll(node, shape_.state);
    }
    const ElasticCell shaped = model_.shaped(shape_.state, cell);
    const double energy = shaped.energy();
    if (!(energy > 0.0)) continue;
    std::array<Vec3, kMostReached> forces, answers;
    double answer = 0.0, rate = 0.0;
    for (int corner = 0; corner < shaped.nodeCount(); ++corner) {
      const int node = nodes[at(corner)];
      if (node < 0) continue;
      forces[at(corner)] = -shaped.gradient(corner);
      answers[at(corner)] = mobilityOf(node).cwiseProduct(forces[at(corner)]);
      answer += answers[at(corner)].dot(forces[at(corner)]);
      if (damping_ > 0.0) rate += damping_ * forces[at(corner)].dot(wayOf(node));
    }
    answer *= 1.0 + damping_;
    const double share = (1.0 - rate / (2.0 * energy)) / (1.0 + answer / (2.0 * energy));
    for (int corner = 0; corner < shaped.nodeCount(); ++corner) {
      if (nodes[at(corner)] >= 0) move(nodes[at(corner)], share * answers[at(corner)]);
    }
  }
}

void XpbdMethod::projectRims() {
  for (const LoadingPatch& patch : shape_.patches) {
    for (const RimSpring& spring : patch.rim) {
      field_->giveAll(spring.node, shape_.state);
      const Vec3 stretch = spring.anchor - shape_.state.displacement[at(spring.node)];
      const Vec3 force = stiffnessOf(patch, spring) * stretch;
      const double energy = 0.5 * force.dot(stretch);
      if (!(energy > 0.0)) continue;
      const double answer = mobilityOf(spring.node).dot(force.cwiseAbs2());
      push(spring.node, force, 1.0 / (1.0 + answer / (2.0 * energy)));
    }
  }
}

void XpbdMethod::projectContacts() {
  for (const LoadingPatch& patch : shape_.patches) {
    for (const ContactSpring& spring : patch.contacts) {
      for (const NodeWeight& carrier : spring.carriers) {
        field_->giveAll(carrier.node, shape_.state);
      }
      const double energy = energyOf(spring, shape_.state.displacement);
      if (!(energy > 0.0)) continue;
      const Vec3 force = forceOf(spring, shape_.state.displacement);
      double answer = 0.0;
      for (const NodeWeight& carrier : spring.carriers) {
        const Vec3 share = carrier.weight * force;
        answer += mobilityOf(carrier.node).dot(share.cwiseAbs2());
      }
      const double share = 1.0 / (1.0 + answer / (2.0 * energy));
      for (const NodeWeight& carrier : spring.carriers) {
        push(carrier.node, carrier.weight * force, share);
      }
    }
  }
}

// Since the small step's start (m).
Vec3 XpbdMethod::wayOf(int node) const {
  Vec3 way;
  for (int axis = 0; axis < 3; ++axis) {
    const int slot = field_->slotOf(node);
    way[axis] = static_cast<double>(field_->moved()[at(axis)][slot] -
                                    field_->spare(kShortened)[at(axis)][slot]);
  }
  return field_->unit() * way;
}

// Of the shortest time that a node takes to answer alone, (m / k)^(1/2): the root of what the
// tolerance lets the small steps end off (s).
double XpbdMethod::smallStep(const std::vector<double>& masses) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t node = 0; node < masses.size(); ++node) {
    const double stiffness = model_.nodeStiffness(shape_.state, static_cast<int>(node)).mean();
    if (stiffness > 0.0 && masses[node] > 0.0) least = std::min(least, masses[node] / stiffness);
  }
  const double stretch =
      std::min(tuning::kStretchInTime * options_.tolerance, tuning::kMostStretch);
  return std::sqrt(stretch * least);
}

// Places and velocities are kept in double precision: what a small step adds to a far place is less
// than single precision tells.
SolveStatus XpbdMethod::goThrough(int& steps) {
  const InertialTerm& term = *model_.inertia();
  const std::vector<double> masses = model_.nodeMasses(*shape_.state.cells);
  std::vector<Vec3>& place = shape_.state.displacement;
  const std::vector<Vec3> end = place;
  for (std::size_t node = 0; node < place.size(); ++node) {
    place[node] = term.free_motion[node] - term.duration * term.velocity[node];
  }
  const std::vector<Vec3> before = place;
  velocity_ = term.velocity;
  weigh();
  const double count = std::max(1.0, std::ceil(term.duration / smallStep(masses)));
  if (count <= mostIterations()) {
    steps = static_cast<int>(count);
    ContactPassage contacts(shape_);
    for (int step = 1; step <= steps; ++step) {
      for (std::size_t node = 0; node < place.size(); ++node) {  // what is held goes evenly
        const Vec3 held = before[node] + (step / count) * (end[node] - before[node]);
        if (hold_.carrierOf(node) >= 0) continue;
        place[node] = held + hold_.freePart(static_cast<int>(node), place[node] - held);
      }
      makeSmallStep({term.duration / count, step / count, 1.0 / count, term.damping_time}, masses,
                    contacts);
      if (isLate() && step < steps) return SolveStatus::kLate;
    }
    for (std::size_t node = 0; node < place.size(); ++node) {
      const Vec3 held = (place[node] - before[node]) / term.duration;
      velocity_[node] = held + hold_.freePart(static_cast<int>(node), velocity_[node] - held);
    }
    if (std::all_of(place.begin(), place.end(), [](const Vec3& p) { return p.allFinite(); })) {
      contacts.tellMeans();
      return SolveStatus::kOk;
    }
  }
  velocity_.assign(place.size(), Vec3::Zero());
  place = before;
  field_->takeAll(shape_.state);
  return SolveStatus::kUnconverged;
}

void XpbdMethod::makeSmallStep(const SmallStep& step, const std::vector<double>& masses,
                               ContactPassage& contacts) {
  predict(step.duration, masses);
  damping_ = step.damping_time / step.duration;
  const SoaField::Arrays& start = field_->spare(kShortened);
  const SoaDamping damping{static_cast<float>(damping_), {start[0], start[1], start[2]}};
  pushPatches();
  field_->project(field_->spare(kMobility), damping_ > 0.0 ? &damping : nullptr);
  const std::vector<Vec3> predicted = shape_.state.displacement;  // what follows rounds it
  projectOddCells();
  projectRims();
  projectContacts();
  pushTouches(contacts, {step.end, step.share});
  for (std::size_t node = 0; node < predicted.size(); ++node) {
    const int index = static_cast<int>(node), slot = field_->slotOf(index);
    if (hold_.carrierOf(node) >= 0) continue;
    Vec3 pushed;
    for (int axis = 0; axis < 3; ++axis) {
      pushed[axis] = static_cast<double>(field_->moved()[at(axis)][slot] -
                                         field_->spare(kSweepStart)[at(axis)][slot]);
    }
    pushed = hold_.freePart(index, field_->unit() * pushed);
    shape_.state.displacement[node] = predicted[node] + pushed;
    velocity_[node] += pushed / step.duration;
  }
}

void XpbdMethod::pushTouches(ContactPassage& contacts, const ContactPassage::SmallStep& step) {
  const auto push_node = [this](int node, const Vec3& force) {
    push(node, force, 1.0);
    field_->giveAll(node, shape_.state);
  };
  for (const int node : hold_.touched()) field_->giveAll(node, shape_.state);
  contacts.push(
      step, [this](int node) { return mobilityOf(node); }, push_node);
}

void XpbdMethod::keepPlaces(int spare) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* now = field_->moved()[axis];
    std::copy(now, now + field_->size(), field_->spare(spare)[axis]);
  }
}

// Where inertia and gravity alone lead.
void XpbdMethod::predict(double step, const std::vector<double>& masses) {
  field_->takeAll(shape_.state);
  keepPlaces(kShortened);
  for (std::size_t node = 0; node < masses.size(); ++node) {
    if (masses[node] <= 0.0) continue;
    const int index = static_cast<int>(node), slot = field_->slotOf(index);
    velocity_[node] += step / masses[node] * hold_.freePart(index, weight_[node]);
    shape_.state.displacement[node] += step * hold_.freePart(index, velocity_[node]);
    const double mobility = field_->stiffnessUnit() * step * step / masses[node];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      field_->spare(kMobility)[axis][slot] =
          static_cast<float>(mobility) * field_->free()[axis][slot];
    }
  }
  field_->takeAll(shape_.state);
  field_->findSqueezed();
  keepPlaces(kSweepStart);
}

// Square of the time step over mass, per axis (m/N); 0 where it is held.
Vec3 XpbdMethod::mobilityOf(int node) const {
  Vec3 mobility;
  for (int axis = 0; axis < 3; ++axis) {
    mobility[axis] = static_cast<double>(field_->spare(kMobility)[at(axis)][field_->slotOf(node)]);
  }
  return mobility / field_->stiffnessUnit();
}

void XpbdMethod::push(int node, const Vec3& force, double share) {
  move(node, share * mobilityOf(node).cwiseProduct(force));
}

void XpbdMethod::move(int node, const Vec3& motion) {
  const int slot = field_->slotOf(node);
  for (int axis = 0; axis < 3; ++axis) {
    field_->moved()[at(axis)][slot] += static_cast<float>(motion[axis] / field_->unit());
  }
}

// The shape that the steps go to is off by about c t, t the square of the time step (stretch_).
// From t to q t it moved by `way`, so q / (1 - q) `way` is what is still off: added to what is left
// to go. Said to be near once for each t; when the caller's look at forces does not agree, t gets
// shorter, as it does when little is left to go at this t. Nothing is judged before the slowest
// wave had time to move (sweeps times its frequency >= 1).
bool XpbdMethod::settles(double& to_go) {
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    squared +=
        squaredDistance(field_->moved()[axis], field_->spare(kShortened)[axis], field_->size());
  }
  const double way = field_->unit() * std::sqrt(squared);
  const double still = to_go;
  sweeps_ += stride();
  const double allowed = options_.tolerance * movedLength();
  if (refinements_ == 0) {
    to_go = std::numeric_limits<double>::infinity();
  } else {
    to_go += (way + still) * tuning::kShorter / (1.0 - tuning::kShorter);
  }
  if (sweeps_ * std::sqrt(stretch_ * slowestWave()) < 1.0) return false;
  const bool near = to_go <= allowed;
  if (near && !offered_) {
    offered_ = true;
    return true;
  }
  if ((!near && still > tuning::kSettled * std::max(way, allowed)) ||
      stretch_ <= tuning::kLeastStretch) {
    return false;
  }
  ++refinements_;
  takeStep(tuning::kShorter * stretch_);
  return false;
}

int XpbdMethod::usualIterations() const { return tuning::kUsualOfXpbd; }

// Of an error in the slowest wave, critically damped, a step leaves (1 - s) / (1 + s).
double XpbdMethod::shrinkage() const {
  const double share = std::sqrt(stretch_ * slowestWave());
  return (1.0 - share) / (1.0 + share);
}

}  // namespace robot_tissue
