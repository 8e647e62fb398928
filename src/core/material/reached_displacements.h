// Displacements of the nodes that a cell reaches, in the order of reachedNodes.
#pragma once

#include <vector>

#include "material/elastic_cell.h"
#include "robot_tissue/core/cells.h"

namespace robot_tissue {

inline ElasticCell::Reached reachedOf(const std::vector<Vec3>& of_nodes, const Cell& cell) {
  ElasticCell::Reached displacement;
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    displacement[corner] = of_nodes[at(cell.nodes[corner])];
  }
  for (std::size_t beyond = 0; cell.reach != nullptr && beyond < kBeyond; ++beyond) {
    const int node = cell.reach->nodes[beyond];
    displacement[kCorners + beyond] = node < 0 ? Vec3(Vec3::Zero()) : of_nodes[at(node)];
  }
  return displacement;
}

}  // namespace robot_tissue
