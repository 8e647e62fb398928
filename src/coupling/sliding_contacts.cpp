#include "robot_tissue/coupling/sliding_contacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "known_touches.h"
#include "rim_touch.h"
#include "touch_places.h"
#include "touch_spring.h"
#include "tuning.h"

namespace robot_tissue {

SlidingContacts::SlidingContacts(std::vector<std::optional<double>> friction,
                                 std::vector<LinkForm> links)
    : friction_(std::move(friction)),
      forms_(std::move(links)),
      pressed_(friction_.size()),
      recesses_(forms_.size()),
      seen_parts_(forms_.size()) {}

// The length that slips and gaps are measured by (m): the spacing, or the thickness of a thin link.
double SlidingContacts::fineness(const Contact& contact, double spacing) const {
  return std::min(spacing, thicknessAt(contact));
}

// Of the shape that the contact is with (m), or of the link's thinnest.
double SlidingContacts::thicknessAt(const Contact& contact) const {
  const std::vector<double>& all = forms_[at(contact.link)].thicknesses;
  if (contact.shape >= 0) return all[at(contact.shape)];
  return all.empty() ? kInfinity : *std::min_element(all.begin(), all.end());
}

void SlidingContacts::ride(const RobotPose& pose, const Tissue& tissue) {
  if (since_links_.size() != pose.links.size() || !since_displacement_ ||
      since_displacement_->size() != tissue.state().displacement.size()) {
    commit(pose, tissue);
  }
  is_settled_ = false;
  growAlongWay(pose, tissue);
  plane_shares_.clear();
  for (ContactConstraint& touch : touches_) {
    touch.way.reset();
    const std::size_t link = at(touch.contact.link);
    const Pose moved = movedSince(link, pose);
    touch.spring.normal = moved.linear() * touch.spring.normal;
    const double drift = touch.drift.foresee(growth_.shareOfLastWay(link, pose.links[link]));
    touch.tool_point = moved * touch.tool_point + drift * touch.spring.normal;
    touch.spring.turned_from = moved * touch.spring.turned_from;
    rideEdge(moved, touch);
    putPlane(touch);
    touch.stuck = touch.spring.multiplier > 0.0 ? 1.0 : shareOfTouch(moved, touch);
    anchor(pose, touch);
  }
  softenColumns(tissue);
}

// How the link moved since the last commit.
Pose SlidingContacts::movedSince(std::size_t link, const RobotPose& pose) const {
  return pose.links[link] * since_links_[link].inverse();
}

// Of the link's way in the load step, the share (1) on which it touches the point: as deep as that
// would be in it at its end, if the tissue stayed as it was.
double SlidingContacts::shareOfTouch(const Pose& moved, const ContactConstraint& touch) const {
  const Vec3 way = touch.tool_point - moved.inverse() * touch.tool_point;
  const double comes = way.dot(touch.spring.normal);
  const double depth = -gapOf(touch.spring, *since_displacement_);
  return comes > 0.0 ? std::clamp(depth / comes, 0.0, 1.0) : 1.0;
}

// Friction's anchor: where the point was at the last commit, moved with the link since it touches.
// Its friction force there is the ratio of friction to normal force at the commit times the present
// multiplier: where normal force goes from one touch to its neighbors, friction goes with it.
void SlidingContacts::anchor(const RobotPose& pose, ContactConstraint& touch) const {
  const Pose& link = pose.links[at(touch.contact.link)];
  const Pose moved = movedSince(at(touch.contact.link), pose);
  const Vec3 since = pointOf(touch.spring, *since_displacement_);
  touch.spring.anchor = since + touch.stuck * (moved * since - since);
  touch.spring.plane_way = touch.tool_point - moved.inverse() * touch.tool_point;
  const Vec3 drag = touch.spring.multiplier * (link.linear() * touch.friction_ratio);
  touch.spring.friction_force = drag - touch.spring.normal.dot(drag) * touch.spring.normal;
}

void SlidingContacts::meet(const ContactSet& contacts, const RobotPose& pose, const Tissue& tissue,
                           const Held& held, const Tracked& wandering) {
  for (ContactConstraint& touch : touches_) {
    touch.found = true;  // nothing was looked for yet: its plane has come with the link
    touch.left.reset();
    if (!tissue.goesInTime()) touch.entry = 0.0;
    touch.stiffening = carry(touch.contact, tissue, held, touch.spring);
    takeStiffness(tissue, held, touch);
    soften(tissue, touch);
  }
  KnownTouches known(touches_);
  for (const Contact& contact : contacts.contacts) {
    if (!friction_[at(contact.tool)] || contact.wanders) continue;
    if (known.find(contact, tissue.surface()) == nullptr) add(contact, known, pose, tissue, held);
  }
  wander(contacts, wandering, pose, tissue, held);
  forgetLost(held);
  softenColumns(tissue);
  guessRecesses(pose, tissue);
  stickFirst(tissue);
}

bool SlidingContacts::update(const Tracked& tracked, const ContactSet& found, const RobotPose& pose,
                             const Tissue& tissue, const Held& held, ContactUpdate::Shape shape) {
  const bool whole = shape == ContactUpdate::Shape::kSolved;
  cut_rounds_ = whole ? 0 : cut_rounds_ + 1;
  const bool wavers = cut_rounds_ > tuning::kMostTurningRounds;
  if (tissue.goesThroughTime()) takeMeans(tissue);
  for (ContactConstraint& touch : touches_) noteSolved(touch);
  is_settled_ = whole && updateMultipliers(tissue);
  if (whole && !renewRecesses(pose, tissue)) is_settled_ = false;
  if (!whole) pressHarder(tissue);
  softenColumns(tissue);
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    ContactConstraint& touch = touches_[i];
    touch.last_way = std::exchange(touch.way, std::nullopt);
    if (touch.contact.wanders) continue;
    if (wavers && touch.found && tracked[i]) continue;
    const double gap_before = gapOf(touch.spring, tissue.state().displacement);
    if (!track(tracked[i], pose, tissue, touch)) is_settled_ = false;
    if (whole && touch.found && touch.vertex < 0 && touch.contact.rim.edges.empty()) {
      touch.way = gap_before - gapOf(touch.spring, tissue.state().displacement);
    }
  }
  KnownTouches known(touches_);
  for (const Contact& contact : found.contacts) {
    if (!friction_[at(contact.tool)] || contact.wanders) continue;
    if (!take(contact, known, pose, tissue, held)) is_settled_ = false;
  }
  if (!wander(found, tracked, pose, tissue, held)) is_settled_ = false;
  if (!is_settled_) calmPlanes(pose);
  softenColumns(tissue);
  forgetLost(held);
  return is_settled_;
}

