#include "way_lengths.h"

#include <algorithm>
#include <limits>

#include "box_distance.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "tuning.h"

namespace robot_tissue {

// A thin link must not be through the tissue before it is met.
double WayLengths::stepOf(std::size_t link, const Pose& tissue_T_link) const {
  return std::min(world_.tissue.stepLength(),
                  tuning::kStepOfThickness * world_.thicknessNear(link, tissue_T_link));
}

double WayLengths::wayOf(std::size_t link, const RobotPose& from, const RobotPose& to) const {
  return longestWay(from.links[link], to.links[link], world_.corners(link));
}

// A point of a link is never farther than half of its way from the nearer end.
double WayLengths::stepOf(std::size_t link, const RobotPose& from, const RobotPose& to) const {
  const double half = 0.5 * wayOf(link, from, to);
  const double thickness = std::min(world_.thicknessNear(link, from.links[link], half),
                                    world_.thicknessNear(link, to.links[link], half));
  return std::min(world_.tissue.stepLength(), tuning::kStepOfThickness * thickness);
}

double WayLengths::stepsBetween(const RobotPose& from, const RobotPose& to) const {
  double steps = 0.0;
  for (std::size_t link = 0; link < to.links.size(); ++link) {
    const double way = wayOf(link, from, to);
    steps = std::max(steps, way / stepOf(link, from, to));
  }
  return steps;
}

// Tools whose way is a jump, but for those that pass the tissue by.
std::vector<std::size_t> WayLengths::farFrom(const RobotPose& from, const RobotPose& goal) const {
  std::vector<std::size_t> far;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    double steps = 0.0;
    for (std::size_t link = world_.tools.firstLink(tool); link < world_.tools.endLink(tool);
         ++link) {
      const double way = wayOf(link, from, goal);
      // An edge that is too thin to be met in longer steps goes in.
      const bool cuts = world_.tools[tool].role.has_edge;
      steps = std::max(steps, way / (cuts ? world_.tissue.stepLength() : stepOf(link, from, goal)));
    }
    if (steps > Pipeline::kMostLoadSteps && !passesBy(tool, from, goal)) far.push_back(tool);
  }
  return far;
}

// Load steps before any link that moves can reach the tissue's box.
double WayLengths::freeSteps(const RobotPose& from, const RobotPose& to) const {
  double steps = std::numeric_limits<double>::infinity();
  for (std::size_t link = 0; link < world_.tools.linkCount(); ++link) {
    if (wayOf(link, from, to) == 0.0) continue;
    const Box box = world_.bounds(link, from.links[link]);
    steps = std::min(steps, distance(box, world_.tissue.bounds()) / stepOf(link, from, to));
  }
  return steps;
}

bool WayLengths::touchesTissue(std::size_t tool) const {
  const auto is_of_tool = [&](const auto& touch) { return at(touch.contact.tool) == tool; };
  const auto& touches = world_.sliding.touches();
  const auto& patches = world_.tissue.patches();
  return world_.sticking.holds(static_cast<int>(tool)) ||
         std::any_of(touches.begin(), touches.end(), is_of_tool) ||
         std::any_of(patches.begin(), patches.end(),
                     [&](const auto& patch) { return patch.tool == static_cast<int>(tool); });
}

// Whether the tool touches and holds nothing, and on its way neither comes nearer than a spacing to
// the tissue's box nor has it between its links. A point of a link is never farther than half of
// its way from the nearer end, so the boxes at both ends are grown by that.
bool WayLengths::passesBy(std::size_t tool, const RobotPose& from, const RobotPose& to) const {
  if (touchesTissue(tool)) return false;
  Box around;
  for (std::size_t link = world_.tools.firstLink(tool); link < world_.tools.endLink(tool); ++link) {
    const double way = wayOf(link, from, to);
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
    if (wayOf(link, here, there) > still) {
      return false;
    }
  }
  return true;
}

}  // namespace robot_tissue
