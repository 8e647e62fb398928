// Displacements at given points, so that lattices of different spacings can be compared.
#pragma once

#include <cstdint>
#include <vector>

#include "robot_tissue/core/tissue.h"

namespace robot_tissue {

struct Field {
  std::vector<Vec3> displacement;    // per point, from rest (m); zero where there is no cell
  std::vector<std::uint8_t> inside;  // per point, 1 = a cell of the lattice holds it
};

// Rest positions (m, tissue frame) of the nodes of a lattice of this spacing.
std::vector<Vec3> nodesOf(const TissueConfig& tissue);

// At points given by their rest positions (m, tissue frame): between the nodes of the cell that
// holds the point, trilinear, as the surface is drawn. Of a cell that a cut has split, the part
// that owns the corner nearest to the point.
Field fieldAt(const Tissue& tissue, const std::vector<Vec3>& points);

}  // namespace robot_tissue
