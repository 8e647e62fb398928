#include "way_lengths.h"

#include <algorithm>
#include <limits>

#include "box_distance.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "tuning.h"

namespace robot_tissue {

// Longest step of a link (m): no thin one is through what it meets.
double WayLengths::stepOf(std::size_t link) const {
  return std::min(world_.tissue.stepLength(),
                  tuning::kStepOfThickness * world_.finder.thickness(link));
}

double WayLengths::stepsBetween(const RobotPose& from, const RobotPose& to) const {
  double steps = 0.0;
  for (std::size_t link = 0; link < to.links.size(); ++link) {
    const double way = longestWay(from.links[link], to.links[link], world_.finder.reach(link));
    steps = std::max(steps, way / stepOf(link));
  }
  return steps;
}

// Tools that jump, but for those that pass the tissue by.
std::vector<std::size_t> WayLengths::farFrom(const RobotPose& from, const RobotPose& goal) const {
  std::vector<std::size_t> far;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    const RobotPose alone = world_.tools.withTool(tool, goal, from);
    if (stepsBetween(from, alone) > Pipeline::kMostLoadSteps && !passesBy(tool, from, goal)) {
      far.push_back(tool);
    }
  }
  return far;
}

// Steps that every link on its way may go from here before it can touch.
double WayLengths::freeSteps(const RobotPose& from, const RobotPose& to) const {
  double steps = std::numeric_limits<double>::infinity();
  for (std::size_t link = 0; link < world_.tools.linkCount(); ++link) {
    if (longestWay(from.links[link], to.links[link], world_.finder.reach(link)) == 0.0) continue;
    const Box box = world_.finder.bounds(link, from.links[link]);
    steps = std::min(steps, distance(box, world_.tissue.bounds()) / stepOf(link));
  }
  return steps;
}

bool WayLengths::touchesTissue(std::size_t tool) const {
  const auto is_of_tool = [&](const auto& touch) { return at(touch.tool) == tool; };
  const auto& touches = world_.sliding.touches();
  const auto& patches = world_.tissue.patches();
  return world_.sticking.holds(static_cast<int>(tool)) ||
         std::any_of(touches.begin(), touches.end(), is_of_tool) ||
         std::any_of(patches.begin() + static_cast<std::ptrdiff_t>(world_.tissue.namedPatches()),
                     patches.end(),
                     [&](const auto& patch) { return patch.name == world_.tools.nameOf(tool); });
}

// It touches and holds nothing, and on its way it neither comes near tissue nor has any between its
// links. No point of a link is farther from both ends of its way than half of that.
bool WayLengths::passesBy(std::size_t tool, const RobotPose& from, const RobotPose& to) const {
  if (touchesTissue(tool)) return false;
  Box around;
  for (std::size_t link = world_.tools.firstLink(tool); link < world_.tools.endLink(tool); ++link) {
    const double way = longestWay(from.links[link], to.links[link], world_.finder.reach(link));
    for (const RobotPose* pose : {&from, &to}) {
      const Box box = world_.finder.bounds(link, pose->links[link]);
      around.extend(grownBy(0.5 * way, box));
    }
  }
  return distance(around, world_.tissue.bounds()) >= world_.tissue.lattice().spacing();
}

bool WayLengths::isAt(std::size_t tool, const RobotPose& here, const RobotPose& there) const {
  const double still = tuning::kStandsStill * world_.tissue.lattice().spacing();
  for (std::size_t link = world_.tools.firstLink(tool); link < world_.tools.endLink(tool); ++link) {
    if (longestWay(here.links[link], there.links[link], world_.finder.reach(link)) > still) {
      return false;
    }
  }
  return true;
}

}  // namespace robot_tissue
