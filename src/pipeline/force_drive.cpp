#include "force_drive.h"

#include <algorithm>
#include <cmath>

#include "tuning.h"

namespace robot_tissue {
namespace {

// Of forces along the push (N).
bool isNear(double met, double wanted) {
  return std::abs(met - wanted) <= tuning::kForceMet * wanted;
}

}  // namespace

void ForceDrive::push(std::size_t tool, const std::optional<Vec3>& force) {
  Drive& drive = drives_[tool];
  const bool same_way =
      force && drive.force && force->normalized().dot(drive.force->normalized()) > 1.0 - 1e-9;
  if (!same_way) drive.way = drive.came = 0.0;
  if (same_way && *force != *drive.force) drive.way = drive.came;
  drive.off = kInfinity;
  drive.unanswered = drive.was_met = false;
  drive.pushed_off = 0;
  drive.force = force;
}

bool ForceDrive::waits(std::size_t tool, bool is_late) {
  int& waits = drives_[tool].waits;
  waits = is_late && waits < tuning::kMostToFinish ? waits + 1 : 0;
  return waits > 0;
}

bool ForceDrive::drivesAny() const {
  return std::any_of(drives_.begin(), drives_.end(),
                     [](const Drive& drive) { return drive.force.has_value(); });
}

bool ForceDrive::isMet(std::size_t tool, const Vec3& met) const {
  const Vec3& force = *drives_[tool].force;
  return isNear(met.dot(force.normalized()), force.norm());
}

bool ForceDrive::isPushedOff(std::size_t tool, const Vec3& met) {
  Drive& drive = drives_[tool];
  const bool is_off = drive.was_met && !isMet(tool, met);
  drive.pushed_off = is_off ? drive.pushed_off + 1 : 0;
  return is_off && drive.pushed_off <= tuning::kMostPushedOff;
}

Vec3 ForceDrive::offset(std::size_t tool) const {
  const Drive& drive = drives_[tool];
  return drive.force ? Vec3(drive.way * drive.force->normalized()) : Vec3(Vec3::Zero());
}

Vec3 ForceDrive::came(std::size_t tool) const {
  const Drive& drive = drives_[tool];
  return drive.force ? Vec3(drive.came * drive.force->normalized()) : Vec3(Vec3::Zero());
}

RobotPose ForceDrive::driven(RobotPose pose, const ToolSet& tools) const {
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (!drives(tool)) continue;
    const Vec3 way = offset(tool);
    for (std::size_t link = tools.firstLink(tool); link < tools.endLink(tool); ++link) {
      if (!ToolSet::isAway(pose.links[link])) pose.links[link].translation() += way;
    }
  }
  return pose;
}

void ForceDrive::noteReached(const RobotPose& pose, const RobotPose& reached,
                             const ToolSet& tools) {
  const RobotPose goal = driven(pose, tools);
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (!drives(tool)) continue;
    const std::size_t link = tools.firstLink(tool);
    if (ToolSet::isAway(goal.links[link]) || ToolSet::isAway(reached.links[link])) continue;
    Drive& drive = drives_[tool];
    const Vec3 beyond = reached.links[link].translation() - goal.links[link].translation();
    drive.came = drive.way + beyond.dot(drive.force->normalized());
  }
}

void ForceDrive::stay() {
  for (Drive& drive : drives_) drive.way = drive.came;
}

// The corrections of one call.
class ForceDrive::Search {
 public:
  // force: wanted (N); longest: a load step (m).
  Search(double force, double longest) : force_(force), longest_(longest), reach_(longest) {}

  // Where the tool is along its force (m), and what it met there (N).
  void note(double way, double met);
  bool isAnswered() const { return met_ >= tuning::kAnswered * force_; }
  double off() const { return std::abs(met_ - force_); }  // N
  bool hasMet() const { return isNear(met_, force_); }
  // Next correction (m).
  double next() const;
  bool turnedBack() const { return turned_back_; }

 private:
  double bySecant() const;

  double force_, longest_;
  double reach_;                  // of the next correction (m)
  double way_ = 0.0, met_ = 0.0;  // m, N
  double stiffness_ = 0.0;        // N/m; 0: not known
  bool is_first_ = true;
  bool turned_back_ = false;
};

// A correction that went beyond where the force is met halves the next one at least: past a touch,
// a whole load step may meet a hundred times the force.
void ForceDrive::Search::note(double way, double met) {
  if (!is_first_) {
    const double length = way - way_;
    if (met_ > 0.0 && met > 0.0 && (met - met_) / length > 0.0) stiffness_ = (met - met_) / length;
    turned_back_ = turned_back_ || length < 0.0;
    const bool went_beyond = (met > force_) != (met_ > force_);
    reach_ = went_beyond ? 0.5 * std::abs(length) : std::min(2.0 * reach_, longest_);
  }
  is_first_ = false;
  way_ = way;
  met_ = met;
}

double ForceDrive::Search::bySecant() const {
  if (stiffness_ > 0.0) return (force_ - met_) / stiffness_;
  const double length = met_ > 0.0 ? tuning::kFirstCorrection * longest_ : longest_;
  return met_ > force_ ? -length : length;
}

double ForceDrive::Search::next() const { return std::min(std::max(bySecant(), -reach_), reach_); }

bool ForceDrive::meetForce(std::size_t tool, const Way& way) {
  Drive& drive = drives_[tool];
  const Vec3 direction = drive.force->normalized();
  const double longest = way.longest;
  Search search(drive.force->norm(), longest);
  search.note(drive.way, way.met().dot(direction));
  bool had_time = true;
  for (int pushes = 0; !search.hasMet() && pushes < tuning::kMostCorrections; ++pushes) {
    const double length = search.next();
    if (drive.way + length > tuning::kFarthestPush * longest) break;
    drive.way += length;
    had_time = way.walk();
    search.note(drive.way, way.met().dot(direction));
    if (!had_time) break;
  }
  // What was cut short tells nothing of where corrections lead.
  const bool nearer =
      !had_time || !search.turnedBack() || search.off() < tuning::kNearerForce * drive.off;
  const bool has_way_left = !search.hasMet() && !way.lost() && nearer &&
                            drive.way < (tuning::kFarthestPush - 1.0) * longest;
  drive.off = has_way_left ? search.off() : kInfinity;
  drive.was_met = search.hasMet();
  drive.unanswered = had_time && !has_way_left && !way.lost() && !search.isAnswered();
  return has_way_left;
}

}  // namespace robot_tissue
