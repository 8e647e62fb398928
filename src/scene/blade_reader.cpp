// What a tool with an edge says of it.
#include <algorithm>

#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kMostPoints = 1000;

// True: it is to be read.
bool isOfScissors(const Entry& entry, const ToolConfig& tool) {
  if (tool.role.shears) return true;
  if (entry.given()) {
    entry.fail("must be left out, only role " + toolRolesWith(&ToolRole::shears) + " has it");
  }
  return false;
}

// True: it is to be read.
bool isOfEdge(const Entry& entry, const ToolConfig& tool) {
  if (tool.role.has_edge) return true;
  if (entry.given()) {
    entry.fail("must be left out, only role " + toolRolesWith(&ToolRole::has_edge) +
               " has an edge");
  }
  return false;
}

std::vector<Vec3> readPolyline(const Entry& entry, const LengthRanges& lengths) {
  std::vector<Vec3> line;
  for (const Entry& point : entry.list(2, "points", kMostPoints)) {
    line.push_back(point.vec3(lengths.place));
    if (line.size() < 2 || (line.back() - line[line.size() - 2]).norm() >= lengths.length.lowest) {
      continue;
    }
    point.fail("is where the point before it is, must be " + numberText(lengths.length.lowest) +
               " m away at least");
  }
  return line;
}

}  // namespace

void readEdge(const Entry& entry, const TissueConfig& tissue, ToolConfig& tool, Remarks& remarks) {
  if (!isOfEdge(entry, tool)) return;
  tool.blade.edge = readPolyline(entry, lengthsOf(tissue));
  const bool has_shapes = std::any_of(tool.links.begin(), tool.links.end(),
                                      [](const ToolLink& link) { return !link.shapes.empty(); });
  const bool is_rigid = tool.patch == ToolConfig::Patch::kRigid;
  if (!has_shapes || !(is_rigid || tissue.time)) return;
  remarks.push_back(entry.line("the shapes of tool '" + tool.name + "' touch nothing, with " +
                               (is_rigid ? "patch rigid" : "tissue.time") + " a " + tool.role.name +
                               " only cuts"));
}

void readResistance(const Entry& entry, ToolConfig& tool) {
  if (!isOfEdge(entry, tool)) return;
  tool.blade.resistance = entry.numberOr(tool.blade.resistance, ranges::resistance());
}

Vec3 readOpeningAxis(const Entry& entry, SceneUser user, Remarks& remarks) {
  if (user == SceneUser::kNode) {
    remarks.push_back(entry.line("ignored, the robot's joints move the jaws"));
  }
  return readNonZero(entry, ranges::direction(), ranges::kLeastDirection).normalized();
}

void readEdges(const Entry& entry, const TissueConfig& tissue, ToolConfig& tool) {
  if (!isOfScissors(entry, tool)) return;
  const LengthRanges lengths = lengthsOf(tissue);
  std::size_t jaw = 0;
  for (const Entry& edge : entry.list(2, "edges", 2)) {
    tool.scissors.edges[jaw++] = readPolyline(edge, lengths);
  }
}

void readOpeningOfScissors(const Entry& entry, SceneUser user, ToolConfig& tool, Remarks& remarks) {
  if (!isOfScissors(entry, tool) || !entry.given()) return;
  tool.grasp.opening_axis = readOpeningAxis(entry, user, remarks);
}

}  // namespace robot_tissue
