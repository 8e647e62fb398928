// The surface around a point, as a thread holds it that goes through tissue there (own).
#pragma once

#include <vector>

#include "robot_tissue/core/surface.h"

namespace robot_tissue {

struct HeldSurface {
  std::vector<NodeWeight> carriers;  // nodes ascending; weights not 0, 1 in all; empty: nothing
  Vec3 middle = Vec3::Zero();        // of what is held, at rest (m)
};

// What is nearer than `radius` (m) to the point at rest and hangs together with it there, so only
// its own side of a cut; its weight goes from the middle as 1 - (distance / radius)^2. Unlike a
// point, which under a force sinks in the deeper the finer the lattice is, it has a stiffness that
// does not hang on the spacing, once that is smaller. Nothing: the radius is no length beside the
// triangle.
HeldSurface heldAround(const TissueSurface& surface, const SurfacePoint& point, double radius);

}  // namespace robot_tissue
