#include "blades.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/pipeline/pipeline.h"
#include "stopwatch.h"
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

bool Blades::goTo(RobotPose& pose) {
  bool all = true;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (!world_.tools[tool].role.has_edge) continue;
    all = goTo(tool, pose) && all;
  }
  return all;
}

bool Blades::goTo(std::size_t tool, RobotPose& pose) {
  BladeState& state = states_[tool];
  const std::size_t link = world_.tools.firstLink(tool);
  StrideActions actions;
  actions.length = tuning::kBladeStride * world_.tissue.lattice().spacing();
  actions.forget = [&] { comeIn(tool, state); };
  actions.move = [&](const std::vector<Pose>& there) { moveTo(there.front(), state); };
  actions.act = [&] { cutAlongPath(tool, state); };
  return goInStrides(world_, tool, {link, link + 1}, actions, state.strides, pose);
}

void Blades::comeIn(std::size_t tool, BladeState& state) const {
  const Strides strides = state.strides;
  state = BladeState();
  state.strides = strides;
  state.path = strides.stands;
  state.point = nearestOf(world_.tools[tool].blade.edge, Vec3::Zero());
}

// The edge pays on the way of its point.
void Blades::moveTo(const Pose& pose, BladeState& state) const {
  const Vec3 way = pose * state.point - state.stands() * state.point;
  const double length = way.norm();
  state.path.push_back(pose);
  if (!(length > 0.0)) return;
  state.direction = way / length;
  const double paid = tuning::kStrideRounding * world_.tissue.lattice().spacing();
  for (CutDebt& debt : state.debts) debt.way -= length;
  state.debts.erase(std::remove_if(state.debts.begin(), state.debts.end(),
                                   [&](const CutDebt& debt) { return debt.way <= paid; }),
                    state.debts.end());
}

void Blades::cutAlongPath(std::size_t tool, BladeState& state) {
  const std::vector<CutTriangle> swept = sweptBy(tool, state.path);
  state.path = {state.stands()};
  const Stopwatch watch(world_.report.solve_ms);
  const Stroke stroke = state.debts.empty() ? Stroke::kBegins : Stroke::kGoesOn;
  const CutReport cut = world_.tissue.cutAlong(swept, stroke);
  if (cut.springs_cut == 0) return;
  const BladeConfig& blade = world_.tools[tool].blade;
  const double spacing = world_.tissue.lattice().spacing();
  state.debts.push_back({blade.resistance * cut.area / spacing, spacing});
  state.point = nearestOf(blade.edge, state.stands().inverse() * cut.center);
  world_.sliding.commit(world_.pose, world_.tissue);
  world_.dead_end.reset();
  world_.report.changed = true;
  world_.report.springs_cut += cut.springs_cut;
  world_.report.area_cut += cut.area;
}

// By the edge from pose to pose; arcs as chords of kLongestArc at most.
std::vector<CutTriangle> Blades::sweptBy(std::size_t tool, const std::vector<Pose>& path) const {
  const std::vector<Vec3>& edge = world_.tools[tool].blade.edge;
  std::vector<CutTriangle> swept;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Eigen::AngleAxisd turn(path[i].linear().transpose() * path[i + 1].linear());
    const int chords = std::max(1, static_cast<int>(std::ceil(turn.angle() / tuning::kLongestArc)));
    for (int chord = 0; chord < chords; ++chord) {
      const Pose from = between(path[i], path[i + 1], static_cast<double>(chord) / chords);
      const Pose to = between(path[i], path[i + 1], static_cast<double>(chord + 1) / chords);
      for (std::size_t j = 0; j + 1 < edge.size(); ++j) {
        const Vec3 a = from * edge[j], b = from * edge[j + 1], c = to * edge[j + 1],
                   d = to * edge[j];
        swept.push_back({a, b, c});
        swept.push_back({a, c, d});
      }
    }
  }
  return swept;
}

void Blades::describe(std::size_t tool, ToolReport& report) const {
  const BladeState& state = states_[tool];
  if (!world_.tools[tool].role.has_edge || state.debts.empty()) return;
  double force = 0.0;
  for (const CutDebt& debt : state.debts) force += debt.force;
  report.force_on_tool = -force * (state.stands().linear().transpose() * state.direction);
  report.torque_on_tool = state.point.cross(report.force_on_tool);
  report.point = state.stands() * state.point;
  limitWrench(world_.tools[tool].max_force, report);
}

}  // namespace robot_tissue
