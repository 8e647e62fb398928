#include "tissue/kept_still.h"

#include <algorithm>
#include <iterator>

namespace robot_tissue {

KeptStill::KeptStill(TissueData& data) : data_(data) {
  const PieceRegistry::Adrift adrift = data_.adrift();
  const std::vector<int> hanging = data_.hangingNodes();
  LoadingPatch still;
  std::merge(hanging.begin(), hanging.end(), adrift.nodes.begin(), adrift.nodes.end(),
             std::back_inserter(still.nodes));
  any_ = !still.nodes.empty();
  if (!any_) return;
  std::vector<LoadingPatch>& patches = data_.loads.patches();
  for (const std::size_t number : adrift.patches) {
    adrift_.emplace_back(number, std::move(patches[number]));
    patches[number] = LoadingPatch();
  }
  const std::vector<Vec3>& displacement = data_.body.displacement();
  for (const int node : still.nodes) still.displacement.push_back(displacement[at(node)]);
  patches.push_back(std::move(still));
}

void KeptStill::letGo(SolveReport& report) {
  if (!any_) return;
  std::vector<LoadingPatch>& patches = data_.loads.patches();
  patches.pop_back();
  report.patches.resize(patches.size());
  for (auto& [number, patch] : adrift_) {
    report.patches[number] = PatchAnswer();
    report.patches[number].displacement = meanDisplacement(patch, data_.body.displacement());
    report.patches[number].is_adrift = true;
    patches[number] = std::move(patch);
  }
}

}  // namespace robot_tissue
