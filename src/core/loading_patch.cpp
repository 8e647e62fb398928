#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

bool holds(const LoadingPatch& patch, std::size_t axis) {
  return patch.drive == LoadingPatch::Drive::kForce || !patch.free_axis[axis];
}

// Mean as the first node's plus the mean difference to it: exact for a patch that moved as one.
Vec3 meanDisplacement(const LoadingPatch& patch, const std::vector<Vec3>& displacement) {
  if (patch.nodes.empty()) return Vec3::Zero();
  const Vec3& first = displacement[at(patch.nodes.front())];
  Vec3 difference = Vec3::Zero();
  for (const int node : patch.nodes) difference += displacement[at(node)] - first;
  return first + difference / static_cast<double>(patch.nodes.size());
}

}  // namespace robot_tissue
