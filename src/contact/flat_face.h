// The flat face of a link at a point, and where the point is from its edges (own; doc/contact.md,
// "The rim").
#pragma once

#include <optional>

#include "placed_link.h"
#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue {

// As ContactFinder::flatFace.
std::optional<FlatFace> flatFaceOf(const PlacedLink& link, const Vec3& facing, const Vec3& point,
                                   double reach);

}  // namespace robot_tissue
