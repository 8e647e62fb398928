// Pipeline: tools that a force drives.
#include <algorithm>
#include <cmath>

#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {
namespace {

constexpr int kMostPushes = 12;      // corrections of a driven tool in one update
constexpr double kPushed = 0.005;    // of the force: near enough
constexpr double kFirstPush = 0.1;   // of a load step: to learn the stiffness from
constexpr double kFarthest = 200.0;  // load steps: a driven tool that finds nothing to push stops

}  // namespace

void Pipeline::push(std::size_t tool, const std::optional<Vec3>& force) {
  if (force && !(force->norm() > 0.0 && force->allFinite())) {
    throw InputError("tool '" + names_[tool] +
                     "': the force is zero or not finite; allowed: a force");
  }
  const bool same_way = force && drives_[tool].force &&
                        force->normalized().dot(drives_[tool].force->normalized()) > 1.0 - 1e-9;
  if (!same_way) drives_[tool].way = 0.0;
  drives_[tool].force = force;
  touched_ = true;
}

// Where the tools are with what their forces moved them.
RobotPose Pipeline::driven(const RobotPose& pose) const {
  RobotPose driven = complete(pose);
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    const Drive& drive = drives_[tool];
    if (!drive.force) continue;
    for (std::size_t link = first_link_[tool]; link < first_link_[tool + 1]; ++link) {
      driven.links[link].translation() += drive.way * drive.force->normalized();
    }
  }
  return driven;
}

// Moves each driven tool until its force is met: load steps until it touches, then by the secant
// through the last two. True: there is a way left to go.
bool Pipeline::drive(const RobotPose& pose) {
  bool goes_on = false;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    Drive& drive = drives_[tool];
    if (!drive.force) continue;
    const Vec3 direction = drive.force->normalized();
    const double wanted = drive.force->norm(), longest = stepOf(first_link_[tool]);
    double met = answerOf(tool).force.dot(direction), stiffness = 0.0;
    int pushes = 0;
    while (std::abs(met - wanted) > kPushed * wanted && pushes++ < kMostPushes) {
      double way = stiffness > 0.0 ? (wanted - met) / stiffness
                                   : (met > 0.0 ? kFirstPush * longest : longest);
      if (met > wanted && stiffness <= 0.0) way = -way;
      way = std::min(std::max(way, -longest), longest);
      if (drive.way + way > kFarthest * longest) break;
      drive.way += way;
      last_pose_ = walk(driven(pose));
      const double now = answerOf(tool).force.dot(direction);
      if (met > 0.0 && now > 0.0 && (now - met) / way > 0.0) stiffness = (now - met) / way;
      met = now;
      if (report_.too_fast || report_.lost || isOutOfTime()) break;
    }
    const bool met_it = std::abs(met - wanted) <= kPushed * wanted || report_.lost;
    goes_on = goes_on || (!met_it && drive.way < (kFarthest - 1.0) * longest);
  }
  return goes_on;
}

}  // namespace robot_tissue
