#include "run_scene.h"

#include <algorithm>

#include "runner.h"

namespace robot_tissue {

bool RunResult::allOk() const {
  return std::all_of(increments.begin(), increments.end(),
                     [](const auto& row) { return row.report.status == SolveStatus::kOk; });
}

RunResult runScene(const Scene& scene, const OnRow& on_row, const OnStep& on_step) {
  return Runner(scene, on_row, on_step).run();
}

}  // namespace robot_tissue
