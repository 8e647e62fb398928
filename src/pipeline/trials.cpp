// Pipeline: steps that are undone.
#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

struct Pipeline::Mark {
  Checkpoint now;
  std::vector<Checkpoint> checkpoints;
  std::vector<Drive> drives;
  std::optional<RobotPose> last_pose;
  RobotPose asked;
  std::optional<DeadEnd> dead_end;
  int late_iterations = 0;
  bool gave_up = false;
  bool unfinished = false;
  bool touched = true;
  StepReport report;
};

void Pipeline::beginTrial() {
  trial_from_ = std::make_shared<const Mark>(Mark{checkpoint(), checkpoints_, drives_, last_pose_,
                                                  asked_, dead_end_, late_iterations_, gave_up_,
                                                  unfinished_, touched_, report_});
  tissue_.solveAside(true);
}

void Pipeline::undoTrial() {
  if (!trial_from_) return;
  const Mark& mark = *trial_from_;
  tissue_.solveAside(false);
  goBackTo(mark.now);
  checkpoints_ = mark.checkpoints;
  drives_ = mark.drives;
  last_pose_ = mark.last_pose;
  asked_ = mark.asked;
  dead_end_ = mark.dead_end;
  late_iterations_ = mark.late_iterations;
  gave_up_ = mark.gave_up;
  unfinished_ = mark.unfinished;
  touched_ = mark.touched;
  report_ = mark.report;
  trial_from_.reset();
}

}  // namespace robot_tissue
