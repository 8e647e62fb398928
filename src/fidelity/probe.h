// A short press on a tissue whose scene has no steps (own).
#pragma once

#include <string>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// The scene with steps. A box is pressed by a bonded patch of two fifths of a face's edges in its
// middle, a mesh by a sphere (radius a sixth of its smallest extent) at its outermost vertex: on
// the face or end farthest from the fixed nodes (upwards where none are), straight inwards by a
// tenth of the extent. Where nothing is fixed, the opposite face's nodes are held.
Scene probed(const Scene& scene);

// What probed() adds, for the user.
std::string probeText(const Scene& probed);

}  // namespace robot_tissue
