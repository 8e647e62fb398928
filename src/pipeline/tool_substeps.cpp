// Pipeline: the way of the tools in load steps.
#include <algorithm>
#include <cmath>
#include <utility>

#include "box_distance.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "tool_list.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kMostCheckpoints = 64;
constexpr double kStandsStill = 1e-3;    // of the spacing: a motion that is none
constexpr double kShortest = 1.0 / 8.0;  // of a load step: tried where no shape follows
constexpr int kMostInVain = 3000;        // cycles that did not converge: no whole load step since
constexpr double kFarAway = 1e6;         // m: where a tool is that stands nowhere

RobotPose between(const RobotPose& from, const RobotPose& to, double share) {
  RobotPose between = to;
  for (std::size_t link = 0; link < to.links.size(); ++link) {
    const Pose& start = from.links[link];
    const Pose& end = to.links[link];
    Pose& pose = between.links[link];
    pose.linear() = Eigen::Quaterniond(start.linear())
                        .slerp(share, Eigen::Quaterniond(end.linear()))
                        .toRotationMatrix();
    pose.translation() = start.translation() + share * (end.translation() - start.translation());
  }
  return between;
}

}  // namespace

Pose Pipeline::away() {
  Pose away = Pose::Identity();
  away.translation().setConstant(kFarAway);
  return away;
}

bool Pipeline::isAway(const Pose& pose) { return pose.translation().x() >= kFarAway; }

// With the supports, which stand at the origin of the tissue's frame.
RobotPose Pipeline::complete(const RobotPose& pose) const {
  const std::size_t of_tools = first_link_[tools_.size()];
  RobotPose complete = pose;
  if (pose.links.empty()) complete.links.assign(of_tools, away());
  if (complete.links.size() != of_tools) {
    throw InputError("pose: has " + std::to_string(pose.links.size()) +
                     " links; allowed is one for each of the " + std::to_string(of_tools) +
                     " links of the tools");
  }
  for (const Pose& link : complete.links) {
    if (link.matrix().allFinite()) continue;
    throw InputError("pose: a link's transform is not finite; allowed: finite numbers");
  }
  complete.links.resize(first_link_.back(), Pose::Identity());
  return complete;
}

// The shortest load step that way is the one that no shape followed when last tried from there.
bool Pipeline::leadsNowhere(const RobotPose& from, const RobotPose& to) const {
  if (!dead_end_ || stepsBetween(dead_end_->from, from) > 0.0) return false;
  const double steps = stepsBetween(from, to);
  const RobotPose shortest = steps > kShortest ? between(from, to, kShortest / steps) : to;
  return stepsBetween(dead_end_->to, shortest) < 0.5 * kShortest;
}

// Tools that pass the tissue by are where they go at once. False: others have a way to go.
bool Pipeline::letPass(RobotPose& start, const RobotPose& pose) const {
  bool all_pass = !any_rigid_;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    if (passesBy(tool, start, pose)) {
      start = withTool(tool, pose, start);
    } else {
      all_pass = false;
    }
  }
  return all_pass;
}

// Load steps up to the pose, shorter ones where no shape follows. Returns how far it came, at all
// or in time. Tools that pass the tissue by take none.
RobotPose Pipeline::walk(const RobotPose& pose) {
  RobotPose start = any_rigid_ ? checkpoints_.back().pose : *last_pose_;
  asked_ = pose;
  if (letPass(start, pose)) {
    passTo(pose);
    return pose;
  }
  if (leadsNowhere(start, pose)) {
    report_.lost = true;
    return start;
  }
  const double steps = stepsBetween(start, pose);
  double gone = 0.0, longest = 1.0;
  cycles_in_vain_ = 0;
  const auto came = [&] { return gone > 0.0 ? between(start, pose, gone / steps) : start; };
  while (gone < steps) {
    const double free = freeSteps(came(), pose);
    const double stride = std::max(longest, free);
    const bool whole = gone + stride < steps;
    if (!whole && any_rigid_) break;
    const double there = whole ? gone + stride : steps;
    const RobotPose on_the_way = whole ? between(start, pose, there / steps) : pose;
    const bool is_short = std::min(longest, there - gone) <= kShortest;
    const bool followed = advance(on_the_way, is_short);
    if (!followed) {
      const bool is_hopeless = cycles_in_vain_ > kMostInVain;
      if (is_short || is_hopeless) {
        report_.lost = true;
        const double next = std::min(gone + kShortest, there);
        dead_end_ = DeadEnd{came(), is_short ? on_the_way : between(start, pose, next / steps)};
        return came();
      }
      longest = kShortest;
    }
    if (followed) {
      if (longest == 1.0) cycles_in_vain_ = 0;
      gone = there;
      longest = std::min(1.0, 2.0 * longest);
    }
    if (any_rigid_) checkIn(on_the_way);
    if (followed && gone < steps && deadline_.isOver()) {
      report_.too_fast = true;
      return came();
    }
  }
  if ((any_rigid_ || steps == 0.0) && !advance(pose)) report_.lost = true;
  if (any_rigid_ && tissue_.isUntouched()) checkIn(pose);
  return pose;
}

