#include "solvers/multigrid/hierarchy/light_nodes.h"

#include <algorithm>

namespace robot_tissue {
namespace {

// Of h^3 (1).
constexpr double kWhole = 1.0 / 512.0;
// So little less is rounding (1).
constexpr double kRounding = 1e-9;

double volumeAt(const CellSet& cells, int node) {
  double eighths = 0.0;
  for (auto met = cells.first(node); met != cells.last(node); ++met) {
    eighths += cells.all()[at(met->cell)].eighthsAt(static_cast<int>(met->corner));
  }
  return eighths / kCorners;
}

}  // namespace

std::vector<LightNode> lightNodes(const CellSet& cells) {
  std::vector<int> of_partly_filled;
  for (const Cell& cell : cells.all()) {
    if (cell.fill == nullptr) continue;
    of_partly_filled.insert(of_partly_filled.end(), cell.nodes.begin(), cell.nodes.end());
  }
  std::sort(of_partly_filled.begin(), of_partly_filled.end());
  const auto end = std::unique(of_partly_filled.begin(), of_partly_filled.end());
  std::vector<LightNode> light;
  for (auto node = of_partly_filled.begin(); node != end; ++node) {
    const double weight = volumeAt(cells, *node) / kWhole;
    if (weight < 1.0 - kRounding) light.push_back({*node, weight});
  }
  return light;
}

}  // namespace robot_tissue