// Takes the plane that the touch's contact has in the present shape. In one load step its normal
// turns by kMostTurn at most, so that a touch that goes around an edge of the tool holds until
// others are found beyond it. False, the update is not settled: the point is deeper than the slack,
// or pushed though it is farther off than that.
bool SlidingContacts::track(const std::optional<Contact>& contact, const RobotPose& pose,
                            const Tissue& tissue, ContactConstraint& touch) {
  ContactSpring& spring = touch.spring;
  touch.found = contact.has_value();
  if (!contact) return spring.multiplier <= 0.0;
  const double gap_before = gapOf(spring, tissue.state().displacement);
  spring.rest += contact->bulge - touch.contact.bulge;
  const Rim rim_before = touch.contact.rim;
  putContact(*contact, tissue.surface(), touch);
  goHalfWay(rim_before, touch.contact.rim);
  if (contact->normal.norm() > 0.5) {
    const Vec3 since = pose.links[at(touch.contact.link)].linear() * touch.since_normal;
    spring.normal = turnedBy(since, contact->normal, tuning::kMostTurn);
    touch.tool_point = planePointOf(*contact, tissue);
  }
  soften(tissue, touch);
  anchor(pose, touch);
  touch.drift.meet(gap_before - gapOf(spring, tissue.state().displacement));
  return isAtRest(touch, tissue);
}

// Vertices are not off their surface, rims have a law of their own, touches that wander are
// elsewhere each time, and so are all of a thin link; in time planes are not where they were found
// (`entry`).
bool SlidingContacts::driftsEvenly(const ContactConstraint& touch, const Tissue& tissue) const {
  const double thick = tuning::kThickForDrift * tissue.lattice().spacing();
  return touch.vertex < 0 && !touch.contact.wanders && touch.contact.rim.edges.empty() &&
         thicknessAt(touch.contact) >= thick && !tissue.hasTime();
}

