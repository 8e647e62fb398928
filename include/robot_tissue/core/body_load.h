// Whether a tissue's rest shape is out of balance by itself.
#pragma once

#include <algorithm>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// By gravity, or a pressure inside.
inline bool hasBodyLoad(const TissueConfig& tissue) {
  const auto is_pressed = [](const MembraneConfig& membrane) { return membrane.pressure != 0.0; };
  return tissue.gravity != Vec3::Zero() ||
         std::any_of(tissue.membranes.begin(), tissue.membranes.end(), is_pressed);
}

}  // namespace robot_tissue
