// The parts of the scene gate, one function per part of a scene. All throw InputError.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "robot_tissue/core/grid.h"
#include "robot_tissue/core/method_names.h"
#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/scene/entry.h"
#include "robot_tissue/scene/key_table.h"
#include "robot_tissue/scene/map_reader.h"
#include "robot_tissue/scene/ranges.h"
#include "robot_tissue/scene/scene_parser.h"

namespace robot_tissue {

using Remarks = std::vector<std::string>;

inline bool hardPatchesOnly(const std::string& model) {
  return traitsOfModel(model).hard_patches_only;
}

// `scene_folder`: where relative paths of a mesh start. `supported`: the scene has supports.
TissueConfig readTissue(const Entry& entry, const std::string& scene_folder, bool supported,
                        Remarks& remarks);

std::vector<MembraneConfig> readMembranes(const Entry& entry, const TissueConfig& tissue);

// Refuses a lattice that the memory which is free does not hold with this method.
void requireMemory(const Entry& spacing, const TissueConfig& tissue, const std::string& method);

// Keys min and max of a map, as nodes of the grid; refused when there are none.
Box readNodeBox(const MapReader& map, const Grid& grid);

SolverConfig readSolver(const Entry& entry, const TissueConfig& tissue,
                        const SolverOverrides& overrides, Remarks& remarks);

constexpr std::size_t kMostSteps = 1000000;

// Follows the program through: which patches stand, whose nodes they hold, which tools stand.
std::vector<Step> readSteps(const Entry& entry, const TissueConfig& tissue,
                            const SolverConfig& solver, const std::vector<ToolConfig>& tools);

constexpr int kMostIncrements = 100000;  // of one step

// A standing patch on the way through the steps.
struct StandingPatch {
  std::string name;
  NodeRange nodes;
};
LoadStep readLoad(const Entry& entry, const Grid& grid, const std::vector<NodeRange>& fixed,
                  const SolverConfig& solver, const Range& displacement,
                  std::vector<StandingPatch>& standing);

// `standing`: names of the tools that a move has placed.
MoveStep readMove(const Entry& entry, const std::vector<ToolConfig>& tools,
                  const LengthRanges& lengths, std::set<std::string>& standing);
WaitStep readWait(const Entry& entry);
PushStep readPush(const Entry& entry, const std::vector<ToolConfig>& tools,
                  const std::set<std::string>& standing);
GraspStep readGraspStep(const Entry& entry, const std::vector<ToolConfig>& tools,
                        const std::set<std::string>& standing);
RemoveStep readRemove(const Entry& entry, const LengthRanges& lengths);
UndoStep readUndo(const Entry& entry);
SutureStep readSuture(const Entry& entry, const std::string& model, const LengthRanges& lengths);
SaveStep readSave(const Entry& entry);
LoadStateStep readLoadState(const Entry& entry);
void requireStands(const Entry& entry, const std::string& tool,
                   const std::set<std::string>& standing);

std::vector<ToolConfig> readTools(const Entry& entry, const SceneSource& source,
                                  const TissueConfig& tissue, Remarks& remarks);

// What the shapes of tools are checked against.
struct Surroundings {
  std::string scene_folder;  // where relative paths of meshes start
  LengthRanges lengths;
};

// Links in the order of ToolConfig::links.
struct ToolLinks {
  std::vector<ToolLink> links;
  std::vector<Entry> names;  // where their names stand, or would
};
std::vector<std::string> toolLinkKeys();  // of a tool's map, that readToolLinks reads
ToolLinks readToolLinks(const MapReader& tool, const Surroundings& surroundings, SceneUser user,
                        const ToolRole& role, Remarks& remarks);

// Keys edge and resistance of a tool, whose role and links are read: refused where the role has no
// edge.
void readEdge(const Entry& entry, const TissueConfig& tissue, ToolConfig& tool, Remarks& remarks);
void readEdges(const Entry& entry, const TissueConfig& tissue, ToolConfig& tool);
void readOpeningOfScissors(const Entry& entry, SceneUser user, ToolConfig& tool, Remarks& remarks);
// A direction, unit.
Vec3 readOpeningAxis(const Entry& entry, SceneUser user, Remarks& remarks);
void readResistance(const Entry& entry, ToolConfig& tool);

std::vector<SupportConfig> readSupports(const Entry& entry, const TissueConfig& tissue);

// A name that may be part of a topic's.
std::string readGraphName(const Entry& entry);

// Keys xyz (m) and rpy (rad; roll, pitch, yaw about the fixed axes x, y, z, as in URDF), each zero
// when not given.
Pose readPose(const MapReader& map, const Range& place);

// Address of a mesh file: package:// stays as it is; a path must be an existing file, relative to
// the scene's folder, and becomes file://.
std::string readResource(const Entry& entry, const std::string& scene_folder);

// One factor for all axes or three; 1 when not given.
Vec3 readScale(const Entry& entry);

// Keys resource and scale of a shape: loaded, joined at its corners, closed, facing outwards.
TriangleMesh readMeshShape(const MapReader& map, const std::string& scene_folder);

// Refuses a tool's mesh that is not closed, has no volume or cannot be read. One of a package is
// left to those who make a tool of it: a scene may be read where the package is not.
void requireToolMesh(const Entry& resource, const std::string& address, const Vec3& scale,
                     const LengthRanges& lengths);

// Refuses a spacing larger than the mesh's smallest extent.
void requireSpacingWithin(const Entry& spacing, const TriangleMesh& mesh);

ToolShape readToolShape(const Entry& entry, const Surroundings& surroundings);

}  // namespace robot_tissue
