#include "runner.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "robot_tissue/pipeline/step_remarks.h"

namespace robot_tissue {
namespace {

const char* keyOf(const SettleStep&) { return "settle"; }
const char* keyOf(const LoadStep&) { return "load"; }
const char* keyOf(const CutStep&) { return "cut"; }
const char* keyOf(const SutureStep&) { return "suture"; }
const char* keyOf(const ReleaseStep&) { return "release"; }
const char* keyOf(const ResetStep&) { return "reset"; }
const char* keyOf(const MoveStep&) { return "move"; }
const char* keyOf(const WaitStep&) { return "wait"; }
const char* keyOf(const PushStep&) { return "push"; }
const char* keyOf(const GraspStep&) { return "grasp"; }
const char* keyOf(const RemoveStep&) { return "remove"; }
const char* keyOf(const UndoStep&) { return "undo"; }
const char* keyOf(const SaveStep&) { return "save"; }
const char* keyOf(const LoadStateStep&) { return "load_state"; }

std::string pathOf(const Scene& scene, int step) {
  const Step& taken = scene.steps[at(step)];
  return "steps[" + std::to_string(step) + "]." +
         std::visit([](const auto& any) { return keyOf(any); }, taken);
}

// The tools that some step places; others, such as the node's without shapes, play no part.
std::vector<ToolConfig> movedTools(const Scene& scene) {
  std::set<std::string> moved;
  for (const Step& step : scene.steps) {
    if (const auto* move = std::get_if<MoveStep>(&step)) moved.insert(move->tool);
  }
  std::vector<ToolConfig> tools;
  for (const ToolConfig& tool : scene.tools) {
    if (moved.count(tool.name) > 0) tools.push_back(tool);
  }
  return tools;
}

}  // namespace

Runner::Runner(const Scene& scene, const OnRow& on_row, const OnStep& on_step,
               const Deadline& deadline, const std::string& state_folder)
    : scene_(scene),
      parts_tissue_(partsTissue(scene)),
      on_row_(on_row),
      on_step_(on_step),
      deadline_(deadline),
      state_folder_(state_folder),
      tools_(movedTools(scene)),
      pipeline_(scene.tissue, scene.solver, toolsOf(movedTools(scene)).tools, scene.supports),
      pushes_(tools_.count()) {
  for (const std::string& warning : pipeline_.toolWarnings()) result_.remarks.push_back(warning);
  pipeline_.startClock(time_);
  if (std::isfinite(deadline.leftMs())) pipeline_.setEnd(deadline);
  pipeline_.limitPatience();
  pipeline_.setMostIterations(scene.solver.max_iterations.value_or(0));
}

RunResult Runner::run() {
  try {
    performAll();
  } catch (const TimeIsOver&) {
    result_.cut_off =
        pathOf(scene_, step_) + " increment " + std::to_string(result_.increments.back().increment);
  }
  keepShape();
  return std::move(result_);
}

// Of loose tissue the rest shape is no place to begin from, unless the step that is next sees to
// that.
void Runner::layDown(const Step& next) {
  const bool is_seen_to = std::holds_alternative<SettleStep>(next) ||
                          std::holds_alternative<LoadStateStep>(next) ||
                          std::holds_alternative<ResetStep>(next);
  if (is_seen_to || !pipeline_.isLoose()) return;
  if (pipeline_.settle().status != SolveStatus::kOk) {
    result_.remarks.push_back("the tissue, which nothing fixes, does not come to lie on supports");
  }
}

void Runner::performAll() {
  for (std::size_t i = 0; i < scene_.steps.size(); ++i) {
    step_ = static_cast<int>(i);
    unmet_.assign(tools_.count(), std::nullopt);
    try {
      const bool is_at_rest = i == 0 || std::holds_alternative<ResetStep>(scene_.steps[i - 1]);
      if (is_at_rest) layDown(scene_.steps[i]);
      const int torn = pipeline_.tissue().springsTorn();
      const std::size_t dropped = pipeline_.tissue().droppedPieces().size();
      const std::set<std::string> loads = standingLoads();
      const bool was_impatient = pipeline_.tissue().patience().cutsOff();
      std::visit([this](const auto& step) { perform(step); }, scene_.steps[i]);
      remarkTorn(torn);
      remarkDropped(dropped);
      noteLost(loads);
      if (!was_impatient) remarkImpatience();
      if (on_step_) on_step_(step_, pipeline_.tissue());
    } catch (const EntryError& error) {
      throw InputError(pathOf(scene_, step_) + "." + error.what());
    } catch (const InputError& error) {
      throw InputError(pathOf(scene_, step_) + ": " + error.what());
    }
  }
}

void Runner::perform(const SettleStep&) {
  pipeline_.stopTime();
  catchUp();
  const SolveReport report = pipeline_.settle();
  followPushes();
  keep(report);
}

// Tools that a force drives stand still during such a step, as the others do.
void Runner::perform(const LoadStep& step) {
  pipeline_.load(step, [this](int increment, int increments, const SolveReport& report) {
    keep(report, increment, increments);
  });
}

void Runner::perform(const ReleaseStep& step) {
  SolveReport report;
  const std::vector<std::string> patches = stillStanding(step.patches);
  if (!patches.empty()) {
    report = pipeline_.release(patches);
  } else if (step.tools.empty()) {
    report = pipeline_.tissue().lastReport();
  }
  for (const std::string& name : step.tools) {
    const std::size_t tool = tools_.indexOf(name);
    if (!pushes_[tool] && !pipeline_.report().tools[tool].grasps) {
      remark("tool '" + name + "' holds nothing and no force pushes it");
    }
    endPush(tool);
    pipeline_.letGo(tool);
  }
  if (!step.tools.empty()) follow();
  followPushes();
  keep(report);
}

void Runner::perform(const ResetStep&) {
  pipeline_.reset();
  tools_.takeAway();
  pushes_.assign(tools_.count(), std::nullopt);
  keep(SolveReport());
}

// A row of increments.csv, with times and status of the tools' updates since the last row.
void Runner::keep(SolveReport report, int increment, int increments) {
  if (updates_.any) {
    for (std::size_t tool = 0; tool < tools_.count(); ++tool) {
      if (pushes_[tool]) judgePush(tool);
    }
    const SolveStatus worst = std::max(report.status, updates_.worst);
    const double wall_ms = report.wall_ms + updates_.solve_ms;
    report = pipeline_.tissue().lastReport();
    if (updates_.solve_ms <= 0.0) report.iterations = 0;
    report.wall_ms = wall_ms;
    report.status = worst;
    updates_ = Updates();
  }
  const std::vector<LoadingPatch>& patches = pipeline_.tissue().patches();
  const std::size_t named = pipeline_.tissue().namedPatches();
  if (report.patches.size() < named) {
    throw std::logic_error("the solver answered for " + std::to_string(report.patches.size()) +
                           " patches, " + std::to_string(named) + " stand");
  }
  for (std::size_t i = 0; i < named; ++i) {
    result_.patches.push_back({step_, increment, patches[i].name, report.patches[i]});
  }
  for (std::size_t tool = 0; tool < tools_.count(); ++tool) {
    if (tools_.of(tool)) keepTool(tool, increment);
  }
  if (parts_tissue_) keepPieces(increment);
  keepSutures(increment);
  const std::string of_law = remarkOnLaw(pipeline_.tissue());
  if (!of_law.empty()) remark(of_law);
  const std::string of_adrift = remarkOnAdrift(pipeline_.tissue());
  if (!of_adrift.empty()) remark(of_adrift);
  const double update_ms = report.wall_ms + std::exchange(contact_ms_, 0.0);
  result_.increments.push_back({step_, increment, report, update_ms, time_});
  if (on_row_) on_row_(result_.increments.back(), increments);
  const bool more = is_cut_short_ || increment < increments || at(step_) + 1 < scene_.steps.size();
  if (more && deadline_.isOver()) throw TimeIsOver();
}

std::string Runner::ofStep(const std::string& text) const {
  return pathOf(scene_, step_) + ": " + text;
}

// Once a step.
void Runner::remark(const std::string& text) {
  const std::string line = ofStep(text);
  std::vector<std::string>& all = result_.remarks;
  if (std::find(all.begin(), all.end(), line) == all.end()) all.push_back(line);
}

// `before`: springs that had torn before the step.
void Runner::remarkTorn(int before) {
  const int torn = pipeline_.tissue().springsTorn() - before;
  if (torn <= 0) return;
  remark(std::to_string(torn) +
         " springs tore; pieces: " + std::to_string(pipeline_.tissue().state().pieces));
}

void Runner::remarkImpatience() {
  if (!pipeline_.tissue().patience().cutsOff()) return;
  remark(
      "it took far too many iterations; while load steps go on to be hard, each has the usual "
      "ones alone");
}

void Runner::keepTool(std::size_t tool, int increment) {
  const ToolReport& report = pipeline_.report().tools[tool];
  const Pose& tissue_T_link = pipeline_.pose()->links[tools_.firstLink(tool)];
  ToolRow row{step_, increment, tools_.name(tool)};
  const Vec3 torque =
      report.torque_on_tool - tools_.originInFirstLink(tool).cross(report.force_on_tool);
  row.force = tissue_T_link.linear() * report.force_on_tool;
  row.torque = tissue_T_link.linear() * torque;
  row.contacts = report.contacts;
  row.max_penetration = report.max_penetration;
  result_.tools.push_back(row);
  if (report.saturated) {
    remark("tool '" + tools_.name(tool) +
           "': a wrench stronger than its max_force is told as that");
  }
}

void Runner::keepShape() {
  const Tissue& tissue = pipeline_.tissue();
  const Lattice& lattice = tissue.lattice();
  const std::vector<Vec3> displacement = tissue.shownDisplacement();
  deform(tissue.surface(), displacement, result_.vertices);
  result_.triangles = tissue.surface().triangles;
  for (int node = 0; node < lattice.nodeCount(); ++node) {  // ghosts beyond are none of its nodes
    if (isRemoved(tissue.state(), node)) continue;
    result_.rest.push_back(lattice.restPosition(node));
    result_.displacement.push_back(displacement[at(node)]);
  }
}

}  // namespace robot_tissue
