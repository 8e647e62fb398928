// Runner: steps that save the tissue's state and load it.
#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/state_file.h"
#include "runner.h"

namespace robot_tissue {

void Runner::perform(const SaveStep& step) {
  result_.saved[step.file] = pipeline_.tissue().savedState();
  keep(pipeline_.tissue().lastReport());
}

// From a state that an earlier step saved, else from one where the run's files will be.
SolveReport Runner::loaded(const std::string& file) {
  const auto saved = result_.saved.find(file);
  std::string bytes;
  try {
    bytes = saved != result_.saved.end() ? saved->second : readStateFile(state_folder_, file);
  } catch (const InputError& error) {
    throw EntryError(error.what());
  }
  try {
    return pipeline_.loadState(bytes);
  } catch (const InputError& error) {
    throw EntryError("file = '" + file + "': " + error.what());
  }
}

void Runner::perform(const LoadStateStep& step) {
  const SolveReport report = loaded(step.file);
  pushes_.assign(tools_.count(), std::nullopt);
  if (tools_.anyStands()) follow();  // they come in anew
  keep(report);
}

}  // namespace robot_tissue
