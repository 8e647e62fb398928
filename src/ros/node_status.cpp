// How the node is, in the words of its state and of the diagnostics.
#include "robot_tissue/ros/node_status.h"

#include <cstdio>
#include <string>

#include "robot_tissue/pipeline/step_remarks.h"
#include "robot_tissue/ros/tissue_node.h"
#include "robot_tissue/scene/memory.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

using diagnostic_msgs::DiagnosticStatus;

// The word of TissueState.msg for a remark. Jaws that meet, or hold nothing, are no fault by
// themselves: jaws that close where no tissue is do both. A burr that stops has done all it could.
// A law that goes on otherwise has its own equilibrium.
std::string wordOf(StepRemark::Kind kind) {
  switch (kind) {
    case StepRemark::Kind::kInside:
      return "INSIDE";
    case StepRemark::Kind::kHooked:
      return "HOOKED";
    case StepRemark::Kind::kJammed:
      return "JAMMED";
    case StepRemark::Kind::kTornOff:
      return "TORN_OFF";
    case StepRemark::Kind::kTooFast:
      return "TOO_FAST";
    case StepRemark::Kind::kLost:
    case StepRemark::Kind::kAdrift:
      return "UNCONVERGED";
    case StepRemark::Kind::kBeyondLaw:
    case StepRemark::Kind::kJawsMeet:
    case StepRemark::Kind::kHoldsNothing:
    case StepRemark::Kind::kDrills:
      break;
  }
  return "OK";
}

void say(const std::string& word, const std::string& message, NodeStatus& status) {
  if (status.status == "OK") status.status = word;
  status.message += (status.message.empty() ? "" : "; ") + message;
}

// Of a way (m): three digits.
std::string wayText(double way) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", way);
  return text;
}

// Tools whose force (~apply_load) nothing answers, until they are released.
void sayUnanswered(const Pipeline& pipeline, NodeStatus& status) {
  const std::vector<ToolReport>& tools = pipeline.report().tools;
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (!tools[tool].unanswered) continue;
    say("UNCONVERGED",
        "nothing answers with the force on " + namesOf({tool}, pipeline.tools()) +
            " (apply_load): it stands " + wayText(tools[tool].offset.norm()) +
            " m from its pose; push it towards the tissue, or release it",
        status);
  }
}

// The shape is that of the pose, and its wrenches are told: no fault.
bool stillSettles(const Pipeline& pipeline) {
  return pipeline.report().late && pipeline.hasArrived();
}

}  // namespace

NodeStatus statusOf(const Pipeline& pipeline, const std::vector<StepRemark>& remarks) {
  const StepReport& report = pipeline.report();
  NodeStatus status;
  for (const StepRemark& remark : remarks) {
    say(wordOf(remark.kind), remark.text, status);
  }
  sayUnanswered(pipeline, status);
  const SolveReport& solve = pipeline.tissue().lastReport();
  if (stillSettles(pipeline)) {
    say("LATE", "contacts still settle (solver.max_iterations); the shape is in balance", status);
  } else if (report.late) {
    say("LATE", "the update ran out of its time (solver.max_ms, else 0.1 s) and is carried on",
        status);
  } else if (report.gave_up || solve.status == SolveStatus::kUnconverged) {
    say("UNCONVERGED", "the solve did not come to balance in its iterations", status);
  } else if (solve.status == SolveStatus::kInverted) {
    say("INVERTED", std::to_string(solve.inverted_cells) + " cells are inverted", status);
  }
  return status;
}

std::string endOfAnswer(const SolveReport& solve, const Pipeline& pipeline) {
  if (solve.status == SolveStatus::kOk) return "";
  return std::string("; ") + toString(solve.status) + (pipeline.isLate() ? ", carried on" : "");
}

// Of an update, for the diagnostics, which come seldom.
void TissueNode::remember(const std::vector<StepRemark>& remarks) {
  for (const StepRemark& remark : remarks) {
    if (remark.kind != StepRemark::Kind::kHoldsNothing) tools_said_[remark.kind] = remark.text;
  }
  was_late_ = was_late_ || (pipeline_.report().late && !stillSettles(pipeline_));
}

void TissueNode::addDiagnostics() {
  diagnostics_.setHardwareIDf("%s %s: %d nodes", parameters_.scene.tissue.model.c_str(),
                              parameters_.scene.solver.method.c_str(),
                              pipeline_.tissue().lattice().nodeCount());
  rate_told_ = ros::SteadyTime::now();
  diagnostics_.add("update rate", this, &TissueNode::diagnoseRate);
  diagnostics_.add("transforms", this, &TissueNode::diagnoseTransforms);
  diagnostics_.add("tools", this, &TissueNode::diagnoseTools);
  diagnostics_.add("solver", this, &TissueNode::diagnoseSolver);
}

