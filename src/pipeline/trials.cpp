// Pipeline: trial steps, after which all is put back as it was.
#include "pipeline_parts.h"

namespace robot_tissue {

struct Pipeline::Mark {
  Checkpoint now;
  WayBehind way_behind;
  ForceDrive drive;
  std::vector<BladeState> blades;
  std::vector<BurrState> burrs;
  std::vector<ScissorsState> scissors;
  std::optional<RobotPose> last_pose;
  RobotPose asked;
  std::optional<DeadEnd> dead_end;
  int late_iterations = 0;
  bool gave_up = false;
  bool unfinished = false;
  bool touched = true;
  StepReport report;
  std::shared_ptr<const ContactFinder::Kept> searches;
};

void Pipeline::beginTrial() {
  trial_from_ = std::make_shared<const Mark>(
      Mark{parts_->load_step.checkpoint(), parts_->motion.wayBehind(), parts_->drive,
           parts_->blades.states(), parts_->burrs.states(), parts_->scissors.states(),
           world_.last_pose, world_.asked, world_.dead_end, late_iterations_, gave_up_,
           world_.unfinished, touched_, world_.report, world_.finder.kept()});
  world_.tissue.beginAside();
  world_.is_trial = true;
}

void Pipeline::undoTrial() {
  if (!trial_from_) return;
  const Mark& mark = *trial_from_;
  world_.tissue.endAside();
  parts_->load_step.goBackTo(mark.now);
  parts_->motion.restore(mark.way_behind);
  parts_->drive = mark.drive;
  parts_->blades.restore(mark.blades);
  parts_->burrs.restore(mark.burrs);
  parts_->scissors.restore(mark.scissors);
  world_.is_trial = false;
  world_.last_pose = mark.last_pose;
  world_.asked = mark.asked;
  world_.dead_end = mark.dead_end;
  late_iterations_ = mark.late_iterations;
  gave_up_ = mark.gave_up;
  world_.unfinished = mark.unfinished;
  touched_ = mark.touched;
  world_.report = mark.report;
  world_.finder.restore(*mark.searches, world_.tissue.surface(), world_.tissue.vertices());
  trial_from_.reset();
}

}  // namespace robot_tissue
