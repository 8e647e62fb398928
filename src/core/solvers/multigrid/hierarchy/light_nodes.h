// Nodes that carry next to no tissue (own). Cuts and meshes leave slivers, whose nodes are so soft
// that forces no one could measure move them far. In the lengths that tell how far a shape is from
// balance they count by the tissue they carry,
//
//   |x|^2 = sum over nodes of w |x_node|^2,   w = min(1, m / m_1)
//
// with m the volume of tissue that a node carries, and m_1 = h^3 / 512 the least that one carries
// of a cell cut through the middles of its springs, (1/8)^3: what hangs by so little still counts.
#pragma once

#include <vector>

#include "robot_tissue/core/cells.h"

namespace robot_tissue {

struct LightNode {
  int node = 0;         // of the tissue, ghosts last
  double weight = 0.0;  // w, under 1
};

// In ascending order.
std::vector<LightNode> lightNodes(const CellSet& cells);

}  // namespace robot_tissue
