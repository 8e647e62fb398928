// Touches of shapes whose contact is narrower than the lattice tells apart.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "rim_touch.h"
#include "robot_tissue/core/triangle_point.h"
#include "robot_tissue/coupling/sliding_contacts.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

using Touches = std::vector<const SlidingContacts::ContactConstraint*>;

double forceOf(const Touches& touches) {
  double force = 0.0;
  for (const auto* touch : touches) force += touch->spring.multiplier;
  return force;
}

// Of their force (1), in sum 1; of one alone 1 though it does not push yet.
std::vector<double> sharesOf(const Touches& touches) {
  const double force = forceOf(touches);
  std::vector<double> shares;
  for (const auto* touch : touches) {
    shares.push_back(force > 0.0 ? touch->spring.multiplier / force : 1.0);
  }
  return shares;
}

// Whether what touches is spread too wide to be narrow (m), as seen along the way.
bool areSpread(const Touches& touches, const std::vector<double>& shares, const Vec3& axis,
               double wide) {
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  const Vec3 across = axis.unitOrthogonal(), along = axis.cross(across);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Vec3 off = touches[i]->tool_point - touches.front()->tool_point;
    const Eigen::Vector2d place(off.dot(across), off.dot(along));
    mean += shares[i] * place;
    squares += shares[i] * place * place.transpose();
  }
  const Eigen::Matrix2d spread = squares - mean * mean.transpose();
  const double half = 0.5 * spread.trace();
  const double least = half - std::sqrt(std::max(0.0, half * half - spread.determinant()));
  return least > wide * wide;
}

const SlidingContacts::ContactConstraint& hardest(const Touches& touches) {
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

// The link's shape that all of these touch.
const ToolIndenter* SlidingContacts::indenterUnder(const Touches& touches,
                                                   const Tissue& tissue) const {
  if (touches.empty()) return nullptr;
  const LinkForm& form = forms_[at(touches.front()->contact.link)];
  const double least = tuning::kLeastThickness * tissue.lattice().spacing();
  for (const ToolIndenter& tool : form.indenters) {
    const auto is_of_it = [&](const ContactConstraint* touch) {
      return touch->contact.shape == tool.shape;
    };
    if (form.thicknesses[at(tool.shape)] >= least &&
        std::all_of(touches.begin(), touches.end(), is_of_it)) {
      return &tool;
    }
  }
  return nullptr;
}

// The part of the shape around its hardest touch; nothing where others that count are off it, as on
// another prong. `facing`: unit, frame of the shape.
std::shared_ptr<const IndenterPart> SlidingContacts::partUnder(const ToolIndenter& tool,
                                                               const Touches& touches,
                                                               const Pose& tissue_T_shape,
                                                               const Vec3& facing, double spacing) {
  const ContactConstraint& most = hardest(touches);
  SeenPart now;
  now.shape = tool.shape;
  now.facing = facing;
  now.triangle = tool.indenter->nearestFacing(facing, tissue_T_shape.inverse() * most.tool_point);
  if (now.triangle < 0) return nullptr;
  SeenPart& seen = seen_parts_[at(most.contact.link)];
  if (seen.shape != now.shape || seen.triangle != now.triangle || seen.facing != facing) {
    now.part = std::make_shared<const IndenterPart>(
        tool.indenter->partAround(now.triangle, facing, kNoRecessFrom * spacing));
    seen = std::move(now);
  }
  const Box near = grownBy(tuning::kOffPart * spacing, seen.part->bounds);
  double off_part = 0.0;  // N
  for (const ContactConstraint* touch : touches) {
    const bool is_at_rim = touch->contact.rim.is_beyond || !touch->contact.columns.empty();
    if (is_at_rim || near.contains(Vec3(tissue_T_shape.inverse() * touch->tool_point))) continue;
    off_part += touch->spring.multiplier;
  }
  const bool is_known =
      !seen.part->levels.empty() && off_part <= tuning::kForceOffPart * forceOf(touches);
  return is_known ? seen.part : nullptr;
}

// How these touches, of one link, press together: all but with what. The way is as the surface
// looks: of what is flat, touches' normals are those of its faces. Heights of planes are above
// where the shape is lowest, as seen along that way; the curved surface is off what nodes carry by
// a bulge, and a rim gives way. Nothing: they have no law.
std::optional<NarrowPress> SlidingContacts::pressOf(const Touches& touches,
                                                    const Pose& tissue_T_link,
                                                    const Tissue& tissue) {
  const double spacing = tissue.lattice().spacing();
  const ToolIndenter* const tool = indenterUnder(touches, tissue);
  if (tool == nullptr) return std::nullopt;
  const ContactConstraint& most = hardest(touches);
  NarrowPress press;
  const std::vector<double> forces = sharesOf(touches);
  Vec3 apex = Vec3::Zero();
  for (std::size_t i = 0; i < touches.size(); ++i) {
    apex += forces[i] * touches[i]->tool_point;
    press.middle += forces[i] * pointOf(touches[i]->corners, touches[i]->contact.place.barycentric);
  }
  press.place = most.contact.place;
  press.axis = tissue.inwardsAround(press.place, press.middle);
  if (press.axis.isZero(0.0) ||
      areSpread(touches, forces, press.axis, tuning::kWideTouches * spacing)) {
    return std::nullopt;
  }
  const Pose tissue_T_shape = tissue_T_link * tool->link_T_shape;
  const Vec3 facing = tissue_T_shape.linear().transpose() * press.axis;
  press.part = partUnder(*tool, touches, tissue_T_shape, facing, spacing);
  if (press.part == nullptr) return std::nullopt;
  press.apex = tissue_T_shape.inverse() * apex;
  const Vec3 lowest = tissue_T_shape * press.part->lowest;
  std::map<int, double> shares;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const ContactConstraint* const touch = touches[i];
    const double share = forces[i];
    Vec3 place = touch->tool_point;
    if (touch->contact.wanders) {
      const Vec3 point = tissue_T_shape.inverse() * place;
      place = tissue_T_shape * tool->indenter->nearestOn(*press.part, point);
    }
    press.height +=
        share * ((lowest - place + touch->contact.bulge).dot(press.axis) + rimRecess(*touch));
    press.off_apex += share * press.axis.cross(place - apex).squaredNorm();
    for (const auto& [node, weight] : touch->spring.carriers) shares[node] += share * weight;
  }
  for (const auto& [node, share] : shares) press.shares.push_back({node, share});
  return press;
}

