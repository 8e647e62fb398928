#include "blades.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "robot_tissue/pipeline/pipeline.h"
#include "stopwatch.h"
#include "swept_surface.h"
#include "tool_reports.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

Vec3 nearestOf(const std::vector<Vec3>& edge, const Vec3& point) {
  Vec3 nearest = edge.front();
  for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
    const Vec3 along = edge[i + 1] - edge[i];
    const double share = std::clamp((point - edge[i]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Vec3 foot = edge[i] + share * along;
    if ((foot - point).norm() < (nearest - point).norm()) nearest = foot;
  }
  return nearest;
}

}  // namespace

void Blades::forget() {
  states_.assign(world_.tools.size(), BladeState());
  for (std::size_t tool = 0; tool < states_.size(); ++tool) setPhase(tool, EdgePhase::kOutside);
}

void Blades::endStrokes() {
  for (BladeState& state : states_) state.since_cut = std::numeric_limits<double>::infinity();
}

bool Blades::goTo(RobotPose& pose) {
  bool all = true;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (!world_.tools[tool].role.has_edge) continue;
    BladeState& state = states_[tool];
    if (state.is_coming_back) comeBack(tool);
    all = goTo(tool, pose) && !state.is_coming_back && all;
  }
  return all;
}

void Blades::partAhead(const RobotPose& pose) {
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (!world_.mayEdgeTouch(tool) || world_.is_trial) continue;
    const bool has_sides = !world_.tools[tool].links.front().shapes.empty();
    const BladeState& state = states_[tool];
    if (!has_sides || state.phase != EdgePhase::kInside || state.strides.stands.empty()) continue;
    RobotPose there = pose;
    goTo(tool, there);
  }
}

bool Blades::goTo(std::size_t tool, RobotPose& pose) {
  BladeState& state = states_[tool];
  const std::size_t link = world_.tools.firstLink(tool);
  StrideActions actions;
  actions.length = lookLength();
  actions.forget = [&] { forgetWay(tool); };
  actions.move = [&](const std::vector<Pose>& there) {
    countDentWork(tool, state.stands());
    moveTo(there.front(), state);
  };
  actions.act = [&] { look(tool); };
  return goInStrides(world_, tool, {link, link + 1}, actions, state.strides, pose);
}

void Blades::forgetWay(std::size_t tool) {
  BladeState& state = states_[tool];
  const BladeState before = state;
  state = BladeState();
  state.strides = before.strides;
  state.phase = before.phase;
  state.path = before.strides.stands;
  state.point = nearestOf(world_.tools[tool].blade.edge, Vec3::Zero());
}

// m: an edge that presses is looked at some times in a stride.
double Blades::lookLength() const {
  return tuning::kBladeStride / tuning::kLooksInStride * world_.tissue.lattice().spacing();
}

void Blades::look(std::size_t tool) {
  BladeState& state = states_[tool];
  state.looks = (state.looks + 1) % tuning::kLooksInStride;
  if (state.phase != EdgePhase::kInside) press(tool);
  const bool cuts = state.phase == EdgePhase::kInside && state.looks == 0;
  if (!cuts || state.is_coming_back) return;
  cutAlongPath(tool, state);
  if (state.debts.empty()) leave(tool);
}

// The edge pays on the way of its point.
void Blades::moveTo(const Pose& pose, BladeState& state) const {
  const Vec3 way = pose * state.point - state.stands() * state.point;
  const double length = way.norm();
  state.path.push_back(pose);
  if (state.phase != EdgePhase::kInside) keepShort(state.path);
  if (!(length > 0.0)) return;
  state.direction = way / length;
  const double paid = tuning::kStrideRounding * world_.tissue.lattice().spacing();
  state.since_cut += length;
  for (CutDebt& debt : state.debts) debt.way -= length;
  state.debts.erase(std::remove_if(state.debts.begin(), state.debts.end(),
                                   [&](const CutDebt& debt) { return debt.way <= paid; }),
                    state.debts.end());
}

void Blades::cutAlongPath(std::size_t tool, BladeState& state) {
  std::vector<CutTriangle> swept;
  addSwept(world_.tools[tool].blade.edge, state.path, swept);
  state.path = {state.stands()};
  const Stopwatch watch(world_.report.solve_ms);
  const double spacing = world_.tissue.lattice().spacing();
  const bool goes_on = state.since_cut <= tuning::kStrokeEnds * spacing;
  const Stroke stroke = goes_on ? Stroke::kGoesOn : Stroke::kBegins;
  const CutReport cut = world_.tissue.cutAlong(swept, stroke);
  const double dent_work = std::exchange(state.dent_work, 0.0);
  if (cut.springs_cut == 0) return;
  const BladeConfig& blade = world_.tools[tool].blade;
  const double work = std::max(0.0, blade.resistance * cut.area - dent_work);
  state.debts.push_back({work / spacing, spacing});
  state.since_cut = 0.0;
  state.point = nearestOf(blade.edge, state.stands().inverse() * cut.center);
  noteCut(world_, cut);
}

void Blades::describe(std::size_t tool, ToolReport& report) const {
  const BladeState& state = states_[tool];
  if (!world_.tools[tool].role.has_edge || state.debts.empty()) return;
  double force = 0.0;
  for (const CutDebt& debt : state.debts) force += debt.force;
  const Vec3 of_cut = -force * (state.stands().linear().transpose() * state.direction);
  report.force_on_tool += of_cut;
  report.torque_on_tool += state.point.cross(of_cut);
  report.point = state.stands() * state.point;
}

}  // namespace robot_tissue
