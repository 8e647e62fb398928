#include "force_drive.h"

#include <algorithm>
#include <cmath>

#include "tuning.h"

namespace robot_tissue {

void ForceDrive::push(std::size_t tool, const std::optional<Vec3>& force) {
  Drive& drive = drives_[tool];
  const bool same_way =
      force && drive.force && force->normalized().dot(drive.force->normalized()) > 1.0 - 1e-9;
  if (!same_way) drive.way = 0.0;
  drive.force = force;
}

bool ForceDrive::drivesAny() const {
  return std::any_of(drives_.begin(), drives_.end(),
                     [](const Drive& drive) { return drive.force.has_value(); });
}

Vec3 ForceDrive::offset(std::size_t tool) const {
  const Drive& drive = drives_[tool];
  return drive.force ? Vec3(drive.way * drive.force->normalized()) : Vec3(Vec3::Zero());
}

RobotPose ForceDrive::driven(RobotPose pose, const ToolSet& tools) const {
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (!drives(tool)) continue;
    const Vec3 way = offset(tool);
    for (std::size_t link = tools.firstLink(tool); link < tools.endLink(tool); ++link) {
      pose.links[link].translation() += way;
    }
  }
  return pose;
}

bool ForceDrive::meetForce(std::size_t tool, const Way& way) {
  Drive& drive = drives_[tool];
  const Vec3 direction = drive.force->normalized();
  const double wanted = drive.force->norm(), longest = way.longest;
  double met = way.met().dot(direction), stiffness = 0.0;
  int pushes = 0;
  while (std::abs(met - wanted) > tuning::kForceMet * wanted &&
         pushes++ < tuning::kMostCorrections) {
    double length = stiffness > 0.0 ? (wanted - met) / stiffness
                                    : (met > 0.0 ? tuning::kFirstCorrection * longest : longest);
    if (met > wanted && stiffness <= 0.0) length = -length;
    length = std::min(std::max(length, -longest), longest);
    if (drive.way + length > tuning::kFarthestPush * longest) break;
    drive.way += length;
    const bool goes_on = way.walk();
    const double now = way.met().dot(direction);
    if (met > 0.0 && now > 0.0 && (now - met) / length > 0.0) stiffness = (now - met) / length;
    met = now;
    if (!goes_on) break;
  }
  const bool met_it = std::abs(met - wanted) <= tuning::kForceMet * wanted || way.lost();
  return !met_it && drive.way < (tuning::kFarthestPush - 1.0) * longest;
}

}  // namespace robot_tissue
