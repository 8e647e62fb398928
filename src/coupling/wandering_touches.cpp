// Touches between vertices of the curved surface where a sharp edge or corner of a link is deepest.
// They are of the link's place, and go along the surface as the tissue slides by.
#include <algorithm>
#include <tuple>
#include <vector>

#include "known_touches.h"
#include "rim_touch.h"
#include "robot_tissue/coupling/sliding_contacts.h"
#include "touch_spring.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

Vec3 placeOnTool(const Contact& contact) {
  return contact.point + contact.depth_m * contact.normal;
}

}  // namespace

// What was found is taken by the touches that were nearest, each one; they keep their force. Those
// that find none go on where they were followed, if none is there yet, or leave their force to the
// nearest touch there is. False: the update is not settled.
bool SlidingContacts::wander(const ContactSet& found, const Tracked& tracked, const RobotPose& pose,
                             const Tissue& tissue, const Held& held) {
  std::vector<const Contact*> places;
  for (const Contact& contact : found.contacts) {
    if (contact.wanders && friction_[at(contact.tool)]) places.push_back(&contact);
  }
  const double reach = tuning::kFarthestWander * tissue.lattice().spacing();
  const std::size_t known = touches_.size();
  bool is_settled = true;
  std::vector<std::uint8_t> is_taken(places.size(), 0);
  for (const auto& [off, touch, place] : nearestFirst(places, reach)) {
    if (touches_[touch].found || is_taken[place] != 0) continue;
    is_taken[place] = 1;
    is_settled = moveTo(*places[place], pose, tissue, held, touches_[touch]) && is_settled;
  }
  KnownTouches now(touches_);
  for (std::size_t place = 0; place < places.size(); ++place) {
    if (is_taken[place] != 0) continue;
    add(*places[place], now, pose, tissue, held);
    const double depth =
        places[place]->depth_m - columnRecess(places[place]->link, places[place]->columns);
    is_settled = depth <= slackOf(touches_.back(), tissue) && is_settled;
  }
  for (std::size_t i = 0; i < known; ++i) {
    if (!touches_[i].contact.wanders || touches_[i].found) continue;
    const bool is_followed = i < tracked.size() && tracked[i];
    const bool goes_on = is_followed && !isTaken(*tracked[i]);
    const bool stays = goes_on ? moveTo(*tracked[i], pose, tissue, held, touches_[i])
                               : handOn(touches_[i], reach, tissue);
    is_settled = stays && is_settled;
  }
  return is_settled;
}

// How far each touch that wanders, none of them found yet, is from each place on its link.
std::vector<SlidingContacts::Wander> SlidingContacts::nearestFirst(
    const std::vector<const Contact*>& places, double reach) {
  std::vector<Wander> all;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    if (!touches_[i].contact.wanders) continue;
    touches_[i].found = false;
    for (std::size_t j = 0; j < places.size(); ++j) {
      if (places[j]->link != touches_[i].contact.link) continue;
      if (touches_[i].spring.normal.dot(places[j]->normal) < tuning::kSameSideOfTool) continue;
      const double off = (placeOnTool(*places[j]) - touches_[i].tool_point).norm();
      if (off < reach) all.emplace_back(off, i, j);
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

// Whether a touch that wanders is at the place already. Two there would be one that is twice as
// stiff.
bool SlidingContacts::isTaken(const Contact& place) const {
  return std::any_of(touches_.begin(), touches_.end(), [&](const ContactConstraint& touch) {
    const Contact& its = touch.contact;
    if (!touch.found || !its.wanders || its.link != place.link) return false;
    if (its.place.triangle != place.place.triangle) return false;
    const Vec3 off = its.place.barycentric - place.place.barycentric;
    return off.cwiseAbs().maxCoeff() < tuning::kSamePoint;
  });
}

// True: it is where it was, or nearly.
bool SlidingContacts::moveTo(const Contact& contact, const RobotPose& pose, const Tissue& tissue,
                             const Held& held, ContactConstraint& touch) {
  const double turned = turningForceOf(touch.spring, tissue.state().displacement).norm();
  const Vec3 since_normal = touch.since_normal;
  put(contact, pose, tissue, held, touch);
  touch.since_normal = since_normal;
  const Vec3 since = pose.links[at(touch.contact.link)].linear() * since_normal;
  touch.spring.normal = turnedBy(since, contact.normal, tuning::kMostTurn);
  anchor(pose, touch);
  return turned <= tuning::kLittleForce * pressed_[at(touch.contact.tool)].force &&
         isAtRest(touch, tissue);
}

// To the nearest touch, of those that touch where any is: what pushes from afar would lose it.
// True: what it pushed with was little.
bool SlidingContacts::handOn(const ContactConstraint& lost, double reach, const Tissue& tissue) {
  const ContactSpring& from = lost.spring;
  if (from.multiplier <= 0.0) return true;
  ContactConstraint* nearest = nullptr;
  double least = 2.0 * reach;
  for (ContactConstraint& touch : touches_) {
    if (!touch.found || touch.contact.link != lost.contact.link) continue;
    if (touch.spring.normal.dot(from.normal) < tuning::kSameSideOfTool) continue;
    double off = (touch.tool_point - lost.tool_point).norm();
    if (off >= reach) continue;
    const double gap = gapOf(touch.spring, tissue.state().displacement);
    if (gap > slackOf(touch, tissue)) off += reach;  // after all that touch
    if (off >= least) continue;
    least = off;
    nearest = &touch;
  }
  if (nearest != nullptr) {
    ContactSpring& to = nearest->spring;
    to.multiplier = std::min(to.multiplier + from.multiplier, mostForceOf(to, tissue));
    to.friction_bound += from.friction_bound;
    putPlane(*nearest);
  }
  return from.multiplier <= tuning::kLittleForce * pressed_[at(lost.contact.tool)].force;
}

bool SlidingContacts::isAtRest(const ContactConstraint& touch, const Tissue& tissue) const {
  const double gap = gapOf(touch.spring, tissue.state().displacement);
  const double slack = slackOf(touch, tissue);
  return gap >= -slack &&
         (gap <= slack ||
          touch.spring.multiplier <= tuning::kLittleForce * pressed_[at(touch.contact.tool)].force);
}

}  // namespace robot_tissue