Pipeline::Checkpoint Pipeline::toolsCheckpoint() const {
  return {pose_, {}, patches_.attachments(), contacts_, jaws_, depths_};
}

Pipeline::Checkpoint Pipeline::checkpoint() const {
  Checkpoint all = toolsCheckpoint();
  all.shape = tissue_.shape();
  return all;
}

void Pipeline::goBackTo(const Checkpoint& good) {
  pose_ = good.pose;
  tissue_.restore(good.shape);
  patches_.restore(good.attachments, tissue_);
  contacts_ = good.contacts;
  jaws_ = good.jaws;
  depths_ = good.depths;
}

void Pipeline::checkIn(const RobotPose& pose) {
  if (!any_rigid_ || tissue_.isUntouched()) checkpoints_.clear();
  if (checkpoints_.size() >= kMostCheckpoints) checkpoints_.erase(checkpoints_.begin());
  checkpoints_.push_back(any_rigid_ ? checkpoint() : Checkpoint());
  checkpoints_.back().pose = pose;
}

// Takes up the shape at the checkpoint nearest to the pose, and drops the later ones.
void Pipeline::goBackTo(RobotPose& pose) {
  const RobotPose& from = any_rigid_ ? checkpoints_.back().pose : *last_pose_;
  std::size_t nearest = checkpoints_.size() - 1;
  double shortest = stepsBetween(from, pose);
  for (std::size_t earlier = nearest; any_rigid_ && earlier-- > 0;) {
    const double way = stepsBetween(checkpoints_[earlier].pose, pose);
    if (way < shortest) {
      shortest = way;
      nearest = earlier;
    }
  }
  if (any_rigid_) {
    checkpoints_.erase(checkpoints_.begin() + static_cast<std::ptrdiff_t>(nearest) + 1,
                       checkpoints_.end());
    goBackTo(checkpoints_.back());
  }
  const auto far = farFrom(any_rigid_ ? checkpoints_.back().pose : *last_pose_, pose);
  if (!far.empty()) {
    report_.too_fast = true;
    report_.jumped = far;
    startAnew(pose);
  }
}

// The tools let go, and come in from outside. Those that wait for the next step stay away in the
// pose.
void Pipeline::startAnew(RobotPose& pose) {
  dead_end_.reset();
  patches_.clear();
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) contacts_.clear(static_cast<int>(tool));
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) forgetJaws(tool);
  pose_ = complete({});
  lieDown();
  checkpoints_.clear();
  last_pose_ = pose;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    if (waitsOutside(tool, tool > 0, pose)) {
      last_pose_ = withTool(tool, pose, *last_pose_);
    } else {
      resolveOverlap(tool, *last_pose_);
    }
  }
  contacts_.commit(*last_pose_, tissue_);  // nothing sticks to where they were before
  checkIn(*last_pose_);
}

// On the supports alone.
void Pipeline::lieDown() {
  if (tissue_.isUntouched()) return;
  contacts_.ride(pose_, tissue_);
  meet(pose_);
  tissue_.follow(patchesOfTools(), {}, !supports_.empty());
}

