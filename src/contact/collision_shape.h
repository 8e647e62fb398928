// One collision shape of a link, asked point by point for its signed distance.
// Padding is extra reach: a point is inside when it is nearer than the padding. This is exact for
// every type of shape; a padded box or cylinder has rounded edges.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/types.h"
#include "signed_distance.h"
#include "tool_mesh.h"

namespace robot_tissue {

class CollisionShape {
 public:
  // `owner` begins messages and warnings. Throws InputError: a measure that is not positive, a
  // padding that is negative, a mesh that cannot be loaded or has no inside.
  CollisionShape(const ToolShape& shape, const std::string& owner,
                 std::vector<std::string>& warnings);

  // For points in the shape's own frame (m). Distances are from the padded shape.
  SignedDistance distance(const Vec3& point) const;
  // Of a point that is not farther than `bound` (m) from the padded surface.
  SignedDistance distanceWithin(const Vec3& point, double bound) const;
  // Nothing when the point is farther than `reach` (m), or not finite. With a bound (m), a mesh
  // whose padded surface is farther from the point than that, inside or outside, may say nothing.
  std::optional<SignedDistance> distanceNear(const Vec3& point, double reach,
                                             double bound = kInfinity) const;
  // Where the padded shape reaches farthest in a unit direction; not for meshes and planes.
  Vec3 farthest(const Vec3& direction) const;

  bool isMesh() const { return mesh_ != nullptr; }
  bool isPlane() const { return shape_.type == ToolShape::Type::kPlane; }
  const ToolMesh& mesh() const { return *mesh_; }
  const ToolShape& measures() const { return shape_; }
  double padding() const { return shape_.padding; }
  const Pose& poseInLink() const { return shape_.pose; }
  const Box& bounds() const { return bounds_; }    // padded, shape's own frame (m); may be infinite
  double thickness() const { return thickness_; }  // padded, smallest width (m); infinite: plane

 private:
  void measurePrimitive(const std::string& owner);
  void measureMesh(const std::string& owner, std::vector<std::string>& warnings);
  SignedDistance unpadded(const Vec3& point) const;

  ToolShape shape_;
  Box bounds_;
  double thickness_ = 0.0;
  std::shared_ptr<const ToolMesh> mesh_;
};

}  // namespace robot_tissue