// Poses may come as seldom as they do: `~rate` is how often they are followed at most.
void TissueNode::diagnoseRate(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double seconds = (now - rate_told_).toSec();
  rate_told_ = now;
  const PoseWatch::Counts counts = watch_.counts();
  const bool keeps_up = counts.missed <= 1 || counts.missed <= tuning::kMostMissed * counts.came;
  if (keeps_up) {
    status.summary(DiagnosticStatus::OK, counts.came > 0 ? "keeps up" : "no new poses");
  } else {
    status.summaryf(DiagnosticStatus::WARN, "%d of %d poses were missed: updates take longer",
                    counts.missed, counts.came);
  }
  status.add("poses (Hz)", counts.came / seconds);
  status.add("poses followed (Hz)", (counts.came - counts.missed) / seconds);
  status.add("followed at most (Hz, ~rate)", parameters_.rate_hz);
}

void TissueNode::diagnoseTransforms(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!robot_is_known_) {
    status.summary(DiagnosticStatus::ERROR, "no robot description");
  } else if (last_look_up_.status == PoseLookUp::Status::kOk) {
    status.summary(DiagnosticStatus::OK, "fresh");
  } else if (ros::SteadyTime::now() < grace_end_) {
    status.summary(DiagnosticStatus::OK, "waiting: " + last_look_up_.message);
  } else {
    status.summary(DiagnosticStatus::ERROR, last_look_up_.message);
  }
  status.add("age of the pose (s)", last_look_up_.age_s);
}

// Diagnostics of the tools: what was said of them since the last ones, and how each is now.
void TissueNode::diagnoseTools(diagnostic_updater::DiagnosticStatusWrapper& status) {
  pipeline_.findDepths();
  const StepReport& report = pipeline_.report();
  for (const StepRemark& remark : remarksOn(pipeline_)) {
    if (remark.kind == StepRemark::Kind::kJawsMeet) tools_said_[remark.kind] = remark.text;
  }
  const bool are_followed = last_look_up_.status == PoseLookUp::Status::kOk;
  const std::string good = are_followed ? "followed" : "not followed: no good pose";
  status.summary(DiagnosticStatus::OK, tools_said_.empty() ? good : "");
  for (const auto& [kind, text] : tools_said_) status.mergeSummary(DiagnosticStatus::WARN, text);
  tools_said_.clear();
  for (std::size_t tool = 0; tool < report.tools.size(); ++tool) {
    const ToolReport& met = report.tools[tool];
    const std::string& name = pipeline_.tools()[tool].name;
    if (met.saturated) {
      status.mergeSummary(DiagnosticStatus::WARN,
                          "the wrench of '" + name + "' is longer than its max_force");
    }
    status.add(name + ": points that touch", met.contacts);
    status.add(name + ": deepest in the surface (m)", met.max_penetration);
    if (met.jaw_gap) status.add(name + ": between its jaws where tissue is (m)", *met.jaw_gap);
    if (!met.holds_nothing.empty()) status.add(name + ": holds nothing", met.holds_nothing);
  }
}

void TissueNode::diagnoseSolver(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const SolveReport& solve = pipeline_.tissue().lastReport();
  const bool settles = stillSettles(pipeline_);
  const bool late = was_late_ || (pipeline_.report().late && !settles);
  const bool good = (solve.status == SolveStatus::kOk || settles) && !late;
  const char* word =
      toString(late && solve.status == SolveStatus::kOk ? SolveStatus::kLate : solve.status);
  status.summary(good ? DiagnosticStatus::OK : DiagnosticStatus::WARN,
                 good && settles ? "contacts still settle" : word);
  was_late_ = false;
  status.add("solve (ms)", pipeline_.report().solve_ms);
  status.add("contact (ms)", pipeline_.report().contact_ms);
  status.add("residual", solve.residual);
  status.add("error estimate", solve.error_estimate);
  status.add("active nodes", solve.active_nodes);
  status.add("layers", solve.layers);
  status.add("nodes", pipeline_.tissue().lattice().nodeCount());
  status.add("pieces", pipeline_.tissue().state().pieces);
  status.addf("memory of the process (MB)", "%.1f", 1e-6 * residentMemory());
  status.addf("heap in use (MB)", "%.3f", 1e-6 * heapInUse());
}

}  // namespace robot_tissue
