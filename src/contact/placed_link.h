// A link's shapes where they are now.
#pragma once

#include <optional>
#include <vector>

#include "collision_shape.h"
#include "robot_tissue/contact/contact_finder.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct PlacedShape {
  const CollisionShape* shape = nullptr;
  Pose tissue_T_shape = Pose::Identity();
  Pose shape_T_tissue = Pose::Identity();
  Box bounds;  // tissue frame (m), may be infinite
};

using PlacedLink = std::vector<PlacedShape>;

// Finite, and a rotation and a shift.
bool isRigid(const Pose& pose);

// No shapes when the pose is not rigid: such a link touches nothing.
PlacedLink placed(const std::vector<CollisionShape>& shapes, const Pose& tissue_T_link);
Box boundsOf(const PlacedLink& link);

// The deepest of the shapes at a point; all in the tissue's frame. `bound` (m): where the point's
// signed distance from the link is known to be no greater, whatever its sign, that is found sooner.
std::optional<WayOut> wayOut(const PlacedLink& link, const Vec3& point, double reach,
                             double bound = kInfinity);

}  // namespace robot_tissue
