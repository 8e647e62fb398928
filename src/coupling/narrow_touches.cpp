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

// The place of it that is nearest, shape's frame (m).
Vec3 nearestPoint(const BoxOrCylinder& body, const Vec3& place) {
  Vec3 nearest = place.cwiseMax(-body.half_size).cwiseMin(body.half_size);
  const double off_axis = place.head<2>().norm();
  if (body.radius > 0.0 && off_axis > body.radius) {
    nearest.head<2>() = body.radius / off_axis * place.head<2>();
  }
  return nearest;
}

const SlidingContacts::ContactConstraint& hardest(
    const std::vector<const SlidingContacts::ContactConstraint*>& touches) {
  using Touch = SlidingContacts::ContactConstraint;
  return **std::max_element(touches.begin(), touches.end(),
                            [](const Touch* one, const Touch* other) {
                              return one->spring.multiplier < other->spring.multiplier;
                            });
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

// By what the link's multipliers are. Balls press the way their forces go, and what is flat the way
// the surface looks: its touches' normals are those of its faces. Heights of planes are above where
// the shape is lowest, as seen along that way; the curved surface is off what nodes carry by a
// bulge, and a rim gives way.
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
  press.axis = body == nullptr ? Vec3(axis.normalized())
                               : tissue.inwardsAround(hardest(pushing).contact.place);
  if (press.axis.isZero(0.0)) return {};
  Pose tissue_T_shape = tissue_T_link;
  Vec3 lowest;
  if (body != nullptr) {
    tissue_T_shape = tissue_T_link * body->link_T_shape;
    press.body = *body;
    press.facing = tissue_T_shape.linear().transpose() * press.axis;
    lowest = tissue_T_shape * farthestPoint(*body, press.facing);
  } else {
    press.radius = ball->radius;
    lowest = tissue_T_link * ball->center + ball->radius * press.axis;
  }
  std::map<int, double> shares;
  for (const ContactConstraint* touch : pushing) {
    const double share = touch->spring.multiplier / press.force;
    Vec3 place = touch->tool_point;
    if (body != nullptr && touch->contact.wanders) {
      place = tissue_T_shape * nearestPoint(*body, tissue_T_shape.inverse() * place);
    }
    press.height +=
        share * ((lowest - place + touch->contact.bulge).dot(press.axis) + rimRecess(*touch));
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

// After a solve; false: one goes so far that it is to be solved again. By less than is asked for
// where the last two rounds tell so, as touches come and go with the recess.
bool SlidingContacts::renewRecesses(const RobotPose& pose, const Tissue& tissue) {
  if (!tellsRecesses(tissue)) return true;
  bool stay = true;
  for (int link = 0; link < static_cast<int>(forms_.size()); ++link) {
    if (!forms_[at(link)].mayPressNarrowly()) continue;
    const Recess asked = recessAsked(link, pose.links[at(link)], tissue);
    LinkRecess& recess = recesses_[at(link)];
    const double way = asked.depth - recess.depth;
    stay = stay && std::abs(way) <= tuning::kRecessStays * tissue.lattice().spacing();
    const double gone = recess.depth - recess.last_depth, changed = way - recess.last_way;
    double step = asked.step;
    if (gone * changed < 0.0) step = std::min(step, -gone / changed);
    recess.last_way = way;
    recess.last_depth = recess.depth;
    setRecess(link, recess.depth + step * way);
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
