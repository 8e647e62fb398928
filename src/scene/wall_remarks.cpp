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
constexpr Bends kBends[] = {{0.3, 0.49, 0.82}, {0.5, 0.71, 1.28}, {0.7, 0.83, 1.35},
                            {1.0, 0.97, 1.21}, {1.5, 0.92, 1.10}, {2.5, 0.98, 1.06},
                            {4.0, 1.00, 1.03}};
// Of the surface (1): less is not told. Organs run out in rims thinner than they are. Chosen.
constexpr double kThinShare = 0.05, kObliqueShare = 0.1;
constexpr double kOff = 0.05;  // of how far they should bend: less is not told. Chosen
// Cosine (1) of how far from an axis of the grid a wall's normal is at least that is oblique: 10
// degrees. Along the grid walls of more than a spacing bend within 2 %.
constexpr double kOblique = 0.985;

std::string percentText(double share) { return numberText(std::round(100.0 * share)); }
std::string mmText(double length) { return numberText(std::round(1e4 * length) / 10.0) + " mm"; }

// Some of the walls.
struct Kind {
  double thinnest = kNone;  // m
  double share = 0.0;       // of the area looked at

  void add(const WallSample& wall) {
    share += wall.area;
    thinnest = std::min(thinnest, wall.thickness);
  }
};

struct Walls {
  Kind thin;     // no thicker than a spacing
  Kind oblique;  // to the grid, and thicker
};

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

bool areOff(const Bends& bends) { return bends.least < 1.0 - kOff || bends.most > 1.0 + kOff; }

Walls wallsOf(const TissueConfig& tissue) {
  const std::vector<WallSample> samples =
      tissue.mesh ? wallSamples(*tissue.mesh)
                  : std::vector<WallSample>{{tissue.shape.sizes().minCoeff(), Vec3::UnitX(), 1.0}};
  Walls walls;
  double all = 0.0;
  for (const WallSample& sample : samples) {
    all += sample.area;
    if (sample.thickness < tissue.spacing * (1.0 + kRounding)) {
      walls.thin.add(sample);
    } else if (sample.normal.cwiseAbs().maxCoeff() < kOblique &&
               areOff(bendsOf(sample.thickness / tissue.spacing))) {
      walls.oblique.add(sample);
    }
  }
  for (Kind* kind : {&walls.thin, &walls.oblique}) kind->share /= all > 0.0 ? all : 1.0;
  return walls;
}

WallRemark remarkOf(const Kind& walls, const std::string& what, const Bends& bends,
                    double spacing) {
  return {percentText(walls.share) + " % of the walls are " + what + ", the thinnest " +
              mmText(walls.thinnest) + ": they bend " + percentText(bends.least) + " to " +
              percentText(bends.most) + " % as far as they should",
          "tissue.spacing: " + numberText(spacing) + " or less"};
}

WallRemark thinWalls(const Kind& walls, const TissueConfig& tissue) {
  Bends bends = bendsOf(walls.thinnest / tissue.spacing);
  // A lone layer of whole cells bends by the shear modulus alone (doc/model.md).
  if (bends.thickness > 1.0 - kRounding) {
    bends.most = std::max(bends.most, 1.0 + tissue.material.poisson_ratio);
  }
  return remarkOf(walls, "no thicker than a spacing", bends, 0.5 * walls.thinnest);
}

WallRemark obliqueWalls(const Kind& walls, const TissueConfig& tissue) {
  return remarkOf(walls, "oblique to the grid and no thicker than three spacings",
                  bendsOf(walls.thinnest / tissue.spacing), 0.25 * walls.thinnest);
}

}  // namespace

std::vector<WallRemark> wallRemarks(const TissueConfig& tissue) {
  if (!traitsOfModel(tissue.model).has_poisson_ratio) return {};  // its springs do not bend
  const Walls walls = wallsOf(tissue);
  std::vector<WallRemark> remarks;
  if (walls.thin.share >= kThinShare) remarks.push_back(thinWalls(walls.thin, tissue));
  if (walls.oblique.share >= kObliqueShare) remarks.push_back(obliqueWalls(walls.oblique, tissue));
  return remarks;
}

}  // namespace robot_tissue
