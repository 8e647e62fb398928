// Steps of the runner that save the tissue's state and load it.
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/state_file.h"

namespace robot_tissue {
namespace {

template <class StateStep>
void readFile(const Entry& entry, StateStep& step) {
  const std::string fault = stateFileFault(step.file = entry.word("the name of a file"));
  if (!fault.empty()) entry.fail(fault);
}

template <class StateStep>
StateStep readStateStep(const Entry& entry) {
  static const KeyTable<StateStep> keys = {{"file", readFile<StateStep>}};
  StateStep step;
  readKeys(MapReader(entry, namesOf(keys)), keys, step);
  return step;
}

}  // namespace

SaveStep readSave(const Entry& entry) { return readStateStep<SaveStep>(entry); }

LoadStateStep readLoadState(const Entry& entry) { return readStateStep<LoadStateStep>(entry); }

}  // namespace robot_tissue
