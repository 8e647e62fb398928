// Pipeline: tools that part tissue on their way.
#include <utility>
#include <vector>

#include "pipeline_parts.h"

namespace robot_tissue {

// In one leg, but beside blades near the tissue, which meet it and part it as they go. False: there
// is a way left to go.
bool Pipeline::goInLegs(const RobotPose& pose) {
  const bool jumps = !parts_->ways.farFrom(*world_.last_pose, pose).empty();
  const std::vector<RobotPose> legs =
      jumps ? std::vector<RobotPose>{pose} : parts_->blades.legs(*world_.last_pose, pose);
  bool arrived = true;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const int before = world_.report.springs_cut;
    parts_->blades.partAhead(legs[i]);
    const bool is_parted = world_.report.springs_cut > before;
    if (is_parted && world_.tools.anyRigid()) parts_->motion.checkInAnew();
    goTo(legs[i]);
    arrived = partAlongWay();
    if (i + 1 == legs.size() || world_.report.lost) break;
    if (!arrived || world_.deadline.isOver()) {
      world_.report.too_fast = true;
      return false;
    }
  }
  return arrived;
}

void Pipeline::goTo(RobotPose pose) {
  const auto last_good = parts_->motion.lastGood();
  parts_->motion.goBackTo(pose);
  world_.last_pose = parts_->motion.walk(pose);
  if (world_.report.lost && parts_->blades.breakIn()) {
    world_.report.lost = false;
    world_.last_pose = parts_->motion.walk(pose);
  }
  if (world_.report.lost) parts_->motion.leaveStuck(pose);
  if (world_.report.lost) parts_->motion.leaveReleased(pose);
  parts_->motion.leaveBehind(pose);
  parts_->motion.leaveJam(pose);
  if (world_.report.lost && last_good) parts_->motion.stayAt(*last_good, pose);
  parts_->motion.unhook(pose);
}

// What blades and scissors sweep and burrs cover to where the tools have come. False: there is a
// way left to go.
bool Pipeline::partAlongWay() {
  const bool drilled = parts_->burrs.goTo(*world_.last_pose);
  const bool sheared = parts_->scissors.goTo(*world_.last_pose);
  const bool arrived = parts_->blades.goTo(*world_.last_pose) && drilled && sheared;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (world_.tools[tool].role.touches()) continue;
    world_.pose = world_.tools.withTool(tool, *world_.last_pose, std::move(world_.pose));
  }
  world_.report.too_fast = world_.report.too_fast || !arrived;
  // Shapes to go back to may have patches on what is gone.
  const bool comes_back = world_.report.volume_removed > 0.0 ||
                          (world_.tools.anyRigid() && world_.report.springs_cut > 0);
  if (comes_back) parts_->motion.checkInAnew();
  return arrived;
}

}  // namespace robot_tissue
