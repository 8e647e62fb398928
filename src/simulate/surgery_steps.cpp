// Runner: steps that part tissue, and that take that back.
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
  followPushes();
  keep(report);
}

void Runner::keepPieces(int increment) {
  const std::vector<TissuePiece> pieces = pipeline_.tissue().pieces();
  for (std::size_t number = 0; number < pieces.size(); ++number) {
    result_.pieces.push_back({step_, increment, static_cast<int>(number), pieces[number]});
  }
}

}  // namespace robot_tissue
