// Touches of balls whose contact is narrower than the lattice tells apart.
#include <algorithm>
#include <cmath>
#include <map>

#include "rim_touch.h"
#include "robot_tissue/coupling/sliding_contacts.h"
#include "tuning.h"

namespace robot_tissue {

double SlidingContacts::recessOf(int link) const {
  return at(link) < recesses_.size() ? recesses_[at(link)].depth : 0.0;
}

void SlidingContacts::setRecess(int link, double depth) {
  recesses_[at(link)].depth = depth;
  for (ContactConstraint& touch : touches_) {
    if (touch.contact.link != link) continue;
    touch.recess = depth;
    putPlane(touch);
  }
}

// Of links that touch nothing.
void SlidingContacts::forgetRecesses() {
  std::vector<std::uint8_t> touch_something(recesses_.size(), 0);
  for (const ContactConstraint& touch : touches_) touch_something[at(touch.contact.link)] = 1;
  for (std::size_t link = 0; link < recesses_.size(); ++link) {
    if (touch_something[link] == 0) recesses_[link] = {};
  }
}

// The link's ball that all of these touch, as a stylus does with its tip.
const Ball* SlidingContacts::ballUnder(const Touches& touches, const Pose& tissue_T_link,
                                       const Tissue& tissue) const {
  if (touches.empty()) return nullptr;
  const double off = tuning::kOffBall * tissue.lattice().spacing();
  for (const Ball& ball : forms_[at(touches.front()->contact.link)].balls) {
    const Vec3 center = tissue_T_link * ball.center;
    const auto is_on_it = [&](const ContactConstraint* touch) {
      return std::abs((touch->tool_point - center).norm() - ball.radius) <= off;
    };
    if (std::all_of(touches.begin(), touches.end(), is_on_it)) return &ball;
  }
  return nullptr;
}

// By what the link's multipliers are. Heights of planes are above where the ball is lowest, as seen
// along the way it presses; the curved surface is off what nodes carry by a bulge.
Recess SlidingContacts::recessAsked(int link, const Pose& tissue_T_link,
                                    const Tissue& tissue) const {
  Touches pushing;
  Vec3 axis = Vec3::Zero();
  BallPress press;
  for (const ContactConstraint& touch : touches_) {
    if (touch.contact.link != link || touch.spring.multiplier <= 0.0) continue;
    pushing.push_back(&touch);
    press.force += touch.spring.multiplier;
    axis += touch.spring.multiplier * touch.spring.normal;
  }
  const Ball* const ball = ballUnder(pushing, tissue_T_link, tissue);
  if (ball == nullptr) return {};
  axis.normalize();
  press.axis = axis;
  press.radius = ball->radius;
  const Vec3 lowest = tissue_T_link * ball->center + ball->radius * axis;
  std::map<int, double> shares;
  for (const ContactConstraint* touch : pushing) {
    const double share = touch->spring.multiplier / press.force;
    press.height += share * (lowest - touch->tool_point + touch->contact.bulge).dot(axis);
    for (const auto& [node, weight] : touch->spring.carriers) shares[node] += share * weight;
  }
  for (const auto& [node, share] : shares) press.shares.push_back({node, share});
  return tissue.recessUnder(press).value_or(Recess());
}

// A solve that was cut short tells no forces to go by. Nor in time, where forces swing, and a
// recess that follows them would drive them.
bool SlidingContacts::tellsRecesses(const Tissue& tissue) {
  return !tissue.hasTime() && tissue.lastReport().status == SolveStatus::kOk;
}

// After a solve: by less once it goes to and fro, as touches come and go with it.
void SlidingContacts::renewRecesses(const RobotPose& pose, const Tissue& tissue) {
  if (!tellsRecesses(tissue)) return;
  for (int link = 0; link < static_cast<int>(forms_.size()); ++link) {
    if (forms_[at(link)].balls.empty()) continue;
    const Recess asked = recessAsked(link, pose.links[at(link)], tissue);
    LinkRecess& recess = recesses_[at(link)];
    const double way = asked.depth - recess.depth;
    if (way * recess.last_way < 0.0) recess.gain *= tuning::kLessToAndFro;
    recess.last_way = way;
    setRecess(link, recess.depth + recess.gain * asked.step * way);
  }
}

// Whether it is known how the link's force grows along its way, if there is one.
bool SlidingContacts::knowsGrowth(std::size_t link, const RobotPose& pose) const {
  return growth_.isKnown(link) || pose.links[link].isApprox(since_links_[link], 0.0);
}

// Of balls that have only just met the tissue, by how deep they are in it: there is no force yet,
// or it is not known how that grows.
void SlidingContacts::guessRecesses(const RobotPose& pose, const Tissue& tissue) {
  if (tissue.hasTime()) return;
  for (int link = 0; link < static_cast<int>(forms_.size()); ++link) {
    if (forms_[at(link)].balls.empty()) continue;
    const ContactConstraint* deepest = nullptr;
    BallPress press;
    bool pushes = false;
    for (const ContactConstraint& touch : touches_) {
      if (touch.contact.link != link) continue;
      pushes = pushes || touch.spring.multiplier > 0.0;
      const double depth = touch.recess - gapOf(touch.spring, tissue.state().displacement);
      if (deepest != nullptr && depth <= press.depth) continue;
      deepest = &touch;
      press.depth = depth;
    }
    if (deepest == nullptr || (pushes && knowsGrowth(at(link), pose))) continue;
    const Ball* const ball = ballUnder({deepest}, pose.links[at(link)], tissue);
    press.radius = ball == nullptr ? 0.0 : ball->radius;
    press.shares = deepest->spring.carriers;
    press.axis = deepest->spring.normal;
    const auto guess = ball == nullptr ? std::nullopt : tissue.recessUnder(press);
    setRecess(link, guess.value_or(Recess()).depth);
  }
}

}  // namespace robot_tissue
