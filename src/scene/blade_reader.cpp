// What a tool with an edge says of it.
#include <algorithm>

#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kMostPoints = 1000;

// True: it is to be read.
bool isOfEdge(const Entry& entry, const ToolConfig& tool) {
  if (tool.role.has_edge) return true;
  if (entry.given()) {
    entry.fail("must be left out, only role " + toolRolesWith(&ToolRole::has_edge) +
               " has an edge");
  }
  return false;
}

}  // namespace

void readEdge(const Entry& entry, const TissueConfig& tissue, ToolConfig& tool, Remarks& remarks) {
  if (!isOfEdge(entry, tool)) return;
  const LengthRanges lengths = lengthsOf(tissue);
  std::vector<Vec3>& edge = tool.blade.edge;
  for (const Entry& point : entry.list(2, "points", kMostPoints)) {
    edge.push_back(point.vec3(lengths.place));
    if (edge.size() < 2 || (edge.back() - edge[edge.size() - 2]).norm() >= lengths.length.lowest) {
      continue;
    }
    point.fail("is where the point before it is, must be " + numberText(lengths.length.lowest) +
               " m away at least");
  }
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

}  // namespace robot_tissue
