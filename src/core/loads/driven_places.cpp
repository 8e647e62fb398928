#include "loads/driven_places.h"

#include <cstddef>

namespace robot_tissue {

std::vector<DrivenPlace> drivenPlaces(const std::vector<LoadingPatch>& patches) {
  std::vector<DrivenPlace> places(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (!byForce(patches[i])) continue;
    places[i].place = patches[i].place;
    for (const RimSpring& spring : patches[i].rim) places[i].anchors.push_back(spring.anchor);
  }
  return places;
}

void takePatchesBack(const std::vector<DrivenPlace>& before, double share,
                     std::vector<LoadingPatch>& patches) {
  const auto between = [share](const Vec3& from, const Vec3& to) -> Vec3 {
    return from + share * (to - from);
  };
  for (std::size_t i = 0; i < patches.size(); ++i) {
    LoadingPatch& patch = patches[i];
    if (!byForce(patch)) continue;
    const PatchPlace& start = before[i].place;
    patch.place.displacement = between(start.displacement, patch.place.displacement);
    if (patch.turns) {
      const Eigen::Quaterniond from(start.rotation), to(patch.place.rotation);
      patch.place.rotation = from.slerp(share, to).toRotationMatrix();
    }
    for (std::size_t j = 0; j < patch.rim.size(); ++j) {
      patch.rim[j].anchor = between(before[i].anchors[j], patch.rim[j].anchor);
    }
  }
}

}  // namespace robot_tissue