// The depth or gap that counts as none (m): closing it at all of the tool's n touches would change
// its force by less than kSlackOfForce of it, within bounds. Together they are sqrt(n) times as
// stiff as one: a half-space is as stiff as its contact is wide. Those that share their stiffness
// (crowding) are one. Where the touch gives way by c, beside the tissue's stiffness K, closing a
// gap changes the force by so much less: by K gap / (1 + c K).
double SlidingContacts::slackOf(const ContactConstraint& touch, const Tissue& tissue) const {
  const double stiffness = touch.crowding * touch.firm_stiffness / tuning::kContactStiffness;
  const double spacing = tissue.lattice().spacing();
  const Pressed& pressed = pressed_[at(touch.contact.tool)];
  const double touches = std::max(1.0, pressed.touches / touch.crowding);
  const double of_all = stiffness * std::sqrt(touches);
  const double slack = of_all > 0.0 ? tuning::kSlackOfForce * pressed.force / of_all : 0.0;
  const double least = tissue.hasTime() ? tuning::kLeastSlackInTime : tuning::kLeastSlack;
  const double of_firm =
      std::min(std::max(slack, least * spacing / touch.stiffening), tuning::kMostSlack * spacing);
  return (1.0 + touch.compliance.normal * stiffness) * of_firm;
}

// Takes a contact that the search found: as a new touch or, on a triangle whose deepest point has
// moved, in the place of the known one. False, the update is not settled: it is deeper than the
// slack.
bool SlidingContacts::take(const Contact& contact, KnownTouches& known, const RobotPose& pose,
                           const Tissue& tissue, const Held& held) {
  const double depth =
      contact.depth_m - recessOf(contact.link) - columnRecess(contact.link, contact.columns);
  ContactConstraint* touch = known.find(contact, tissue.surface());
  if (touch == nullptr) {
    add(contact, known, pose, tissue, held);
    return depth <= slackOf(touches_.back(), tissue);
  }
  const double deeper = tuning::kDeeperThanTouch * tissue.lattice().spacing();
  if (touch->vertex >= 0 || contact.depth_m <= touch->contact.depth_m + deeper) return true;
  const bool same_side = touch->spring.normal.dot(contact.normal) >= tuning::kSameSideOfTool;
  const bool deep = depth > tuning::kMostSlack * tissue.lattice().spacing();
  if (deep && (!same_side || touch->spring.multiplier > 0.0)) {
    add(contact, known, pose, tissue, held);
    return false;
  }
  if (hopsBack(*touch, contact, tissue)) {
    add(contact, known, pose, tissue, held);
    return depth <= slackOf(touches_.back(), tissue);
  }
  touch->left = touch->contact.place.barycentric;
  const Vec3 normal = touch->spring.normal, foot = touch->tool_point;
  const Vec3 since_normal = touch->since_normal;
  put(contact, pose, tissue, held, *touch);
  touch->since_normal = since_normal;
  if (!same_side) {
    touch->spring.normal = normal;
    touch->tool_point = foot;
    putPlane(*touch);
    anchor(pose, *touch);
  }
  known.moved(*touch);
  return depth <= slackOf(*touch, tissue);
}

// Whether the touch came from there in this load step: pushed at either place alone, the triangle
// goes into the tool at the other one. So a touch of each stays. Not in time, where forces of
// touches that come and go would be noise.
bool SlidingContacts::hopsBack(const ContactConstraint& touch, const Contact& contact,
                               const Tissue& tissue) const {
  if (!touch.left || !forms_[at(contact.link)].is_uneven || tissue.hasTime()) return false;
  const Vec3 off = *touch.left - contact.place.barycentric;
  const Vec3 gone = *touch.left - touch.contact.place.barycentric;
  return off.cwiseAbs().maxCoeff() < 0.5 * gone.cwiseAbs().maxCoeff();
}

bool SlidingContacts::givesWay(const std::vector<NodeWeight>& carriers, int tool,
                               const Held& held) {
  double free = 0.0;
  for (const auto& [node, weight] : carriers) {
    if (held[at(node)] == graspedBy(tool)) return false;
    if (held[at(node)] == 0) free += weight;
  }
  return free >= tuning::kLeastFree;
}

bool SlidingContacts::givesWay(const Contact& contact, const Tissue& tissue, const Held& held) {
  return givesWay(carriersAt(tissue.surface(), contact.place), contact.tool, held);
}

void SlidingContacts::forgetLost(const Held& held) {
  const auto lost = [&](const ContactConstraint& touch) {
    return !touch.found || !givesWay(touch.spring.carriers, touch.contact.tool, held);
  };
  touches_.erase(std::remove_if(touches_.begin(), touches_.end(), lost), touches_.end());
}

