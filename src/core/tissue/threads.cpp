#include "tissue/threads.h"

#include <algorithm>
#include <cmath>

#include "surface/held_surface.h"
#include "surface/nearest_point.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

void addNodes(const SutureThread& thread, std::vector<int>& nodes) {
  for (const SutureThread::End* end : {&thread.from, &thread.to}) {
    for (const NodeWeight& carrier : end->carriers) nodes.push_back(carrier.node);
  }
}

// On `from` (N): along the way, as much as its tension.
Vec3 pullOf(const SutureThread& thread, const std::vector<Vec3>& displacement) {
  return -forceOf(springOf(thread), displacement);
}

}  // namespace

bool Threads::anyWhole() const {
  return std::any_of(threads_.begin(), threads_.end(),
                     [](const SutureThread& thread) { return !thread.broken; });
}

bool Threads::has(const std::string& name) const {
  return std::any_of(threads_.begin(), threads_.end(),
                     [&](const SutureThread& thread) { return thread.name == name; });
}

std::vector<std::string> Threads::whole() const {
  std::vector<std::string> names;
  for (const SutureThread& thread : threads_) {
    if (!thread.broken) names.push_back(thread.name);
  }
  return names;
}

void Threads::mend(const std::vector<std::string>& names) {
  for (SutureThread& thread : threads_) {
    if (std::find(names.begin(), names.end(), thread.name) != names.end()) thread.broken = false;
  }
}

LoadingPatch Threads::patch() const {
  LoadingPatch patch;
  patch.name = "threads of sutures";
  std::vector<ContactSpring> springs = fronts_;
  for (const SutureThread& thread : threads_) {
    if (!thread.broken) springs.push_back(springOf(thread));
  }
  patch.contacts = ContactSprings(std::move(springs));
  return patch;
}

std::vector<int> Threads::nodes() const {
  std::vector<int> nodes;
  for (const SutureThread& thread : threads_) {
    if (!thread.broken) addNodes(thread, nodes);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

Vec3 Threads::forceOn(int node, const std::vector<Vec3>& displacement) const {
  Vec3 force = Vec3::Zero();
  const auto add = [&](const ContactSpring& spring) {
    for (const NodeWeight& carrier : spring.carriers) {
      if (carrier.node == node) force += carrier.weight * forceOf(spring, displacement);
    }
  };
  for (const ContactSpring& tie : fronts_) add(tie);
  for (const SutureThread& thread : threads_) {
    if (!thread.broken) add(springOf(thread));
  }
  return force;
}

void Threads::loosen(const std::vector<Vec3>& displacement) {
  for (SutureThread& thread : threads_) {
    if (thread.broken) continue;
    const double now =
        (placeOf(thread.to, displacement) - placeOf(thread.from, displacement)).norm();
    thread.length = std::max(thread.rest_length, now);
  }
}

void Threads::drawIn(double share) {
  for (SutureThread& thread : threads_) {
    if (thread.length <= thread.rest_length) continue;
    thread.length = share < 1.0 ? thread.length - share * (thread.length - thread.rest_length)
                                : thread.rest_length;
  }
}

double Threads::wayLeft() const {
  double way = 0.0;
  for (const SutureThread& thread : threads_) {
    if (!thread.broken) way = std::max(way, thread.length - thread.rest_length);
  }
  return way;
}

void Threads::soften(const std::function<double(int node)>& stiffness,
                     const std::vector<Vec3>& displacement) {
  for (SutureThread& thread : threads_) {
    if (thread.broken) continue;
    std::vector<int> nodes;
    addNodes(thread, nodes);
    double most = 0.0;
    for (const int node : nodes) most = std::max(most, stiffness(node));
    const Vec3 pull = pullOf(thread, displacement);
    thread.softness = most > 0.0 ? std::max(0.0, 1.0 / most - 1.0 / thread.stiffness) : 0.0;
    thread.offset = thread.softness * pull;
  }
}

bool Threads::harden(const std::vector<Vec3>& displacement) {
  bool changes = false;
  for (SutureThread& thread : threads_) {
    const bool was_soft = !thread.broken && thread.softness > 0.0;
    changes = changes || (was_soft && tensionOf(springOf(thread), displacement) > 0.0);
    thread.softness = 0.0;
    thread.offset.setZero();
    thread.length = thread.rest_length;
    changes = changes || (was_soft && tensionOf(springOf(thread), displacement) > 0.0);
  }
  return changes;
}

// A pull T stretches a soft thread by T (1 / k + softness), where it should be by T / k.
double Threads::correct(const std::vector<Vec3>& displacement) {
  double change = 0.0;
  for (SutureThread& thread : threads_) {
    if (thread.broken || thread.softness <= 0.0) continue;
    const Vec3 before = thread.offset;
    thread.offset = thread.softness * pullOf(thread, displacement);
    change = std::max(change, (thread.offset - before).norm());
  }
  return change;
}

// The one that is farthest over its break force.
std::optional<std::size_t> Threads::weakest(const std::vector<Vec3>& displacement) const {
  std::optional<std::size_t> weakest;
  double most = 1.0;  // tension over break force
  for (std::size_t i = 0; i < threads_.size(); ++i) {
    const SutureThread& thread = threads_[i];
    if (thread.broken || thread.break_force <= 0.0) continue;
    const double over = tensionOf(springOf(thread), displacement) / thread.break_force;
    if (over <= most) continue;
    most = over;
    weakest = i;
  }
  return weakest;
}

bool Threads::isOneOver(const std::vector<Vec3>& displacement) const {
  return weakest(displacement).has_value();
}

std::vector<int> Threads::breakOne(const std::vector<Vec3>& displacement) {
  const std::optional<std::size_t> number = weakest(displacement);
  std::vector<int> nodes;
  if (!number) return nodes;
  threads_[*number].broken = true;
  addNodes(threads_[*number], nodes);
  return nodes;
}

bool bindEnd(const TissueSurface& surface, double spacing, double bite, SutureThread::End& end) {
  const auto nearest = nearestAtRest(surface, end.rest, tuning::kSameDistance * spacing, end.inside,
                                     tuning::kInnerDepth * spacing);
  if (!nearest || nearest->distance > tuning::kFarthestFromEnd * spacing) return false;
  if (nearest->distance > tuning::kSameDistance * spacing) end.rest = restOf(surface, nearest->on);
  end.carriers.clear();
  end.to_middle.setZero();
  if (bite > 0.0) {
    HeldSurface held = heldAround(surface, nearest->on, bite);
    end.carriers = std::move(held.carriers);
    if (!end.carriers.empty()) end.to_middle = held.middle - end.rest;
  }
  if (end.carriers.empty()) end.carriers = carriersAt(surface, nearest->on);
  return true;
}

std::vector<int> Threads::rebind(const TissueSurface& surface, double spacing) {
  std::vector<int> left;
  const auto is_lost = [&](SutureThread& thread) {
    const SutureThread before = thread;
    if (bindEnd(surface, spacing, thread.bite, thread.from) &&
        bindEnd(surface, spacing, thread.bite, thread.to)) {
      return false;
    }
    addNodes(before, left);
    return true;
  };
  threads_.erase(std::remove_if(threads_.begin(), threads_.end(), is_lost), threads_.end());
  return left;
}

}  // namespace robot_tissue
