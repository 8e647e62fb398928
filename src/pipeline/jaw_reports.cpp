// Grasping: what is told of jaws.
#include <sstream>

#include "grasping.h"

namespace robot_tissue {
namespace {

std::string inMeters(double length) {
  std::ostringstream text;
  text << " (" << length << " m)";
  return text.str();
}

}  // namespace

std::string Grasping::whyItHoldsNothing(std::size_t tool, bool is_asked) const {
  if (!world_.last_pose || grasps(tool) || !hasJaws(tool, world_.pose)) return "";
  const Jaws& jaws = jaws_[tool];
  const GraspConfig& grasp = world_.tools[tool].grasp;
  const auto gap = gapAtTissue(tool, world_.pose);
  if (!gap) {
    const bool closed = *leastGap(tool, world_.pose, grasp.close_gap) < grasp.close_gap;
    return closed || is_asked ? "no tissue is between its jaws" : "";
  }
  const std::string open_first =
      ": its jaws must first open farther than grasp.open_gap" + inMeters(grasp.open_gap);
  if (jaws.state == Jaws::State::kClosed) {
    switch (jaws.loss) {
      case Jaws::Loss::kClosedBefore:
        return "its jaws were closed before tissue came between them" + open_first;
      case Jaws::Loss::kReleased:
        return "it was told to let go" + open_first;
      case Jaws::Loss::kTorn:
        return "it was pulled harder than it holds (grasp.max_force)" + open_first;
    }
  }
  if (*gap < grasp.close_gap) return "what is between its jaws is fixed, or held by others";
  const bool presses =
      pushesWith(world_.tools.firstJaw(tool)) && pushesWith(world_.tools.firstJaw(tool) + 1);
  if (!presses && !is_asked) return "";
  return "where tissue is, its jaws are not closer than grasp.close_gap" +
         inMeters(grasp.close_gap);
}

bool Grasping::jawsOverlap(std::size_t tool) const {
  if (!world_.last_pose || !jaws_[tool].were_apart) return false;
  const auto gap = leastGap(tool, world_.report.lost ? world_.asked : world_.pose, 0.0);
  return gap && *gap <= 0.0;
}

}  // namespace robot_tissue
