// Pipeline: tools that part tissue on their way.
#include <utility>

#include "pipeline_parts.h"

namespace robot_tissue {

// What blades and scissors sweep and burrs cover to where the tools have come. False: there is a
// way left to go.
bool Pipeline::partAlongWay() {
  const bool drilled = parts_->burrs.goTo(*world_.last_pose);
  const bool sheared = parts_->scissors.goTo(*world_.last_pose);
  const bool arrived = parts_->blades.goTo(*world_.last_pose) && drilled && sheared;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (world_.tools[tool].role.touches()) continue;
    world_.pose = world_.tools.withTool(tool, *world_.last_pose, std::move(world_.pose));
  }
  world_.report.too_fast = world_.report.too_fast || !arrived;
  // Shapes to go back to may have patches on what is gone.
  const bool comes_back = world_.report.volume_removed > 0.0 ||
                          (world_.tools.anyRigid() && world_.report.springs_cut > 0);
  if (comes_back) parts_->motion.checkInAnew();
  return arrived;
}

}  // namespace robot_tissue
