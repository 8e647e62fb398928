#include "placed_link.h"

#include "tuning.h"

namespace robot_tissue {
namespace {

Box placedBounds(const CollisionShape& shape, const Pose& tissue_T_shape) {
  if (shape.isPlane()) return {Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)};
  const Box& box = shape.bounds();
  const Vec3 center = tissue_T_shape * Vec3(0.5 * (box.min() + box.max()));
  const Vec3 reach = tissue_T_shape.linear().cwiseAbs() * (0.5 * (box.max() - box.min()));
  return {center - reach, center + reach};
}

}  // namespace

bool isRigid(const Pose& pose) {
  if (!pose.matrix().allFinite()) return false;
  const Eigen::Matrix3d rotation = pose.linear();
  return (rotation.transpose() * rotation).isIdentity(tuning::kRigidSlack) &&
         rotation.determinant() > 0.0;
}

PlacedLink placed(const std::vector<CollisionShape>& shapes, const Pose& tissue_T_link) {
  PlacedLink link;
  if (!isRigid(tissue_T_link)) return link;
  for (const CollisionShape& shape : shapes) {
    const Pose tissue_T_shape = tissue_T_link * shape.poseInLink();
    link.push_back(
        {&shape, tissue_T_shape, tissue_T_shape.inverse(), placedBounds(shape, tissue_T_shape)});
  }
  return link;
}

Box boundsOf(const PlacedLink& link) {
  Box box;
  for (const PlacedShape& shape : link) box.extend(shape.bounds);
  return box;
}

std::optional<WayOut> wayOut(const PlacedLink& link, const Vec3& point, double reach,
                             double bound) {
  std::optional<WayOut> best;
  for (const PlacedShape& placed : link) {
    const auto found = placed.shape->distanceNear(placed.shape_T_tissue * point, reach, bound);
    if (!found || (best && -found->value <= best->depth_m)) continue;
    best = WayOut{-found->value, placed.tissue_T_shape.linear() * found->slope};
  }
  return best;
}

}  // namespace robot_tissue
