// Runner: steps that part tissue, and that take that back.
#include <algorithm>
#include <iterator>

#include "robot_tissue/scene/value_text.h"
#include "runner.h"

namespace robot_tissue {

void Runner::perform(const CutStep& step) {
  const SolveReport report = pipeline_.cut(step.corners).solve;
  followPushes();
  keep(report);
}

void Runner::perform(const RemoveStep& step) {
  const RemoveReport report = pipeline_.remove(step.space);
  if (report.volume == 0.0) remark("no cell of the tissue has its center in the space");
  for (const std::string& name : report.loads) {
    remark("load '" + name + "' went with all its nodes");
  }
  followPushes();
  keep(report.solve);
}

void Runner::perform(const UndoStep& step) {
  const SolveReport report = pipeline_.undo(step.count);
  if (pipeline_.tissue().isOverstretched()) {
    remark("what tore is stretched beyond its tear_stretch still: it tears again in the next step");
  }
  followPushes();
  keep(report);
}

void Runner::keepPieces(int increment) {
  for (const TissuePiece& piece : pipeline_.tissue().pieces()) {
    result_.pieces.push_back({step_, increment, piece});
  }
}

// `before`: how many had been dropped before the step.
void Runner::remarkDropped(std::size_t before) {
  if (std::holds_alternative<LoadStateStep>(scene_.steps[at(step_)])) return;
  const std::vector<int>& dropped = pipeline_.tissue().droppedPieces();
  for (std::size_t i = before; i < dropped.size(); ++i) {
    remark("piece " + std::to_string(dropped[i]) + " was dropped, nothing holds it");
  }
}

std::set<std::string> Runner::standingLoads() const {
  std::set<std::string> names;
  for (const LoadingPatch& load : pipeline_.tissue().patches()) {
    if (names.size() < pipeline_.tissue().namedPatches()) names.insert(load.name);
  }
  return names;
}

// `before`: the loads that stood before the step. Nobody let go of those that are missing now.
void Runner::noteLost(const std::set<std::string>& before) {
  const Step& step = scene_.steps[at(step_)];
  const std::set<std::string> now = standingLoads();
  if (std::holds_alternative<ResetStep>(step) || std::holds_alternative<LoadStateStep>(step)) {
    lost_loads_.clear();
  } else if (!std::holds_alternative<ReleaseStep>(step)) {
    std::set_difference(before.begin(), before.end(), now.begin(), now.end(),
                        std::inserter(lost_loads_, lost_loads_.end()));
  }
  for (const std::string& name : now) lost_loads_.erase(name);
}

std::vector<std::string> Runner::stillStanding(const std::vector<std::string>& names) {
  std::vector<std::string> standing;
  for (const std::string& name : names) {
    if (lost_loads_.count(name) == 0) {
      standing.push_back(name);
    } else {
      remark("load '" + name + "' is not there to be released: it went with all its nodes");
    }
  }
  return standing;
}

}  // namespace robot_tissue
