// Pipeline: tools that come near.
#include "box_distance.h"
#include "pipeline_parts.h"
#include "tuning.h"

namespace robot_tissue {

// The first solve makes the solver's levels, which takes longer than many solves do: where a tool
// comes near untouched tissue they are made before it touches. Not in the call in which it came
// near, which made the tree over the surface.
void Pipeline::expectTouch() {
  const Tissue& tissue = world_.tissue;
  if (world_.report.solve_ms > 0.0 || !tissue.isUntouched() || tissue.hasTime()) return;
  bool is_near = false;
  for (std::size_t link = 0; link < world_.tools.linkCount() && !is_near; ++link) {
    const Pose& pose = world_.pose.links[link];
    if (ToolSet::isAway(pose)) continue;
    is_near = distance(world_.finder.bounds(link, pose), tissue.bounds()) <
              tuning::kExpectedFrom * tissue.lattice().spacing();
  }
  if (is_near && state_.was_near) world_.tissue.expectTouch();
  state_.was_near = is_near;
}

}  // namespace robot_tissue
