#include "swept_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot_tissue/pipeline/between.h"
#include "tuning.h"

namespace robot_tissue {

void addSwept(const std::vector<Vec3>& edge, const std::vector<Pose>& path,
              std::vector<CutTriangle>& swept) {
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
}

void keepShort(std::vector<Pose>& path) {
  if (path.size() <= tuning::kMostOfDent) return;
  std::vector<Pose> fewer;
  for (std::size_t i = 0; i + 1 < path.size(); i += 2) fewer.push_back(path[i]);
  fewer.push_back(path.back());
  path = std::move(fewer);
}

void noteCut(World& world, const CutReport& cut) {
  world.sliding.commit(world.pose, world.tissue);
  world.dead_end.reset();
  world.report.changed = true;
  world.report.springs_cut += cut.springs_cut;
  world.report.area_cut += cut.area;
}

}  // namespace robot_tissue
