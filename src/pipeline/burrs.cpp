#include "burrs.h"

#include <algorithm>

#include "stopwatch.h"
#include "tuning.h"

namespace robot_tissue {

void Burrs::endStrokes() {
  for (BurrState& state : states_) state.is_drilling = false;
}

bool Burrs::goTo(RobotPose& pose) {
  bool all = true;
  world_.report.would_take_all.clear();  // told as long as they stand there
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (!world_.tools[tool].role.drills) continue;
    all = goTo(tool, pose) && all;
    if (states_[tool].is_refused) addOnce(tool, world_.report.would_take_all);
  }
  return all;
}

bool Burrs::goTo(std::size_t tool, RobotPose& pose) {
  BurrState& state = states_[tool];
  StrideActions actions;
  actions.length = strideOf(tool);
  actions.forget = [&] {
    const Strides strides = state.strides;
    state = BurrState();
    state.strides = strides;
  };
  actions.move = [](const std::vector<Pose>&) {};
  actions.act = [&] { drill(tool, state); };
  return goInStrides(world_, tool, world_.tools.linksOf(tool), actions, state.strides, pose);
}

// m. What a thin shape passes on its way is not to be missed between two strides.
double Burrs::strideOf(std::size_t tool) const {
  const double spacing = world_.tissue.lattice().spacing();
  double stride = tuning::kBladeStride * spacing;
  for (std::size_t link = world_.tools.firstLink(tool); link < world_.tools.endLink(tool); ++link) {
    stride = std::min(stride, tuning::kStrideOfBurr * world_.drills.thickness(link));
  }
  return std::max(stride, tuning::kLeastStride * spacing);
}

void Burrs::drill(std::size_t tool, BurrState& state) {
  const double spacing = world_.tissue.lattice().spacing();
  state.way += strideOf(tool);
  state.is_drilling = state.is_drilling && state.way <= (1.0 + tuning::kStrideRounding) * spacing;
  if (state.is_refused) return;
  Box bounds;
  for (std::size_t i = 0; i < state.strides.stands.size(); ++i) {
    bounds.extend(world_.drills.bounds(world_.tools.firstLink(tool) + i, state.strides.stands[i]));
  }
  const auto covers = [&](const Vec3& point) {
    for (std::size_t i = 0; i < state.strides.stands.size(); ++i) {
      const std::size_t link = world_.tools.firstLink(tool) + i;
      if (world_.drills.wayOut(link, state.strides.stands[i], point, 0.0)) return true;
    }
    return false;
  };
  const Stopwatch watch(world_.report.solve_ms);
  const Stroke stroke = state.is_drilling ? Stroke::kGoesOn : Stroke::kBegins;
  const RemoveReport removed = world_.tissue.drill(CoveredSpace{bounds, covers}, stroke);
  state.is_refused = removed.holds_all;
  if (!(removed.volume > 0.0)) return;
  state.is_drilling = true;
  state.way = 0.0;
  world_.sliding.commit(world_.pose, world_.tissue);
  world_.dead_end.reset();
  world_.report.changed = true;
  world_.report.volume_removed += removed.volume;
  for (const std::string& load : removed.loads) world_.report.lost_loads.push_back(load);
}

}  // namespace robot_tissue
