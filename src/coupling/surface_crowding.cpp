#include "robot_tissue/coupling/surface_crowding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tuning.h"

namespace robot_tissue {

void SurfaceCrowding::take(const TissueSurface& surface, std::size_t nodes) {
  if (vertices_ && surface.revision != 0 && surface.revision == revision_) return;
  std::vector<double> vertices(nodes, 0.0);
  for (const CarrierRange carriers : surface.carriers) {
    for (const auto& [node, weight] : carriers) {
      vertices[at(node)] += std::abs(weight);
    }
  }
  vertices_ = std::make_shared<const std::vector<double>>(std::move(vertices));
  revision_ = surface.revision;
}

double SurfaceCrowding::under(const std::vector<NodeWeight>& carriers) const {
  double vertices = 0.0, all = 0.0;
  for (const auto& [node, weight] : carriers) {
    vertices += std::abs(weight) * (*vertices_)[at(node)];
    all += std::abs(weight);
  }
  return all > 0.0 ? std::max(1.0, vertices / all / tuning::kCrowded) : 1.0;
}

}  // namespace robot_tissue
