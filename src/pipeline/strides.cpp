#include "strides.h"

#include <algorithm>

#include "robot_tissue/pipeline/between.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

std::vector<Pose> between(const std::vector<Pose>& from, const std::vector<Pose>& to,
                          double share) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < from.size(); ++i) {
    poses.push_back(robot_tissue::between(from[i], to[i], share));
  }
  return poses;
}

// Of the points of the links, the longest (m).
double longestOf(const World& world, Links links, const std::vector<Pose>& from,
                 const std::vector<Pose>& to) {
  double way = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    way = std::max(way, longestWay(from[i], to[i], world.reach(links.first + i)));
  }
  return way;
}

// It stands nowhere, or came from nowhere, or jumped.
bool comesAnew(World& world, std::size_t tool, Links links, const std::vector<Pose>& there,
               Strides& strides) {
  if (std::any_of(there.begin(), there.end(), ToolSet::isAway)) {
    strides = Strides();
    return true;
  }
  const bool was_away = strides.stands.empty();
  const double way = was_away ? 0.0 : longestOf(world, links, strides.stands, there);
  const bool jumps = way > Pipeline::kMostLoadSteps * world.tissue.stepLength();
  if (jumps) addOnce(tool, world.report.jumped);
  if (was_away || jumps) strides = {there, 0.0};
  return was_away || jumps;
}

}  // namespace

bool goInStrides(World& world, std::size_t tool, Links links, const StrideActions& actions,
                 Strides& strides, RobotPose& pose) {
  const auto first = pose.links.begin() + static_cast<std::ptrdiff_t>(links.first);
  const auto end = pose.links.begin() + static_cast<std::ptrdiff_t>(links.end);
  const std::vector<Pose> there(first, end);
  if (comesAnew(world, tool, links, there, strides)) {
    actions.forget();
    return true;
  }
  const std::vector<Pose> from = strides.stands;
  const double way = longestOf(world, links, from, there);
  const auto goTo = [&](std::vector<Pose> place) {
    actions.move(place);
    strides.stands = std::move(place);
  };
  if (world.is_trial) {
    goTo(there);
    return true;
  }
  for (double gone = 0.0; gone < way;) {
    const double rest = actions.length - strides.way;
    const bool ends_stride = gone + rest <= way + tuning::kStrideRounding * actions.length;
    const double next = ends_stride ? std::min(gone + rest, way) : way;
    goTo(between(from, there, next / way));
    strides.way += next - gone;
    gone = next;
    if (ends_stride) {
      strides.way = 0.0;
      actions.act();
    }
    if (gone >= way || !world.deadline.isOver()) continue;
    std::copy(strides.stands.begin(), strides.stands.end(), first);
    return false;
  }
  return true;
}

}  // namespace robot_tissue
