#include "solvers/multigrid/hierarchy/light_nodes.h"

namespace robot_tissue {
namespace {

// Of h^3 (1).
constexpr double kWhole = 1.0 / 512.0;
// So little less is rounding (1).
constexpr double kRounding = 1e-9;

double volumeAt(const CellSet& cells, int node) {
  double eighths = 0.0;
  for (const CellSet::Meeting& met : cells.meetings(node)) {
    eighths += cells.all()[at(met.cell)].eighthsAt(static_cast<int>(met.corner));
  }
  return eighths / kCorners;
}

}  // namespace

std::vector<LightNode> lightNodes(const CellSet& cells) {
  std::vector<char> is_of_partly_filled(at(cells.nodeCount()), 0);
  for (const Cell& cell : cells.all()) {
    if (cell.fill == nullptr) continue;
    for (const int node : cell.nodes) is_of_partly_filled[at(node)] = 1;
  }
  std::vector<LightNode> light;
  for (int node = 0; node < cells.nodeCount(); ++node) {
    if (is_of_partly_filled[at(node)] == 0) continue;
    const double weight = volumeAt(cells, node) / kWhole;
    if (weight < 1.0 - kRounding) light.push_back({node, weight});
  }
  return light;
}

}  // namespace robot_tissue
