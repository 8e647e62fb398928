#include "pacing.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tuning.h"

namespace robot_tissue {
namespace {

int wholeParts(double way, double part) {
  return std::max(1,
                  static_cast<int>(std::ceil(std::min(way / part, 1e5) - tuning::kUpdateRounding)));
}

// Where patches and tools stand on the way through the steps.
struct Standing {
  std::map<std::string, Vec3> patches;  // displacement (m); of patches by force zero
  std::map<std::string, MoveStep::Place> tools;
};

// Longest way of a patch that a displacement moves (m); negative when all go by a force.
double wayOf(const LoadStep& load, Standing& standing) {
  double way = -1.0;
  for (const PatchConfig& patch : load.patches) {
    Vec3& displacement = standing.patches.try_emplace(patch.name, Vec3::Zero()).first->second;
    if (!patch.displacement) continue;
    Vec3 target = displacement;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      target[row] = (*patch.displacement)[axis].value_or(displacement[row]);
    }
    way = std::max(way, (target - displacement).norm());
    displacement = target;
  }
  return way;
}

class Pacer {
 public:
  Pacer(double spacing, double way_an_update) : spacing_(spacing), way_an_update_(way_an_update) {}

  int operator()(LoadStep& load) {
    const double way = wayOf(load, standing_);
    const int otherwise = way < 0.0 ? tuning::kUpdatesOfForce : wholeParts(way, way_an_update_);
    const int updates = load.increments.value_or(otherwise);
    const int parts = way > 0.0 ? wholeParts(way / updates, 0.5 * spacing_) : 1;
    load.increments = updates * parts;
    return parts;
  }
  int operator()(MoveStep& move) {
    const auto stands = standing_.tools.find(move.tool);
    const MoveStep::Place from =
        move.from || stands == standing_.tools.end() ? move.from.value_or(move.to) : stands->second;
    const double way = (move.to.pose.translation() - from.pose.translation()).norm();
    if (!move.increments) move.increments = wholeParts(way, way_an_update_);
    standing_.tools[move.tool] = move.to;
    return 1;
  }
  int operator()(PushStep& push) {
    if (!push.increments) push.increments = tuning::kUpdatesOfForce;
    return 1;
  }
  int operator()(ReleaseStep& release) {
    for (const std::string& name : release.patches) standing_.patches.erase(name);
    return 0;
  }
  int operator()(ResetStep&) {
    standing_ = Standing();
    return 0;
  }
  template <typename Other>
  int operator()(Other&) {
    return 0;
  }

 private:
  double spacing_;
  double way_an_update_;
  Standing standing_;
};

struct IncrementsOf {
  int operator()(const LoadStep& step) const { return step.increments.value_or(1); }
  int operator()(const MoveStep& step) const { return step.increments.value_or(1); }
  int operator()(const WaitStep& step) const { return step.increments.value_or(1); }
  int operator()(const PushStep& step) const { return step.increments.value_or(1); }
  template <typename Other>
  int operator()(const Other&) const {
    return 1;
  }
};

}  // namespace

PacedScene paced(const Scene& scene, double way_an_update) {
  PacedScene result{scene, {}};
  Pacer pacer(scene.tissue.spacing, way_an_update);
  for (Step& step : result.scene.steps) {
    result.parts.push_back(std::visit([&](auto& any) { return pacer(any); }, step));
  }
  const auto timed = [](int parts) { return parts > 0; };
  if (std::none_of(result.parts.begin(), result.parts.end(), timed)) {
    result.parts.assign(result.parts.size(), 1);
  }
  return result;
}

int updateCount(const PacedScene& paced) {
  int updates = 0;
  for (std::size_t step = 0; step < paced.parts.size(); ++step) {
    const int increments = std::visit(IncrementsOf(), paced.scene.steps[step]);
    if (paced.parts[step] > 0) updates += increments / paced.parts[step];
  }
  return updates;
}

}  // namespace robot_tissue
