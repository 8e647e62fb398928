// What a lattice makes of walls that are thin for it, said when a scene is loaded.
#pragma once

#include <string>
#include <vector>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

struct WallRemark {
  std::string text;  // without its key, tissue.spacing
  std::string remedy;
};

// Of walls that do not bend as they should, with how far they are off (doc/accuracy.md): no thicker
// than a spacing, a twentieth of the surface or more; oblique to the grid and no thicker than
// three, a tenth.
std::vector<WallRemark> wallRemarks(const TissueConfig& tissue);

}  // namespace robot_tissue
