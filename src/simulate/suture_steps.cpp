// Runner: the step that sutures, and what is told of sutures after each increment.
#include "robot_tissue/pipeline/suture_names.h"
#include "runner.h"

namespace robot_tissue {

void Runner::perform(const SutureStep& step) {
  SutureConfig suture = step.suture;
  if (suture.name.empty()) suture.name = freeSutureName(pipeline_.tissue());
  const SolveReport report = pipeline_.suture(suture).solve;
  followPushes();
  keep(report);
}

void Runner::keepSutures(int increment) {
  for (const SutureReport& suture : pipeline_.tissue().sutures()) {
    result_.sutures.push_back({step_, increment, suture});
    const bool is_new = suture.broken && broken_sutures_.insert(suture.name).second;
    if (is_new) remark("suture '" + suture.name + "' breaks");
    if (!suture.broken) broken_sutures_.erase(suture.name);
  }
}

}  // namespace robot_tissue
