// Runner: steps that tools take.
#include <algorithm>
#include <cmath>

#include "robot_tissue/pipeline/step_remarks.h"
#include "robot_tissue/scene/value_text.h"
#include "runner.h"
#include "tuning.h"

namespace robot_tissue {
void Runner::perform(const MoveStep& step) {
  const std::size_t tool = tools_.indexOf(step.tool);
  if (pushes_[tool]) {
    endPush(tool);
    remark("tool '" + step.tool + "' is moved, which ends its push");
  }
  if (!step.duration) pipeline_.stopTime();
  springs_cut_ = 0;
  area_cut_ = volume_removed_ = 0.0;
  if (step.from) appear(tool, *step.from);
  Way way{tool, *tools_.of(tool), step.to, time_, step.duration.value_or(0.0)};
  tools_.put(tool, step.to);
  way.steps = loadSteps(pipeline_.stepsTo(tools_.pose()));
  const int increments = step.increments.value_or(way.steps);
  if (step.duration) return moveInTime(way, increments);
  for (int increment = 1; increment <= increments; ++increment) {
    const double share = static_cast<double>(increment) / increments;
    walkTo(way, share);
    const bool is_between = !is_cut_short_ && way.gone + tuning::kStepRounding < share * way.steps;
    if (is_between) {
      pipeline_.beginTrial();
      place(way, share);
      follow();
    }
    if (way.is_given_up) {
      const bool is_ok = way.ends_free && increment == increments;
      updates_ = {true, is_ok ? SolveStatus::kOk : SolveStatus::kUnconverged, updates_.solve_ms};
    }
    keep(SolveReport(), increment, increments);
    if (is_between) pipeline_.undoTrial();
  }
  remarkHolds();
  remarkCut(tool);
}

void Runner::moveInTime(const Way& way, int increments) {
  for (int increment = 1; increment <= increments; ++increment) {
    place(way, static_cast<double>(increment) / increments);
    follow();
    keep(SolveReport(), increment, increments);
  }
  remarkHolds();
  remarkCut(way.tool);
}

int Runner::loadSteps(double steps) const {
  if (!(steps <= tuning::kMostLoadSteps)) {
    throw InputError("the way takes " + numberText(std::ceil(steps)) + " load steps of " +
                     numberText(pipeline_.tissue().stepLength()) +
                     " m or less, must take at most " + numberText(tuning::kMostLoadSteps) +
                     ", so a shorter way");
  }
  return std::max(1, static_cast<int>(std::ceil(steps - tuning::kStepRounding)));
}

// Where tissue slips, the shape depends on the load steps on the way: these are whole ones whose
// ends are the same whatever the increments; several at once where nothing is near.
void Runner::walkTo(Way& way, double share) {
  while (way.gone < way.steps) {
    is_cut_short_ = deadline_.isOver();
    if (is_cut_short_) return place(way, static_cast<double>(way.gone) / way.steps);
    tools_.put(way.tool, way.to);
    const double free = std::min(pipeline_.freeStepsTo(tools_.pose()), tuning::kLongestFree);
    const int next = std::min(way.gone + std::max(1, static_cast<int>(free)), way.steps);
    const bool is_beyond = next > share * way.steps + tuning::kStepRounding;
    const int gone = way.gone;
    if (!is_beyond) way.gone = next;
    place(way, static_cast<double>(way.gone) / way.steps);
    if (is_beyond) return;
    follow();
    const StepReport& report = pipeline_.report();
    if (!report.hopeless) continue;
    if (report.lost || way.gone < way.steps) giveUp(way, report.lost ? gone : way.gone);
  }
}

// The rest of the way. A tool whose way ends clear of the tissue lets go; else it stays where it
// was followed to, so many load steps on its way.
void Runner::giveUp(Way& way, int gone) {
  way.gone = way.steps;
  way.is_given_up = true;
  remark("tool '" + tools_.name(way.tool) +
         "' is followed no further on its way: load steps, as between tools that crush tissue, "
         "take far too many iterations");
  place(way, 1.0);
  if (pipeline_.isInTissue(way.tool, tools_.pose())) {
    return place(way, static_cast<double>(gone) / way.steps);
  }
  tools_.takeAway(way.tool);
  follow();
  place(way, 1.0);
  follow();
  way.ends_free = isFreeInBalance();
}

// No tool touches the tissue, which is in balance.
bool Runner::isFreeInBalance() const {
  const std::vector<ToolReport>& tools = pipeline_.report().tools;
  const bool any_touches = std::any_of(tools.begin(), tools.end(),
                                       [](const ToolReport& tool) { return tool.contacts > 0; });
  return !any_touches && pipeline_.hasArrived() &&
         pipeline_.tissue().lastReport().status == SolveStatus::kOk;
}

void Runner::place(const Way& way, double share) {
  time_ = way.begin + share * way.duration;
  tools_.put(way.tool, between(way.from, way.to, share));
}

// Puts the tool there without a way. Where it stands already it does not come in anew.
void Runner::appear(std::size_t tool, const MoveStep::Place& place) {
  const std::optional<MoveStep::Place>& stands = tools_.of(tool);
  if (stands && stands->pose.isApprox(place.pose) && stands->opening == place.opening) return;
  if (stands) {
    tools_.takeAway(tool);
    follow();
  }
  tools_.put(tool, place);
  follow();
}

void Runner::perform(const WaitStep& step) {
  const double begin = time_;
  const int increments = step.increments.value_or(1);
  for (int increment = 1; increment <= increments; ++increment) {
    time_ = begin + step.duration * increment / increments;
    SolveReport report;
    if (tools_.count() > 0 || !scene_.supports.empty()) {
      follow();
    } else {
      report = pipeline_.wait(step.duration / increments);
    }
    keep(report, increment, increments);
  }
}

void Runner::perform(const PushStep& step) {
  pipeline_.stopTime();
  const std::size_t tool = tools_.indexOf(step.tool);
  const int increments = step.increments.value_or(1);
  for (int increment = 1; increment <= increments; ++increment) {
    const double share = static_cast<double>(increment) / increments;
    pushes_[tool] = share * step.force;
    pipeline_.push(tool, pushes_[tool]);
    follow();
    keep(SolveReport(), increment, increments);
  }
}

void Runner::perform(const GraspStep& step) {
  pipeline_.grasp(tools_.indexOf(step.tool));
  follow();
  keep(SolveReport());
  remarkHolds();
}

// The tool's pose becomes where its force has driven it.
void Runner::endPush(std::size_t tool) {
  if (!pushes_[tool]) return;
  MoveStep::Place place = *tools_.of(tool);
  place.pose.pretranslate(pipeline_.report().tools[tool].offset);
  tools_.put(tool, place);
  pushes_[tool].reset();
  pipeline_.push(tool, std::nullopt);
}

// The tissue follows the tools to where they stand now.
void Runner::follow() {
  update();
  followPushes();
}

// Tools that are behind go to where they stand, in load steps of as many iterations as they take.
void Runner::catchUp() {
  pipeline_.setMostIterations(0);
  for (int i = 0; i < tuning::kMostUpdates && !pipeline_.report().behind.empty(); ++i) {
    updates_.worst = SolveStatus::kOk;  // those before were on the way
    update();
    if (pipeline_.report().lost || deadline_.isOver()) break;
  }
  pipeline_.setMostIterations(scene_.solver.max_iterations.value_or(0));
}

// Tools by a force follow the tissue, unless it takes far too long. In time they go as it goes by.
void Runner::followPushes() {
  if (pipeline_.tissue().isInTime()) return;
  const auto any = std::any_of(pushes_.begin(), pushes_.end(), [](const auto& p) { return p; });
  for (int i = 0; any && i < tuning::kMostUpdates; ++i) {
    const StepReport& report = pipeline_.report();
    if (i > 0 && (!report.changed || report.hopeless || deadline_.isOver())) break;
    update();
  }
}

void Runner::update() {
  RobotPose pose = tools_.pose();
  pose.stamp_s = time_;
  const StepReport& report = pipeline_.step(pose);
  updates_.any = true;
  springs_cut_ += report.springs_cut;
  area_cut_ += report.area_cut;
  volume_removed_ += report.volume_removed;
  contact_ms_ += report.contact_ms;
  updates_.solve_ms += report.solve_ms;
  updates_.worst = std::max(updates_.worst, pipeline_.tissue().lastReport().status);
  if (report.too_fast) updates_.worst = std::max(updates_.worst, SolveStatus::kLate);
  if (report.lost) updates_.worst = std::max(updates_.worst, SolveStatus::kUnconverged);
  for (const StepRemark& of_step : remarksOn(pipeline_)) {
    const bool is_how_it_ends = of_step.kind == StepRemark::Kind::kHoldsNothing;
    if (!is_how_it_ends) remark(of_step.text);
  }
}

// After a step; on its way jaws may close and hold by and by.
void Runner::remarkHolds() {
  for (const StepRemark& at_end : remarksOn(pipeline_)) {
    if (at_end.kind == StepRemark::Kind::kHoldsNothing) remark(at_end.text);
  }
}

void Runner::remarkCut(std::size_t tool) {
  if (volume_removed_ > 0.0) {
    remark("tool '" + tools_.name(tool) + "' removed " + numberText(volume_removed_) +
           " m^3; pieces: " + std::to_string(pipeline_.tissue().state().pieces));
  }
  if (springs_cut_ == 0) return;
  remark("tool '" + tools_.name(tool) + "' cut " + std::to_string(springs_cut_) + " springs, " +
         numberText(area_cut_) +
         " m^2 of new surface; pieces: " + std::to_string(pipeline_.tissue().state().pieces));
}

// Before a row is kept. Its numbers differ from row to row: of those in a step the last one stays.
void Runner::judgePush(std::size_t tool) {
  const ToolReport& report = pipeline_.report().tools[tool];
  if (report.saturated) return;  // its force is not told
  // What a cut or a release changes moves the tissue, and the tool, in the time to come.
  const bool no_time = !result_.increments.empty() && result_.increments.back().time == time_;
  if (pipeline_.tissue().isInTime() && no_time) return;
  const Pose& tissue_T_link = pipeline_.pose()->links[tools_.firstLink(tool)];
  const double wanted = pushes_[tool]->norm();
  const Vec3 force = -(tissue_T_link.linear() * report.force_on_tool);
  const double met = force.dot(*pushes_[tool]) / wanted + 0.0;  // not -0
  if (std::abs(met - wanted) <= tuning::kMetForce * wanted) return;
  updates_.worst = std::max(updates_.worst, SolveStatus::kUnconverged);
  if (!unmet_[tool]) {
    unmet_[tool] = result_.remarks.size();
    result_.remarks.emplace_back();
  }
  result_.remarks[*unmet_[tool]] = ofStep(
      "tool '" + tools_.name(tool) + "' met " + numberText(met) + " N on its way of " +
      numberText(report.offset.norm()) + " m, not the force of " + numberText(wanted) + " N");
}

}  // namespace robot_tissue
