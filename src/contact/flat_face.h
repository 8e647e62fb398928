// Flat faces with sharp edges of a link's shapes, and where a point is from their edges (own).
// Boxes and cylinders' ends by formula; of meshes the edges where they fold outwards.
#pragma once

#include <optional>

#include "placed_link.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue {

bool hasFlatFaces(const CollisionShape& shape);

// As ContactFinder::flatFace.
std::optional<FlatFace> flatFaceOf(const PlacedLink& link, const Vec3& facing, const Vec3& point,
                                   double reach);

}  // namespace robot_tissue
