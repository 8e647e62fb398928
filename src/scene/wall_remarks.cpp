#include "robot_tissue/scene/wall_remarks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot_tissue/core/mesh_walls.h"
#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
// How much too far a wall bends (1): one that is thinner than a spacing by kThin of the spacing
// over its thickness, the most over angles and places of the grid; a lone layer of whole cells by
// Poisson's ratio. Of thin_walls (doc/accuracy.md), whose 22 degrees are the worst.
constexpr double kThin = 0.25;
constexpr double kThinnest = 1.0 / 3.0;  // spacings: below that the law's floor makes them firmer
constexpr double kThinShare = 0.05;      // of the surface: less is not told. Chosen

std::string percentText(double share) { return numberText(std::round(100.0 * share)) + " %"; }
std::string mmText(double length) { return numberText(std::round(1e4 * length) / 10.0) + " mm"; }

struct Walls {
  double thinnest = kNone;  // m, of those no thicker than a spacing
  double thin_share = 0.0;  // of the area looked at
};

void lookAt(const WallSample& wall, double spacing, Walls& walls) {
  if (wall.thickness < spacing * (1.0 + 1e-9)) {
    walls.thin_share += wall.area;
    walls.thinnest = std::min(walls.thinnest, wall.thickness);
  }
}

Walls wallsOf(const TissueConfig& tissue) {
  const std::vector<WallSample> samples =
      tissue.mesh ? wallSamples(*tissue.mesh)
                  : std::vector<WallSample>{{tissue.shape.sizes().minCoeff(), Vec3::UnitX(), 1.0}};
  Walls walls;
  double all = 0.0;
  for (const WallSample& sample : samples) {
    all += sample.area;
    lookAt(sample, tissue.spacing, walls);
  }
  walls.thin_share /= all > 0.0 ? all : 1.0;
  return walls;
}

WallRemark thinWalls(const Walls& walls, const TissueConfig& tissue) {
  const double by_thickness = kThin / std::max(walls.thinnest / tissue.spacing, kThinnest);
  const double too_far = std::max(tissue.material.poisson_ratio, by_thickness);
  return {percentText(walls.thin_share) +
              " of the walls are no thicker than a spacing, the thinnest " +
              mmText(walls.thinnest) + ": they may bend up to " + percentText(too_far) + " too far",
          "tissue.spacing: " + numberText(0.5 * walls.thinnest) + " or less"};
}

}  // namespace

std::vector<WallRemark> wallRemarks(const TissueConfig& tissue) {
  if (!traitsOfModel(tissue.model).has_poisson_ratio) return {};  // its springs do not bend
  const Walls walls = wallsOf(tissue);
  std::vector<WallRemark> remarks;
  if (walls.thin_share >= kThinShare) remarks.push_back(thinWalls(walls, tissue));
  return remarks;
}

}  // namespace robot_tissue