void SlidingContacts::add(const Contact& contact, KnownTouches& known, const RobotPose& pose,
                          const Tissue& tissue, const Held& held) {
  ContactConstraint touch;
  touch.contact = contact;
  touch.vertex = vertexAt(tissue.surface(), contact.place);
  touch.tool_point = contact.point;
  touch.friction_ratio = known.frictionRatioNear(contact.link, contact.point);
  if (tissue.goesInTime()) {
    const double most = tuning::kMostEntry * tissue.lattice().spacing();
    touch.entry = std::min(std::max(contact.depth_m, 0.0), most);
  }
  // Each is a kilobyte: room for twice as many would be more than is used.
  if (touches_.size() == touches_.capacity()) touches_.reserve(9 * touches_.size() / 8 + 8);
  touches_.push_back(touch);
  ContactConstraint& added = touches_.back();
  put(contact, pose, tissue, held, added);
  added.stuck = shareOfTouch(movedSince(at(contact.link), pose), added);
  anchor(pose, added);
}

// Of its spring as it was carried.
void SlidingContacts::takeStiffness(const Tissue& tissue, const Held& held,
                                    ContactConstraint& touch) {
  crowding_.take(tissue.surface(), held.size());
  touch.crowding = crowding_.under(touch.spring.carriers);
  touch.firm_stiffness = touch.spring.stiffness / touch.crowding;
}

void SlidingContacts::put(const Contact& contact, const RobotPose& pose, const Tissue& tissue,
                          const Held& held, ContactConstraint& touch) {
  touch.found = true;
  touch.way.reset();
  touch.recess = recessOf(contact.link);
  putContact(contact, tissue.surface(), touch);
  touch.stiffening = carry(touch.contact, tissue, held, touch.spring);
  takeStiffness(tissue, held, touch);
  touch.spring.normal = contact.normal;
  touch.spring.turned_from = contact.point;
  touch.tool_point = planePointOf(contact, tissue);
  soften(tissue, touch);
  touch.since_normal = pose.links[at(touch.contact.link)].linear().transpose() * contact.normal;
  anchor(pose, touch);
}

void SlidingContacts::commit(const RobotPose& pose, const Tissue& tissue) {
  const double went_s = std::max(pose.stamp_s - std::exchange(since_s_, pose.stamp_s), 0.0);
  since_links_ = pose.links;
  since_displacement_ = tissue.displacements();
  growth_.note(pose.links, presses(pose.links.size()));
  noteFacing(pose);
  cut_rounds_ = 0;
  for (ContactConstraint& touch : touches_) {
    const ContactSpring& spring = touch.spring;
    const Eigen::Matrix3d link_R_tissue = pose.links[at(touch.contact.link)].linear().transpose();
    touch.since_normal = link_R_tissue * spring.normal;
    if (driftsEvenly(touch, tissue)) {
      touch.drift.learn();
    } else {
      touch.drift.forget();
    }
    if (spring.multiplier <= 0.0) continue;
    const double force = normalForceOf(spring, *since_displacement_);
    const Vec3 drag = forceOf(spring, *since_displacement_) - force * spring.normal -
                      turningForceOf(spring, *since_displacement_);
    touch.friction_ratio = link_R_tissue * drag / spring.multiplier;
  }
  KnownTouches known(touches_);
  for (ContactConstraint& touch : touches_) {
    if (touch.spring.multiplier > 0.0) continue;
    touch.friction_ratio = known.frictionRatioNear(touch.contact.link, touch.tool_point);
  }
  const auto left = [&](const ContactConstraint& touch) {
    if (touch.spring.multiplier > 0.0) return false;
    const double far = touch.vertex >= 0 ? tuning::kFarOff * tissue.lattice().spacing() : 0.0;
    return gapOf(touch.spring, *since_displacement_) > far + touch.entry;
  };
  touches_.erase(std::remove_if(touches_.begin(), touches_.end(), left), touches_.end());
  forgetRecesses();
  for (ContactConstraint& touch : touches_) touch.entry *= std::exp(-went_s / tuning::kEntryTime);
}

void SlidingContacts::pass(const RobotPose& pose) {
  if (!since_links_.empty()) since_links_ = pose.links;
}

void SlidingContacts::clear() { *this = SlidingContacts(friction_, forms_); }

void SlidingContacts::clear(int tool) {
  const auto its = [&](const ContactConstraint& touch) { return touch.contact.tool == tool; };
  touches_.erase(std::remove_if(touches_.begin(), touches_.end(), its), touches_.end());
  pressed_[at(tool)] = {};
  forgetRecesses();
}

ContactSprings SlidingContacts::springsOf(int tool) const {
  std::vector<ContactSpring> springs;
  for (const ContactConstraint& touch : touches_) {
    if (touch.contact.tool == tool) springs.push_back(touch.spring);
  }
  return springs;
}

}  // namespace robot_tissue
