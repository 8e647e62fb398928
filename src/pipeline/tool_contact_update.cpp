#include "tool_contact_update.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "robot_tissue/core/part_of_way.h"
#include "stopwatch.h"
#include "tool_reports.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Whether the shape is one that touches push into place, of tools or supports. Of the surface that
// they were found on: on another one they may be on nodes that are gone.
bool pushesStill(const Tissue& tissue) {
  const auto pushes = [&](const ContactSpring& spring) {
    return !forceOf(spring, tissue.state().displacement).isZero(0.0);
  };
  return std::any_of(tissue.patches().begin(), tissue.patches().end(),
                     [&](const LoadingPatch& patch) {
                       return std::any_of(patch.contacts.begin(), patch.contacts.end(), pushes);
                     });
}

}  // namespace

// Where tissue slips off a tool, it springs far in one solve. So that it meets the tool again where
// it would, no vertex near a link goes farther at once than half a spacing; so that it does not
// spring past a thin link, its way is looked at after each stride of a part of the thickness.
std::vector<ToolContactUpdate::Surroundings> ToolContactUpdate::surroundings() const {
  const double spacing = world_.tissue.lattice().spacing();
  std::vector<Surroundings> all;
  for (std::size_t link = 0; link < world_.tools.linkCount(); ++link) {
    if (ToolSet::isAway(world_.pose.links[link]) || world_.isInWound(link)) continue;
    Surroundings here;
    here.box = grownBy(spacing, world_.finder.bounds(link, world_.pose.links[link]));
    here.longest = tuning::kLongestWay * spacing;
    const double thickness = world_.thicknessNear(link, world_.pose.links[link]);
    here.stride = std::min(here.longest, tuning::kStrideOfThickness * thickness);
    all.push_back(here);
  }
  return all;
}

std::vector<double> ToolContactUpdate::longestWays() {
  const Stopwatch watch(world_.report.contact_ms);
  const std::vector<Vec3>& now = world_.tissue.vertices();
  std::vector<double> longest;
  for (const Surroundings& near : surroundings()) {
    longest.resize(now.size(), std::numeric_limits<double>::infinity());
    for (std::size_t vertex = 0; vertex < now.size(); ++vertex) {
      if (near.box.contains(now[vertex])) longest[vertex] = std::min(longest[vertex], near.longest);
    }
  }
  return longest;
}

double ToolContactUpdate::shareOfWay(const std::vector<Vec3>& before) {
  const Stopwatch watch(world_.report.contact_ms);
  const TissueSurface& surface = world_.tissue.surface();
  deform(surface, world_.tissue.state().displacement, now_);
  const std::vector<Surroundings> around = surroundings();
  double share = 1.0, strides = 1.0;
  for (std::size_t vertex = 0; vertex < now_.size(); ++vertex) {
    const Vec3& now = now_[vertex];
    const Vec3 from = carriedFrom(surface.rest[vertex], surface.carriers[vertex], before);
    for (const Surroundings& near : around) {
      if (!near.box.contains(now) && !near.box.contains(from)) continue;
      const double way = (now - from).norm();
      if (way > near.longest) share = std::min(share, near.longest / way);
      strides = std::max(strides, way / near.stride);
    }
  }
  return shareOutside(share, static_cast<int>(std::ceil(share * strides)), before);
}

// How much of that share of the way from `start` to the shape takes no point deep into a link:
// looked at stride by stride, up to the last before one that does; within the first, by halves.
// Where there is time for the contacts of the shape only, it goes no farther than it was looked at.
// Deeper than the middle of a link, the nearest way out is on the far side, and the side on which a
// point came in is no longer known.
double ToolContactUpdate::shareOutside(double share, int strides,
                                       const std::vector<Vec3>& start) const {
  std::vector<double> before = touch_finder_.depths();
  bool is_before_whole = false;
  const auto is_deep = [&](double part) {
    const std::vector<double> depths = depthsAt(part, start);
    for (std::size_t link = 0; link < depths.size(); ++link) {
      const double thickness = world_.thicknessNear(link, world_.pose.links[link]);
      const double most = std::min(tuning::kDeepestOnWay * world_.tissue.lattice().spacing(),
                                   tuning::kDeepestOfThickness * thickness);
      if (depths[link] <= most) continue;
      const auto goes_deeper = [&] {
        const double at_start = link < before.size() ? before[link] : 0.0;
        return depths[link] > at_start + tuning::kDepthGrowth * most;
      };
      if (!goes_deeper()) continue;
      if (!std::exchange(is_before_whole, true)) before = depthsAt(0.0, start);
      if (goes_deeper()) return true;
    }
    return false;
  };
  for (int stride = 1; stride <= strides; ++stride) {
    const bool is_over = stride > 1 && hasTimeForContactsOnly();
    if (!is_over && !is_deep(share * stride / strides)) continue;
    if (stride > 1) return share * (stride - 1) / strides;
    share /= strides;
    for (int trial = 1; trial < tuning::kDepthTrials && !hasTimeForContactsOnly(); ++trial) {
      share *= 0.5;
      if (!is_deep(share)) return share;
    }
    return 0.5 * share;
  }
  return share;
}

