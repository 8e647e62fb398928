#include "surface_tree.h"

#include "robot_tissue/core/same_bits.h"

namespace robot_tissue {

const TriangleBvh& SurfaceTree::of(const TissueSurface& surface,
                                   const std::vector<Vec3>& vertices) {
  if (!isOf(surface)) {
    revision_ = surface.revision;
    tree_.emplace(surface.rest, surface.triangles);
    ++trees_;
    ++moves_;
  }
  if (areSame(vertices, tree_->vertices())) return *tree_;
  if (tree_->moveTo(vertices)) ++moves_;
  return *tree_;
}

bool SurfaceTree::isOf(const TissueSurface& surface) const {
  if (!tree_) return false;
  if (surface.revision != 0 || revision_ != 0) return surface.revision == revision_;
  return surface.triangles == tree_->triangles() && areSame(surface.rest, tree_->madeOf());
}

}  // namespace robot_tissue
