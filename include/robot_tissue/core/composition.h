// Which of a tissue's materials its cells hold, and how much of each (own). A region given by a box
// holds the cells whose centers are in it; one given by a mesh holds of each cell what the mesh
// encloses.
#pragma once

#include <cstdint>
#include <vector>

#include "robot_tissue/core/filled_grid.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

constexpr int kOwnMaterial = -1;  // stands for a region where the tissue's own material is

struct MaterialShare {
  int region = kOwnMaterial;  // index into TissueConfig::regions
  double share = 1.0;         // of what the cell is filled with, in (0, 1]; 1 in sum over the cell
};
using Composition = std::vector<MaterialShare>;  // ascending: what lies under the others first

struct CellCompositions {
  std::vector<Composition> kinds;      // of one material: each once
  std::vector<std::uint32_t> of_cell;  // per cell that holds tissue, in their order: into
                                       // kinds; empty: all have the only one
};

// Of two regions the later one has what both enclose.
CellCompositions compositionsOf(const TissueConfig& config, const FilledGrid& tissue);

const Material& materialOf(const TissueConfig& config, int region);
double densityOf(const TissueConfig& config, const Composition& composition);  // kg/m^3

}  // namespace robot_tissue
