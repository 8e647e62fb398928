// Runner: steps that save the tissue's state and load it.
#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/state_file.h"
#include "runner.h"

namespace robot_tissue {

void Runner::perform(const SaveStep& step) {
  result_.saved[step.file] = pipeline_.tissue().savedState();
  keep(pipeline_.tissue().lastReport());
}

// Saved by an earlier step, or where the run's files will be.
void Runner::perform(const LoadStateStep& step) {
  const auto saved = result_.saved.find(step.file);
  const std::string bytes =
      saved != result_.saved.end() ? saved->second : readStateFile(state_folder_, step.file);
  SolveReport report;
  try {
    report = pipeline_.loadState(bytes);
  } catch (const InputError& error) {
    throw InputError("file = '" + step.file + "': " + error.what());
  }
  pushes_.assign(tools_.count(), std::nullopt);
  if (tools_.anyStands()) follow();  // they come in anew
  keep(report);
}

}  // namespace robot_tissue
