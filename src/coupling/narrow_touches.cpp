// Touches of shapes whose contact is narrower than the lattice tells apart.
#include <algorithm>
#include <cmath>
#include <map>

#include "rim_touch.h"
#include "robot_tissue/coupling/sliding_contacts.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Where it is farthest along a unit direction, shape's frame (m).
Vec3 farthestPoint(const BoxOrCylinder& body, const Vec3& direction) {
  Vec3 farthest;
  for (int axis = 0; axis < 3; ++axis) {
    farthest[axis] = std::copysign(body.half_size[axis], direction[axis]);
  }
  if (body.radius > 0.0) {
    farthest.head<2>() = body.radius * direction.head<2>().stableNormalized();
  }
  return farthest;
}

// How far its surface is above its farthest point, at so much beside that (m, shape's frame): by
// the faces that meet there, of a cylinder by its end.
double heightBeside(const BoxOrCylinder& body, const Vec3& facing, const Vec3& off) {
  constexpr double kUpright = 1e-3;  // 1: a face that hardly faces that way is beside it
  const Vec3 beside = off - off.dot(facing) * facing;
  double height = 0.0;
  for (int axis = body.radius > 0.0 ? 2 : 0; axis < 3; ++axis) {
    if (std::abs(facing[axis]) > kUpright) height = std::max(height, beside[axis] / facing[axis]);
  }
  return height;
}

}  // namespace

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

// The link's box or cylinder that all of these touch.
const BoxOrCylinder* SlidingContacts::bodyUnder(const Touches& touches,
                                                const Tissue& tissue) const {
  if (touches.empty()) return nullptr;
  const double least = 0.5 * tuning::kLeastThickness * tissue.lattice().spacing();
  for (const BoxOrCylinder& body : forms_[at(touches.front()->contact.link)].bodies) {
    const auto is_of_it = [&](const ContactConstraint* touch) {
      return touch->contact.shape == body.shape;
    };
    if (body.half_size.minCoeff() >= least &&
        std::all_of(touches.begin(), touches.end(), is_of_it)) {
      return &body;
    }
  }
  return nullptr;
}

// By what the link's multipliers are. Heights of planes are above where the shape is lowest, as
// seen along the way it presses; the curved surface is off what nodes carry by a bulge, and a rim
// gives way.
Recess SlidingContacts::recessAsked(int link, const Pose& tissue_T_link,
                                    const Tissue& tissue) const {
  Touches pushing;
  Vec3 axis = Vec3::Zero();
  NarrowPress press;
  for (const ContactConstraint& touch : touches_) {
    if (touch.contact.link != link || touch.spring.multiplier <= 0.0) continue;
    pushing.push_back(&touch);
    press.force += touch.spring.multiplier;
    axis += touch.spring.multiplier * touch.spring.normal;
  }
  const Ball* const ball = ballUnder(pushing, tissue_T_link, tissue);
  const BoxOrCylinder* const body = ball == nullptr ? bodyUnder(pushing, tissue) : nullptr;
  if (ball == nullptr && body == nullptr) return {};
  axis.normalize();
  press.axis = axis;
  Pose tissue_T_shape = tissue_T_link;
  Vec3 lowest;
  if (body != nullptr) {
    tissue_T_shape = tissue_T_link * body->link_T_shape;
    press.body = *body;
    press.facing = tissue_T_shape.linear().transpose() * axis;
    lowest = tissue_T_shape * farthestPoint(*body, press.facing);
  } else {
    press.radius = ball->radius;
    lowest = tissue_T_link * ball->center + ball->radius * axis;
  }
  std::map<int, double> shares;
  for (const ContactConstraint* touch : pushing) {
    const double share = touch->spring.multiplier / press.force;
    double height = (lowest - touch->tool_point).dot(axis);
    if (body != nullptr && touch->contact.wanders) {
      const Vec3 off = tissue_T_shape.linear().transpose() * (touch->tool_point - lowest);
      height = heightBeside(*body, press.facing, off);
    }
    press.height += share * (height + touch->contact.bulge.dot(axis) + rimRecess(*touch));
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

// After a solve; false: one goes so far that it is to be solved again. By less once it goes to and
// fro, as touches come and go with it.
bool SlidingContacts::renewRecesses(const RobotPose& pose, const Tissue& tissue) {
  if (!tellsRecesses(tissue)) return true;
  bool stay = true;
  for (int link = 0; link < static_cast<int>(forms_.size()); ++link) {
    if (!forms_[at(link)].mayPressNarrowly()) continue;
    const Recess asked = recessAsked(link, pose.links[at(link)], tissue);
    LinkRecess& recess = recesses_[at(link)];
    const double way = asked.depth - recess.depth;
    stay = stay && std::abs(way) <= tuning::kRecessStays * tissue.lattice().spacing();
    if (way * recess.last_way < 0.0) recess.gain *= tuning::kLessToAndFro;
    recess.last_way = way;
    setRecess(link, recess.depth + recess.gain * asked.step * way);
  }
  return stay;
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
    NarrowPress press;
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
    const double most_outwards = tuning::kMostGuessedOutwards * std::max(0.0, press.depth);
    setRecess(link, std::max(guess.value_or(Recess()).depth, -most_outwards));
  }
}

}  // namespace robot_tissue
