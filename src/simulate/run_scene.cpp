#include "run_scene.h"

#include <algorithm>

#include "runner.h"

namespace robot_tissue {

bool RunResult::allOk() const {
  return cut_off.empty() && std::all_of(increments.begin(), increments.end(), [](const auto& row) {
           return row.report.status == SolveStatus::kOk;
         });
}

bool partsTissue(const Scene& scene) {
  const auto parts = [](const Step& step) {
    return std::holds_alternative<CutStep>(step) || std::holds_alternative<RemoveStep>(step) ||
           std::holds_alternative<UndoStep>(step) || std::holds_alternative<LoadStateStep>(step);
  };
  const auto tears = [](const Material& material) { return material.tear_stretch > 0.0; };
  const auto may_part = [](const ToolConfig& tool) {
    return !tool.role.touches() || tool.grasp.tears_out;
  };
  return std::any_of(scene.steps.begin(), scene.steps.end(), parts) ||
         std::any_of(scene.tools.begin(), scene.tools.end(), may_part) ||
         tears(scene.tissue.material) ||
         std::any_of(scene.tissue.regions.begin(), scene.tissue.regions.end(),
                     [&](const Region& region) { return tears(region.material); });
}

RunResult runScene(const Scene& scene, const OnRow& on_row, const OnStep& on_step,
                   const Deadline& deadline, const std::string& state_folder) {
  return Runner(scene, on_row, on_step, deadline, state_folder).run();
}

}  // namespace robot_tissue
