#include "rim_link.h"

#include <algorithm>
#include <limits>

#include "robot_tissue/coupling/fade.h"
#include "tuning.h"

namespace robot_tissue {

double faceWidth(const FlatFace& face) {
  double width = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < face.edges.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const bool are_opposite =
          face.edges[i].outward.dot(face.edges[j].outward) < tuning::kOppositeEdges;
      if (are_opposite) width = std::min(width, face.edges[i].depth_m + face.edges[j].depth_m);
    }
  }
  return width;
}

double rimShare(const FlatFace& face, const RimLink& link, double spacing) {
  return fade(face.normal.dot(link.facing), tuning::kTiltedPush, tuning::kStraightPush) *
         fade(face.normal.dot(link.inwards), tuning::kTiltedFace, tuning::kFlatFace) *
         fade(face.roundness_m, spacing, 0.0) *
         fade(faceWidth(face), tuning::kNarrowFace * spacing, tuning::kWideFace * spacing);
}

}  // namespace robot_tissue
