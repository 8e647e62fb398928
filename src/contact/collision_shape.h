// One collision shape of a tool: an FCL object that is built once and asked point by point.
// Padding is extra reach: a point is inside when it is nearer than the padding. This is exact for
// every type of shape; a padded box or cylinder has rounded edges.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "convex_hull.h"
#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class CollisionShape {
 public:
  // `owner` begins messages and warnings. Throws InputError: a measure that is not positive, a
  // mesh that cannot be loaded or has no volume.
  CollisionShape(const ToolShape& shape, double padding, const std::string& owner,
                 std::vector<std::string>& warnings);
  ~CollisionShape();
  CollisionShape(CollisionShape&&) noexcept;

  // For a point in the shape's own frame (m); nothing when it is outside the padded shape.
  std::optional<WayOut> wayOut(const Vec3& point) const;

  const Pose& poseInLink() const { return pose_in_link_; }
  const Box& bounds() const { return bounds_; }    // padded, shape's own frame (m)
  double thickness() const { return thickness_; }  // padded, smallest width (m)

 private:
  struct FclObjects;

  void buildPrimitive(const ToolShape& shape, const std::string& owner);
  void buildHull(const ToolShape& shape, const std::string& owner,
                 std::vector<std::string>& warnings);
  bool overlaps(const Vec3& point) const;
  std::optional<WayOut> wayOutOfPrimitive(const Vec3& point) const;

  Pose pose_in_link_;
  double padding_;
  double thickness_ = 0.0;
  Box bounds_;
  std::unique_ptr<FclObjects> fcl_;
  std::optional<ConvexHull> hull_;  // meshes
};

}  // namespace robot_tissue
