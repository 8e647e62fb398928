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
// Of a wall's stiffness in bending (1). One that lies along no plane of the grid bends by squares
// of the coordinates, which trilinear cells do not have: it is stiffer by kOblique sin(2 a)^4
// (h / t)^3, a its angle, t its thickness. The number is that of thin_walls (doc/accuracy.md).
constexpr double kOblique = 0.8;
constexpr double kTooStiff = 0.1;    // more is told. Chosen
constexpr double kThinShare = 0.05;  // of the surface: less is not told. Chosen

std::string percentText(double share) { return numberText(std::round(100.0 * share)) + " %"; }
std::string mmText(double length) { return numberText(std::round(1e4 * length) / 10.0) + " mm"; }

// sin(2 a)^2 where the wall's normal lies in a plane of the grid.
double obliqueness(const Vec3& normal) {
  const Vec3 squares = normal.cwiseAbs2();
  return 4.0 * (squares[0] * squares[1] + squares[1] * squares[2] + squares[0] * squares[2]);
}

struct Walls {
  double thinnest = kNone;   // m, of those no thicker than a spacing
  double thin_share = 0.0;   // of the area looked at
  double stiff_share = 0.0;  // of walls that are too stiff as they are oblique
  double too_stiff = 0.0;    // the most of them (1)
  double stiffest = 0.0;     // m, thickness there
  double spacing = kNone;    // m, at which none would be
};

void lookAt(const WallSample& wall, double spacing, Walls& walls) {
  if (wall.thickness < spacing * (1.0 + 1e-9)) {
    walls.thin_share += wall.area;
    walls.thinnest = std::min(walls.thinnest, wall.thickness);
  }
  const double oblique = obliqueness(wall.normal);
  const double at_a_spacing = kOblique * oblique * oblique;  // in a wall of that thickness
  const double too_stiff = at_a_spacing * std::pow(spacing / wall.thickness, 3);
  if (!(too_stiff > kTooStiff)) return;
  walls.stiff_share += wall.area;
  walls.spacing = std::min(walls.spacing, std::cbrt(kTooStiff / at_a_spacing) * wall.thickness);
  if (too_stiff <= walls.too_stiff) return;
  walls.too_stiff = too_stiff;
  walls.stiffest = wall.thickness;
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
  for (double* share : {&walls.thin_share, &walls.stiff_share}) *share /= all > 0.0 ? all : 1.0;
  return walls;
}

WallRemark thinWalls(const Walls& walls, double poisson_ratio) {
  return {percentText(walls.thin_share) +
              " of the walls are no thicker than a spacing, the thinnest " +
              mmText(walls.thinnest) + ": where they lie along the grid they may bend up to " +
              percentText(poisson_ratio) + " too far",
          "tissue.spacing: " + numberText(0.5 * walls.thinnest) + " or less"};
}

WallRemark obliqueWalls(const Walls& walls) {
  return {percentText(walls.stiff_share) +
              " of the walls are oblique to the grid and thin for it, one of " +
              mmText(walls.stiffest) + " bends " + percentText(walls.too_stiff) + " too stiffly",
          "a mesh turned so that its walls lie along the axes, or tissue.spacing: " +
              numberText(walls.spacing) + " or less"};
}

}  // namespace

std::vector<WallRemark> wallRemarks(const TissueConfig& tissue) {
  if (!traitsOfModel(tissue.model).has_poisson_ratio) return {};  // its springs do not bend
  const Walls walls = wallsOf(tissue);
  std::vector<WallRemark> remarks;
  if (walls.thin_share >= kThinShare) {
    remarks.push_back(thinWalls(walls, tissue.material.poisson_ratio));
  }
  if (walls.stiff_share >= kThinShare) remarks.push_back(obliqueWalls(walls));
  return remarks;
}

}  // namespace robot_tissue
