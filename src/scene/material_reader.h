// Reads a material: of the tissue, of a region.
#pragma once

#include <string>
#include <vector>

#include "robot_tissue/core/scene.h"
#include "robot_tissue/scene/map_reader.h"
#include "robot_tissue/scene/readers.h"

namespace robot_tissue {

std::vector<std::string> materialKeys();

Material readMaterial(const Entry& entry, const std::string& model, Remarks& remarks);

// The keys of a region's map that are its material's; what is not given is as in the tissue.
void readRegionMaterial(const MapReader& map, const TissueConfig& tissue, Remarks& remarks,
                        Region& region);

}  // namespace robot_tissue