// No deeper than a part of the shape's thickness.
Recess SlidingContacts::recessUnder(const NarrowPress& press, const Touches& touches,
                                    const Tissue& tissue) const {
  Recess recess = tissue.recessUnder(press).value_or(Recess());
  const Contact& contact = touches.front()->contact;
  const double thickness = forms_[at(contact.link)].thicknesses[at(contact.shape)];
  recess.depth = std::min(recess.depth, tuning::kMostOfThickness * thickness);
  return recess;
}

// By what the link's multipliers are.
Recess SlidingContacts::recessAsked(int link, const Pose& tissue_T_link, const Tissue& tissue) {
  Touches pushing;
  for (const ContactConstraint& touch : touches_) {
    if (touch.contact.link == link && touch.spring.multiplier > 0.0) pushing.push_back(&touch);
  }
  std::optional<NarrowPress> press = pressOf(pushing, tissue_T_link, tissue);
  if (!press) return {};
  press->force = forceOf(pushing);
  return recessUnder(*press, pushing, tissue);
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
    if (forms_[at(link)].indenters.empty()) continue;
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

// Of links that have only just met the tissue, by how deep they are in it: there is no force yet,
// or it is not known how that grows.
void SlidingContacts::guessRecesses(const RobotPose& pose, const Tissue& tissue) {
  if (tissue.hasTime()) return;
  for (int link = 0; link < static_cast<int>(forms_.size()); ++link) {
    if (forms_[at(link)].indenters.empty()) continue;
    const ContactConstraint* deepest = nullptr;
    double depth = 0.0;
    bool pushes = false;
    for (const ContactConstraint& touch : touches_) {
      if (touch.contact.link != link) continue;
      pushes = pushes || touch.spring.multiplier > 0.0;
      const double its = touch.recess - gapOf(touch.spring, tissue.state().displacement);
      if (deepest != nullptr && its <= depth) continue;
      deepest = &touch;
      depth = its;
    }
    if (deepest == nullptr || (pushes && knowsGrowth(at(link), pose))) continue;
    std::optional<NarrowPress> press = pressOf({deepest}, pose.links[at(link)], tissue);
    Recess guess;
    if (press) {
      press->depth = depth * deepest->spring.normal.dot(press->axis) + press->height;
      guess = recessUnder(*press, {deepest}, tissue);
    }
    setRecess(link, std::max(guess.depth, -tuning::kMostGuessedOutwards * std::max(0.0, depth)));
  }
}

}  // namespace robot_tissue
