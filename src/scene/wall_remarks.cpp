#include "robot_tissue/scene/wall_remarks.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "robot_tissue/core/mesh_walls.h"
#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kRounding = 1e-9;  // of the spacing
constexpr double kNone = std::numeric_limits<double>::infinity();
// How far walls bend over how far they should, at least and at most over angles and places of the
// grid: `thin_walls` (doc/data/thin_walls.csv), which measured these thicknesses (spacings).
struct Bends {
  double thickness, least, most;
};
constexpr Bends kBends[] = {
    {0.3, 0.49, 0.82}, {0.5, 0.71, 1.28}, {0.7, 0.83, 1.35}, {1.0, 0.97, 1.21}};
constexpr double kThinShare = 0.05;  // of the surface: less is not told. Chosen

std::string percentText(double share) { return numberText(std::round(100.0 * share)); }
std::string mmText(double length) { return numberText(std::round(1e4 * length) / 10.0) + " mm"; }

struct Walls {
  double thinnest = kNone;  // m, of those no thicker than a spacing
  double thin_share = 0.0;  // of the area looked at
};

void lookAt(const WallSample& wall, double spacing, Walls& walls) {
  if (wall.thickness < spacing * (1.0 + kRounding)) {
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

// Between those measured; below them the law's floor makes walls firmer, with the thickness
// squared.
Bends bendsOf(double thickness) {
  const Bends* above = std::begin(kBends);
  if (thickness <= above->thickness) {
    const double share = std::pow(thickness / above->thickness, 2);
    return {thickness, share * above->least, share * above->most};
  }
  while (above + 1 != std::end(kBends) && above->thickness < thickness) ++above;
  const Bends& below = *(above - 1);
  const double share =
      std::min(1.0, (thickness - below.thickness) / (above->thickness - below.thickness));
  const auto between = [share](double low, double high) { return low + share * (high - low); };
  return {thickness, between(below.least, above->least), between(below.most, above->most)};
}

WallRemark thinWalls(const Walls& walls, const TissueConfig& tissue) {
  Bends bends = bendsOf(walls.thinnest / tissue.spacing);
  // A lone layer of whole cells bends by the shear modulus alone (doc/model.md).
  if (bends.thickness > 1.0 - kRounding) {
    bends.most = std::max(bends.most, 1.0 + tissue.material.poisson_ratio);
  }
  return {percentText(walls.thin_share) +
              " % of the walls are no thicker than a spacing, the thinnest " +
              mmText(walls.thinnest) + ": they bend " + percentText(bends.least) + " to " +
              percentText(bends.most) + " % as far as they should",
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
