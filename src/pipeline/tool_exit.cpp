// Pipeline: where a line leaves the tools. Found when it is asked for: an update needs none of it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline_parts.h"
#include "tuning.h"

namespace robot_tissue {

// By strides that are safe, as the distance to a shape's surface is (sphere tracing, Hart 1996).
double Pipeline::exitOf(const RobotPose& pose, const Vec3& point, const Vec3& direction,
                        double farthest) const {
  const double least = tuning::kExitStride * world_.tissue.lattice().spacing();
  double left_at = 0.0;
  for (double gone = 0.0; gone <= farthest;) {
    double depth = -std::numeric_limits<double>::infinity();
    for (std::size_t link = 0; link < world_.tools.linkCount(); ++link) {
      const auto out =
          world_.finder.wayOut(link, pose.links[link], point + gone * direction, farthest);
      if (out) depth = std::max(depth, out->depth_m);
    }
    if (depth > -least) left_at = gone;
    gone += std::max(std::abs(depth), least);
  }
  return std::min(left_at + least, farthest);
}

}  // namespace robot_tissue
