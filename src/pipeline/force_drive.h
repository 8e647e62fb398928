// Tools that a force drives along its line from their pose.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/types.h"
#include "tool_set.h"

namespace robot_tissue {

class ForceDrive {
 public:
  void setTools(std::size_t count) { drives_.assign(count, {}); }

  // On the tissue (N, tissue frame); none: the tool is at its pose. Finite and not zero. Another
  // force along the same line goes on from where the tool came.
  void push(std::size_t tool, const std::optional<Vec3>& force);
  bool drives(std::size_t tool) const { return drives_[tool].force.has_value(); }
  bool drivesAny() const;
  bool isMet(std::size_t tool, const Vec3& met) const;  // by a force on the tissue (N)
  // Whether the force was met, and is not any more, as tools that were moved after it changed the
  // shape; not for ever. `met`: on the tissue (N), now.
  bool isPushedOff(std::size_t tool, const Vec3& met);
  // Less than the force met it where its way ended.
  bool isUnanswered(std::size_t tool) const { return drives_[tool].unanswered; }
  Vec3 offset(std::size_t tool) const;  // of where it is to go, from its pose (m)
  Vec3 came(std::size_t tool) const;    // of where it came on that way, likewise
  // The pose with the tools where their forces move them.
  RobotPose driven(RobotPose pose, const ToolSet& tools) const;
  // Where the tools, told to be in the pose, came in fact.
  void noteReached(const RobotPose& pose, const RobotPose& reached, const ToolSet& tools);
  // What is left of their ways, which no shape follows, is not tried again.
  void stay();

  // Moves the tool until its force is met: load steps until it touches, then by the secant through
  // the last two. `longest`: a load step (m); `met`: the force on the tissue (N); `walk`: takes the
  // tool there, false: goes no farther; `lost`: no shape could follow. True: there is a way left,
  // and the last calls came nearer.
  struct Way {
    double longest = 0.0;
    std::function<Vec3()> met;
    std::function<bool()> walk;
    std::function<bool()> lost;
  };
  bool meetForce(std::size_t tool, const Way& way);

  // What a shape that time ran out in answers is not what it will: corrections wait for its end.
  // Not for ever, as not all have one.
  bool waits(std::size_t tool, bool is_late);

 private:
  struct Drive {
    std::optional<Vec3> force;  // N
    double way = 0.0;           // where it is to go along the force, from its pose (m)
    double came = 0.0;          // of it (m)
    double off = kInfinity;     // from the force, where the calls that left a way ended (N)
    int waits = 0;              // in a row
    bool was_met = false;       // where the last call ended
    int pushed_off = 0;         // calls in a row after which it was
    bool unanswered = false;
  };

  class Search;

  std::vector<Drive> drives_;
};

}  // namespace robot_tissue
