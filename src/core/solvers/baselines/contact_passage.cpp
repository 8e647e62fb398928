#include "solvers/baselines/contact_passage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace robot_tissue {
namespace {

// A spring of stiffness k with its dashpot, at a point that a force f moves by w f in the small
// step.
struct ImplicitSpring {
  double stiffness;  // k (N/m)
  double yielding;   // w (m/N)

  double dashpot() const {  // c / h (N/m): m = h^2 / w
    return yielding > 0.0 ? 2.0 * std::sqrt(stiffness / yielding) : 0.0;
  }
  // What they push with after that motion; before it the spring's is `force`, and the point's way
  // in the small step `way`.
  template <typename Force>
  Force push(const Force& force, const Force& way) const {
    return (force - dashpot() * way) / (1.0 + yielding * (stiffness + dashpot()));
  }
};

ContactSpring withoutForce(const ContactSpring& spring) {
  ContactSpring slack;
  slack.carriers = spring.carriers;
  slack.rest = spring.rest;
  slack.stiffness = std::numeric_limits<double>::min();
  return slack;
}

}  // namespace

ContactPassage::ContactPassage(ConstrainedState& shape) : shape_(shape) {
  for (std::size_t patch = 0; patch < shape_.patches.size(); ++patch) {
    springs_.push_back(shape_.patches[patch].contacts);
    std::vector<ContactSpring> all;
    for (std::size_t number = 0; number < springs_.back().size(); ++number) {
      const ContactSpring& spring = springs_.back()[number];
      all.push_back(spring.is_thread ? spring : withoutForce(spring));
      if (spring.is_thread) continue;
      touches_.push_back({patch, number, pointOf(spring, shape_.state.displacement)});
    }
    shape_.patches[patch].contacts = std::move(all);
  }
}

ContactPassage::~ContactPassage() {
  for (std::size_t patch = 0; patch < springs_.size(); ++patch) {
    shape_.patches[patch].contacts = springs_[patch];
  }
}

void ContactPassage::push(const SmallStep& step, const Mobility& mobility, const Push& push) {
  for (Touch& touch : touches_) {
    const ContactSpring& spring = springOf(touch);
    const Vec3 n = spring.normal, to_go = (1.0 - step.end) * spring.plane_way;
    const Vec3 point = pointOf(spring, shape_.state.displacement);
    const Vec3 way = point - step.end * spring.plane_way - touch.before;
    const Vec3 at_end = point + to_go;  // in the tool's frame at the end
    Vec3 yielding = Vec3::Zero();
    for (const NodeWeight& carrier : spring.carriers) {
      yielding += carrier.weight * carrier.weight * mobility(carrier.node);
    }
    const double along = n.dot(yielding.cwiseProduct(n));
    const ImplicitSpring normal{spring.stiffness, along};
    const double gap = n.dot(at_end - spring.plane_point);
    const double force =
        std::max(0.0, normal.push(spring.multiplier - spring.stiffness * gap, n.dot(way)));
    Vec3 friction = Vec3::Zero();
    if (spring.friction_bound > 0.0) {
      const ImplicitSpring across{spring.friction_stiffness, 0.5 * (yielding.sum() - along)};
      const Vec3 slip = at_end - spring.anchor;
      const Vec3 trial =
          spring.friction_force - spring.friction_stiffness * Vec3(slip - n.dot(slip) * n);
      friction = across.push(trial, Vec3(way - n.dot(way) * n));
      const double length = friction.norm();
      if (length > spring.friction_bound) friction *= spring.friction_bound / length;
    }
    const double turning_share = 1.0 / (1.0 + yielding.mean() * spring.turning.norm());
    const Vec3 turning = -turning_share * (spring.turning * (at_end - spring.turned_from));
    for (const NodeWeight& carrier : spring.carriers) {
      push(carrier.node, carrier.weight * Vec3(force * n + friction + turning));
    }
    touch.normal_force += step.share * force;
    touch.friction += step.share * friction;
  }
  for (Touch& touch : touches_) {
    touch.before =
        pointOf(springOf(touch), shape_.state.displacement) - step.end * springOf(touch).plane_way;
  }
}

void ContactPassage::tellMeans() {
  std::vector<std::vector<ContactSpring>> told;
  for (const ContactSprings& springs : springs_) told.emplace_back(springs.begin(), springs.end());
  for (const Touch& touch : touches_) {
    ContactSpring& spring = told[touch.patch][touch.number];
    const Vec3 point = pointOf(spring, shape_.state.displacement);
    spring.multiplier =
        touch.normal_force + spring.stiffness * spring.normal.dot(point - spring.plane_point);
    if (spring.friction_bound <= 0.0) continue;
    spring.friction_force = touch.friction;
    spring.anchor = point;
    spring.friction_bound = std::max(spring.friction_bound, touch.friction.norm());
  }
  for (std::size_t patch = 0; patch < springs_.size(); ++patch) {
    springs_[patch] = std::move(told[patch]);
  }
}

}  // namespace robot_tissue
