// Pipeline: how long the tools' ways are, in load steps, and which of them are free.
#include <algorithm>
#include <limits>

#include "box_distance.h"
#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {
namespace {

constexpr double kShareOfTool = 0.25;  // of a link's thickness: its longest step

}  // namespace

// Longest step of a link (m): no thin one is through what it meets.
double Pipeline::stepOf(std::size_t link) const {
  return std::min(tissue_.stepLength(), kShareOfTool * finder_.thickness(link));
}

double Pipeline::stepsTo(const RobotPose& pose) const {
  return last_pose_ ? stepsBetween(*last_pose_, driven(pose)) : 0.0;
}

std::vector<std::size_t> Pipeline::jumpsTo(const RobotPose& pose) const {
  return last_pose_ ? farFrom(*last_pose_, driven(pose)) : std::vector<std::size_t>();
}

double Pipeline::freeStepsTo(const RobotPose& pose) const {
  return last_pose_ ? freeSteps(*last_pose_, driven(pose)) : 0.0;
}

// Tools that jump, but for those that pass the tissue by.
std::vector<std::size_t> Pipeline::farFrom(const RobotPose& from, const RobotPose& goal) const {
  std::vector<std::size_t> far;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    const RobotPose alone = withTool(tool, goal, from);
    if (stepsBetween(from, alone) > kMostLoadSteps && !passesBy(tool, from, goal)) {
      far.push_back(tool);
    }
  }
  return far;
}

double Pipeline::stepsBetween(const RobotPose& from, const RobotPose& to) const {
  double steps = 0.0;
  for (std::size_t link = 0; link < to.links.size(); ++link) {
    const double way = longestWay(from.links[link], to.links[link], finder_.reach(link));
    steps = std::max(steps, way / stepOf(link));
  }
  return steps;
}

// Steps that every link on its way may go from here before it can touch.
double Pipeline::freeSteps(const RobotPose& from, const RobotPose& to) const {
  double steps = std::numeric_limits<double>::infinity();
  for (std::size_t link = 0; link < first_link_[tools_.size()]; ++link) {
    if (longestWay(from.links[link], to.links[link], finder_.reach(link)) == 0.0) continue;
    const Box box = finder_.bounds(link, from.links[link]);
    steps = std::min(steps, distance(box, tissue_.bounds()) / stepOf(link));
  }
  return steps;
}

bool Pipeline::touchesTissue(std::size_t tool) const {
  const auto is_of_tool = [&](const auto& touch) { return at(touch.tool) == tool; };
  const auto& touches = contacts_.touches();
  const auto& patches = tissue_.patches();
  return patches_.holds(static_cast<int>(tool)) ||
         std::any_of(touches.begin(), touches.end(), is_of_tool) ||
         std::any_of(patches.begin() + static_cast<std::ptrdiff_t>(tissue_.namedPatches()),
                     patches.end(), [&](const auto& patch) { return patch.name == names_[tool]; });
}

// It touches and holds nothing, and on its way it neither comes near tissue nor has any between its
// links. No point of a link is farther from both ends of its way than half of that.
bool Pipeline::passesBy(std::size_t tool, const RobotPose& from, const RobotPose& to) const {
  if (touchesTissue(tool)) return false;
  Box around;
  around.min.setConstant(std::numeric_limits<double>::infinity());
  around.max = -around.min;
  for (std::size_t link = first_link_[tool]; link < first_link_[tool + 1]; ++link) {
    const double way = longestWay(from.links[link], to.links[link], finder_.reach(link));
    for (const RobotPose* pose : {&from, &to}) {
      const Box box = finder_.bounds(link, pose->links[link]);
      around.min = around.min.cwiseMin((box.min.array() - 0.5 * way).matrix());
      around.max = around.max.cwiseMax((box.max.array() + 0.5 * way).matrix());
    }
  }
  return distance(around, tissue_.bounds()) >= tissue_.lattice().spacing();
}

void Pipeline::passTo(const RobotPose& pose) {
  pose_ = pose;
  contacts_.pass(pose);
  openJaws();
  closeJaws();
}

}  // namespace robot_tissue