// A tool that stood nowhere comes in from outside, one that stands nowhere now lets go; the others
// stay as they are.
void Pipeline::comeAndGo(RobotPose& pose) {
  RobotPose from = *last_pose_;
  bool any = false, any_came = false;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    const std::size_t first = first_link_[tool], end = first_link_[tool + 1];
    if (first == end || isAway(from.links[first]) == isAway(pose.links[first])) continue;
    if (waitsOutside(tool, any_came, pose)) continue;
    any = true;
    any_came = any_came || !isAway(pose.links[first]);
    from = withTool(tool, pose, from);
    letGoOf(tool);
    resolveOverlap(tool, from);
  }
  if (!any) return;
  last_pose_ = from;
  contacts_.commit(from, tissue_);
  checkpoints_.clear();
  checkIn(from);
}

// Where no shape could follow, tools that have come out of the tissue by themselves let go.
void Pipeline::leaveStuck(RobotPose& pose) {
  RobotPose from = *last_pose_;
  bool any = false;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    const RobotPose moved = withTool(tool, pose, from);
    if (stepsBetween(from, moved) == 0.0 || isInTissue(tool, pose)) continue;
    any = true;
    from = moved;
    letGoOf(tool);
  }
  if (!any) return;
  last_pose_ = from;
  if (advance(from)) {
    last_pose_ = walk(pose);
  } else {
    startAnew(pose);
    last_pose_ = walk(pose);
  }
}

// Away from where the tissue is at rest, and through its surface.
bool Pipeline::isHooked(std::size_t tool) const {
  if (!contacts_.pushes(static_cast<int>(tool), tissue_)) return false;
  const std::size_t first = first_link_[tool], end = first_link_[tool + 1];
  for (std::size_t link = first; link < end; ++link) {
    const Box box = finder_.bounds(link, last_pose_->links[link]);
    if (distance(box, tissue_.lattice().bounds()) < tissue_.lattice().spacing()) return false;
  }
  for (std::size_t link = first; link < end; ++link) {
    const double depth =
        finder_.penetration(link, last_pose_->links[link], tissue_.surface(), tissue_.vertices());
    if (depth > throughAt(link)) return true;
  }
  return false;
}

void Pipeline::letGoOf(std::size_t tool) {
  dead_end_.reset();
  patches_.letGo(static_cast<int>(tool));
  contacts_.clear(static_cast<int>(tool));
  forgetJaws(tool);
}

// The pose `others` with one tool where it is in `pose`.
RobotPose Pipeline::withTool(std::size_t tool, const RobotPose& pose, RobotPose others) const {
  for (std::size_t link = first_link_[tool]; link < first_link_[tool + 1]; ++link) {
    others.links[link] = pose.links[link];
  }
  return others;
}

bool Pipeline::isAt(std::size_t tool, const RobotPose& here, const RobotPose& there) const {
  const double still = kStandsStill * tissue_.lattice().spacing();
  for (std::size_t link = first_link_[tool]; link < first_link_[tool + 1]; ++link) {
    if (longestWay(here.links[link], there.links[link], finder_.reach(link)) > still) return false;
  }
  return true;
}

bool Pipeline::standsStill(const RobotPose& pose) const {
  if (!last_pose_) return false;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    if (!isAt(tool, asked_, pose)) return false;
  }
  return true;
}

std::vector<std::size_t> Pipeline::toolsBehind() const {
  std::vector<std::size_t> behind;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    if (!isAt(tool, pose_, asked_)) behind.push_back(tool);
  }
  return behind;
}

std::optional<StillPose> Pipeline::stillPose() const {
  const bool is_driven = std::any_of(drives_.begin(), drives_.end(),
                                     [](const Drive& drive) { return drive.force.has_value(); });
  if (!last_pose_ || touched_ || isLate() || is_driven) return std::nullopt;
  RobotPose of_tools = asked_;
  of_tools.links.resize(first_link_[tools_.size()]);
  std::vector<double> reach;
  for (std::size_t link = 0; link < of_tools.links.size(); ++link) {
    reach.push_back(finder_.reach(link));
  }
  return StillPose(std::move(of_tools), std::move(reach),
                   kStandsStill * tissue_.lattice().spacing());
}

}  // namespace robot_tissue
