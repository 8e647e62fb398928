// What touches press with: by links and by tools.
#include <algorithm>
#include <cmath>
#include <vector>

#include "rim_touch.h"
#include "robot_tissue/coupling/sliding_contacts.h"
#include "touch_spring.h"
#include "tuning.h"

namespace robot_tissue {

// What the method says that springs pushed with in the mean of the time step.
void SlidingContacts::takeMeans(const Tissue& tissue) {
  for (const LoadingPatch& patch : tissue.patches()) {
    if (!patch.tool) continue;
    std::size_t next = 0;
    for (ContactConstraint& touch : touches_) {
      if (touch.contact.tool != *patch.tool || next == patch.contacts.size()) continue;
      touch.spring = patch.contacts[next++];
    }
  }
}

std::vector<PressGrowth::Press> SlidingContacts::presses(std::size_t links) const {
  std::vector<PressGrowth::Press> presses(links);
  for (const ContactConstraint& touch : touches_) {
    PressGrowth::Press& press = presses[at(touch.contact.link)];
    press.force += touch.spring.multiplier;
    press.place += touch.spring.multiplier * touch.tool_point;
  }
  for (PressGrowth::Press& press : presses) {
    if (press.force > 0.0) press.place /= press.force;
  }
  return presses;
}

// Friction counts: what leans on the sides of a link presses across it, and friction under it takes
// that up; the tool has neither.
void SlidingContacts::noteFacing(const RobotPose& pose) {
  facing_.assign(pose.links.size(), Vec3::Zero());
  for (const ContactConstraint& touch : touches_) {
    const Pose& tissue_T_link = pose.links[at(touch.contact.link)];
    facing_[at(touch.contact.link)] +=
        tissue_T_link.linear().transpose() * forceOf(touch.spring, *since_displacement_);
  }
}

Vec3 SlidingContacts::facing(int link, const Pose& tissue_T_link) const {
  if (at(link) >= facing_.size()) return Vec3::Zero();
  return tissue_T_link.linear() * facing_[at(link)].normalized();
}

bool SlidingContacts::pushesAbsurdly(const Tissue& tissue) {
  const auto is_absurd = [&](const ContactSpring& spring) {
    return normalForceOf(spring, tissue.state().displacement) > mostForceOf(spring, tissue);
  };
  return std::any_of(tissue.patches().begin(), tissue.patches().end(), [&](const auto& patch) {
    return std::any_of(patch.contacts.begin(), patch.contacts.end(), is_absurd);
  });
}

bool SlidingContacts::pushes(int tool, const Tissue& tissue) const {
  return std::any_of(touches_.begin(), touches_.end(), [&](const ContactConstraint& touch) {
    return touch.contact.tool == tool &&
           (touch.spring.multiplier > 0.0 ||
            normalForceOf(touch.spring, tissue.state().displacement) > 0.0);
  });
}

// Uzawa's step: each multiplier becomes the normal force of the solve, each bound of friction the
// coefficient times that. Friction's stiffness lets a point that sticks give way by kElasticSlip to
// kMostElasticSlip of the fineness. True: the bounds' sum has changed by less than kSameFriction.
bool SlidingContacts::updateMultipliers(const Tissue& tissue) {
  const double spacing = tissue.lattice().spacing();
  double bounds_before = 0.0, bounds_now = 0.0;
  pressed_.assign(friction_.size(), {});
  for (ContactConstraint& touch : touches_) {
    touch.found = false;
    ContactSpring& spring = touch.spring;
    const double force = normalForceOf(spring, tissue.state().displacement);
    const double friction_bound = friction_[at(touch.contact.tool)].value_or(0.0) * force;
    Pressed& pressed = pressed_[at(touch.contact.tool)];
    pressed.force += force;
    pressed.touches += force > 0.0 ? 1 : 0;
    bounds_before += spring.friction_bound;
    bounds_now += friction_bound;
    spring.multiplier = std::min(force, mostForceOf(spring, tissue));
    spring.friction_bound = friction_bound;
    const double fine = fineness(touch.contact, spacing);
    const double soft = frictionStiffness(touch.firm_stiffness);
    const double stiffness =
        std::min(std::max(soft, friction_bound / (tuning::kMostElasticSlip * fine)),
                 friction_bound / (tuning::kElasticSlip * fine));
    spring.friction_stiffness = softened(stiffness, touch.compliance.friction);
    putPlane(touch);
  }
  return std::abs(bounds_now - bounds_before) <= tuning::kSameFriction * bounds_now;
}

// Of a shape on its way to balance forces say nothing, so multipliers stay; but those of points
// deeper than the slack take the spring's force, so that what went into a link comes out of it.
void SlidingContacts::pressHarder(const Tissue& tissue) {
  for (ContactConstraint& touch : touches_) {
    ContactSpring& spring = touch.spring;
    if (gapOf(spring, tissue.state().displacement) >= -slackOf(touch, tissue)) continue;
    const double force = normalForceOf(spring, tissue.state().displacement);
    spring.multiplier = std::min(force, mostForceOf(spring, tissue));
    putPlane(touch);
  }
}

}  // namespace robot_tissue
