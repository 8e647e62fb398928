// The spacings that are tried: about half as fine, twice as fine and so on as the scene's.
#pragma once

#include <vector>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// The shape's, or that around its mesh (m).
Box boxOf(const TissueConfig& tissue);

// Descending, the scene's own among them (m). Coarser ones are those that fit the box and are
// nearest to twice the one before, as long as two cells fit along its shortest edge.
std::vector<double> ladderSpacings(const TissueConfig& tissue, int coarser, int finer);

// Nodes of the box, or of the mesh's bounding box, at this spacing.
double nodesAt(const TissueConfig& tissue, double spacing);

}  // namespace robot_tissue
