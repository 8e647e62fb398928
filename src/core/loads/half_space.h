// An elastic half-space under a force on its surface (Boussinesq 1885).
#pragma once

#include "loads/narrow_contact.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// How far what is `off` the force (m) goes under 1 N along the unit direction, into the half-space
// (m/N). Above the surface: as in it. Not at the force.
Vec3 halfSpaceMotion(const Vec3& off, const Vec3& direction, const SurfaceModuli& moduli);

}  // namespace robot_tissue
