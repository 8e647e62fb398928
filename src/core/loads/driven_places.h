// Where the patches are that forces drive: a solve moves them on, and a part of that may be taken
// back.
#pragma once

#include <vector>

#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

struct DrivenPlace {
  PatchPlace place;
  std::vector<Vec3> anchors;  // of its rim (m)
};

// One a patch; empty for those that no force drives.
std::vector<DrivenPlace> drivenPlaces(const std::vector<LoadingPatch>& patches);

// To the share of their way from `before`, of the same patches.
void takePatchesBack(const std::vector<DrivenPlace>& before, double share,
                     std::vector<LoadingPatch>& patches);

}  // namespace robot_tissue