// Another look at the way takes about as long as the contacts do, which are found after it.
bool ToolContactUpdate::hasTimeForContactsOnly() const {
  return world_.deadline.leftMs() < 2.0 * contacts_ms_;
}

// depthsIn of the shape at that share of the way from `start`: where Tissue goes back to it, what
// was found is found.
std::vector<double> ToolContactUpdate::depthsAt(double share,
                                                const std::vector<Vec3>& start) const {
  if (share == 1.0) return depthsIn(now_);
  std::vector<Vec3> there = world_.tissue.state().displacement;
  takeBack(start, share, there);
  std::vector<Vec3> vertices;
  deform(world_.tissue.surface(), there, vertices);
  return depthsIn(vertices);
}

// Per link of the tools: depth of the deepest point that gives way (m). Of the contacts that are
// asked for next where the shape stays.
std::vector<double> ToolContactUpdate::depthsIn(const std::vector<Vec3>& vertices) const {
  const std::vector<std::uint8_t> held = world_.sticking.heldNodes(world_.tissue);
  std::vector<double> depths(world_.tools.linkCount(), 0.0);
  for (const Contact& contact : touch_finder_.contactsOf(world_.pose, vertices).contacts) {
    if (contact.depth_m <= 0.0) continue;
    if (at(contact.link) >= depths.size() || world_.tools.isRigid(contact.tool)) continue;
    if (world_.isInWound(at(contact.link))) continue;
    if (!SlidingContacts::givesWay(contact, world_.tissue, held)) continue;
    const double depth = touch_finder_.ownDepth(contact, contact.depth_m);
    depths[at(contact.link)] = std::max(depths[at(contact.link)], depth);
  }
  return depths;
}

ToolContactUpdate::Touches ToolContactUpdate::takeSurface() {
  if (surface_revision_ == world_.tissue.surface().revision) return Touches::kOfThisSurface;
  surface_revision_ = world_.tissue.surface().revision;
  const bool goes_on = world_.sliding.takeSurface(world_.pose, world_.tissue);
  world_.sticking.takeCells(world_.tissue);
  touch_finder_.beginStep();
  return goes_on ? Touches::kGoOn : Touches::kMetAnew;
}

void ToolContactUpdate::beginAnew() {
  takeSurface();
  left_inside_ = 0.0;
}

// The shape was solved for the contacts of before: are they those of the shape?
bool ToolContactUpdate::renew(std::vector<LoadingPatch>& of_tools, Shape shape, Round round) {
  contacts_ms_ = 0.0;
  const Stopwatch watch(contacts_ms_);
  const Touches touches = takeSurface();
  const std::vector<std::uint8_t> held = world_.sticking.heldNodes(world_.tissue);
  ContactSet contacts = touch_finder_.touchesAt(world_.pose, held);
  left_inside_ = 0.0;
  for (const Contact& contact : contacts.contacts) {
    const bool is_at_rim = contact.rim.share > 0.0;
    const double recess = std::max(0.0, world_.sliding.recessOf(contact.link));
    const double of_columns = world_.sliding.columnRecess(contact.link, contact.columns);
    const double depth = is_at_rim ? touch_finder_.ownDepth(contact, contact.depth_m)
                                   : contact.depth_m - recess - of_columns;
    left_inside_ = std::max(left_inside_, depth);
  }
  if (touches == Touches::kMetAnew) {
    world_.sliding.ride(world_.pose, world_.tissue);
    world_.sliding.meet(contacts, world_.pose, world_.tissue, held);
  } else if (touches == Touches::kOfThisSurface) {
    touch_finder_.wanderPartOfWay(world_.pose, contacts);
    const bool settled = world_.sliding.update(touch_finder_.trackTouches(world_.pose, contacts),
                                               contacts, world_.pose, world_.tissue, held, shape);
    if (world_.tissue.goesThroughTime()) return false;
    if (settled && (!world_.tissue.isUntouched() || world_.sliding.touches().empty())) return false;
  }
  if (round == Round::kLast) return true;
  of_tools = patchesOfTools(world_);
  if (!of_tools.empty() || touches != Touches::kOfThisSurface) return true;
  return pushesStill(world_.tissue);
}

double ToolContactUpdate::deepestShown() {
  const Stopwatch watch(world_.report.contact_ms);
  const std::vector<double> depths = deepestPoints(world_, touch_finder_);
  return std::accumulate(depths.begin(), depths.end(), left_inside_,
                         [](double a, double b) { return std::max(a, b); });
}

}  // namespace robot_tissue
