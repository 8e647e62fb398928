#include "ladder.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/core/grid.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

Vec3 extentOf(const TissueConfig& tissue) {
  const Box box = boxOf(tissue);
  return box.max() - box.min();
}

// Nearest to twice the spacing, 0 where there is none.
double coarserThan(const TissueConfig& tissue, double spacing) {
  const Vec3 extent = extentOf(tissue);
  std::vector<double> candidates = {2.0 * spacing};
  if (!tissue.mesh && !spacingFits(extent, 2.0 * spacing)) {
    candidates = nearestSpacings(extent, 2.0 * spacing);
  }
  double best = 0.0;
  for (const double candidate : candidates) {
    const double step = candidate / spacing;
    if (step < tuning::kLeastRatio || step > tuning::kMostRatio) continue;
    if (extent.minCoeff() / candidate < tuning::kFewestCells - 1e-6) continue;
    const auto off = [&](double other) { return std::abs(std::log(other / (2.0 * spacing))); };
    if (best == 0.0 || off(candidate) < off(best)) best = candidate;
  }
  return best;
}

}  // namespace

Box boxOf(const TissueConfig& tissue) {
  return tissue.mesh ? boundsOf(tissue.mesh->vertices) : tissue.shape;
}

std::vector<double> ladderSpacings(const TissueConfig& tissue, int coarser, int finer) {
  std::vector<double> spacings = {tissue.spacing};
  for (int level = 0; level < coarser; ++level) {
    const double next = coarserThan(tissue, spacings.front());
    if (next == 0.0) break;
    spacings.insert(spacings.begin(), next);
  }
  for (int level = 0; level < finer; ++level) spacings.push_back(0.5 * spacings.back());
  return spacings;
}

double nodesAt(const TissueConfig& tissue, double spacing) {
  const Vec3 cells = (extentOf(tissue) / spacing).array().ceil();
  return nodeCount(cells * spacing, spacing);
}

}  // namespace robot_tissue
