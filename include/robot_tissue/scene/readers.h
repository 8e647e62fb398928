// The parts of the scene gate, one function per part of a scene. All throw InputError.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/grid.h"
#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/scene/entry.h"
#include "robot_tissue/scene/map_reader.h"
#include "robot_tissue/scene/scene_gate.h"

namespace robot_tissue {

using Remarks = std::vector<std::string>;

// `scene_folder`: where relative paths of a mesh start.
TissueConfig readTissue(const Entry& entry, const std::string& scene_folder, Remarks& remarks);

// Keys min and max of a map, as nodes of the grid; refused when there are none.
Box readNodeBox(const MapReader& map, const Grid& grid);

SolverConfig readSolver(const Entry& entry, const std::string& model,
                        const SolverOverrides& overrides, Remarks& remarks);

// Follows the program through: which patches stand, and whose nodes they hold.
std::vector<Step> readSteps(const Entry& entry, const TissueConfig& tissue,
                            const SolverConfig& solver);

// A standing patch on the way through the steps.
struct StandingPatch {
  std::string name;
  NodeRange nodes;
};
LoadStep readLoad(const Entry& entry, const Grid& grid, const std::vector<NodeRange>& fixed,
                  const SolverConfig& solver, std::vector<StandingPatch>& standing);

std::vector<ToolConfig> readTools(const Entry& entry, const std::string& scene_folder);

// Address of a mesh file: package:// stays as it is; a path must be an existing file, relative to
// the scene's folder, and becomes file://.
std::string readResource(const Entry& entry, const std::string& scene_folder);

// One factor for all axes or three; 1 when not given.
Vec3 readScale(const Entry& entry);

// Shape of type mesh: loaded, joined at its corners, closed, facing outwards.
TriangleMesh readMeshShape(const Entry& entry, const std::string& scene_folder);

// Refuses a spacing larger than the mesh's smallest extent.
void requireSpacingWithin(const Entry& spacing, const TriangleMesh& mesh);

ToolShape readToolShape(const Entry& entry, const std::string& scene_folder);

}  // namespace robot_tissue
