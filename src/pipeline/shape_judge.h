// Whether a shape that was solved for is one that tissue gets into.
#pragma once

#include <cstddef>
#include <vector>

#include "checkpoint.h"
#include "tool_contact_update.h"
#include "touch_finder.h"
#include "world.h"

namespace robot_tissue {

class ShapeJudge {
 public:
  ShapeJudge(const World& world, const TouchFinder& touch_finder,
             const ToolContactUpdate& contact_update)
      : world_(world), touch_finder_(touch_finder), contact_update_(contact_update) {}

  // Whether the shape is none that tissue gets into from the last good one: it leapt, has more
  // inverted cells, a link went through its surface, or a touch pushes harder than any tissue does.
  bool isLost(const Checkpoint& good) const;
  // The same where there is no last good one.
  bool isOfNoTissue() const;
  // Whether the solve ended before it was done, as where tissue slips far: a point is left too deep
  // or, unconverged, the forces on the tissue do not add up to zero.
  bool isUnsettled() const;
  // Whether one of these links stands deeper in the surface than tissue that gives way lets it.
  bool isAnyThrough(const std::vector<std::size_t>& links, const RobotPose& pose) const;

 private:
  bool leaptFrom(const Checkpoint& good) const;
  bool turnedOver(const Checkpoint& good) const;
  bool wentThrough(const std::vector<double>& depths_before) const;
  bool isSwallowed(const SlidingContacts& contacts_before) const;
  double throughAt(std::size_t link, const RobotPose& pose) const;

  const World& world_;
  const TouchFinder& touch_finder_;
  const ToolContactUpdate& contact_update_;
};

}  // namespace robot_tissue
