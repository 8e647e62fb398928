#include "robot_tissue/scene/ranges.h"

#include <algorithm>

#include "robot_tissue/core/suture_ranges.h"
#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kThinnest = 1e-3;   // of the spacing
constexpr double kFarthest = 1e4;    // of the tissue's size
constexpr double kMostPulled = 1e2;  // of the tissue's size

// Its largest extent, or how far it is from the origin if that is more (m).
double sizeOf(const Box& box) {
  return std::max({(box.max() - box.min()).maxCoeff(), box.max().cwiseAbs().maxCoeff(),
                   box.min().cwiseAbs().maxCoeff()});
}

}  // namespace

LengthRanges::LengthRanges(const Box& tissue, double spacing) {
  const double size = sizeOf(tissue);
  length = {kThinnest * spacing, kFarthest * size, "m"};
  gap = {0.0, kFarthest * size, "m"};
  thread = {0.0, longestSuture(tissue), "m"};
  place = {-kFarthest * size, kFarthest * size, "m"};
  displacement = {-kMostPulled * size, kMostPulled * size, "m"};
}

LengthRanges lengthsOf(const TissueConfig& tissue) {
  return {tissue.mesh ? boundsOf(tissue.mesh->vertices) : tissue.shape, tissue.spacing};
}

Vec3 readVector(const Entry& entry, const Range& range, double least) {
  const Vec3 value = entry.vec3(range);
  if (value.isZero(0.0) || value.norm() >= least) return value;
  entry.fail("must be zero or as large as " + numberText(least) + " at least");
}

Vec3 readNonZero(const Entry& entry, const Range& range, double least) {
  const Vec3 value = entry.vec3(range);
  if (value.norm() >= least) return value;
  entry.fail("must not be zero, its length at least " + numberText(least));
}

}  // namespace robot_tissue
