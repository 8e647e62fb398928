// Steps of the runner that a tool takes: each names a tool with shapes of its own, as there is no
// URDF, and all but the first move a tool that stands somewhere.
#include <algorithm>

#include "robot_tissue/scene/readers.h"

namespace robot_tissue {
namespace {

bool isGrasper(const ToolConfig& tool) { return tool.role == ToolConfig::Role::kGrasper; }

// What the runner needs of a tool: some shapes, of a grasper both jaws'.
bool hasShapes(const ToolConfig& tool) {
  const auto with_shapes = [](const ToolLink& link) { return !link.shapes.empty(); };
  if (!isGrasper(tool)) return std::any_of(tool.links.begin(), tool.links.end(), with_shapes);
  return std::all_of(tool.links.end() - 2, tool.links.end(), with_shapes);
}

template <class Allowed>
std::string namesOf(const std::vector<ToolConfig>& tools, const Allowed& allowed) {
  std::vector<std::string> names;
  for (const ToolConfig& tool : tools) {
    if (allowed(tool)) names.push_back(tool.name);
  }
  return names.empty() ? "the scene has none" : joined(names);
}

const ToolConfig& readTool(const Entry& entry, const std::vector<ToolConfig>& tools) {
  const std::string allowed = "one of the tools that have shapes: " + namesOf(tools, hasShapes);
  const std::string name = entry.word(allowed);
  const auto tool = std::find_if(tools.begin(), tools.end(),
                                 [&name](const auto& other) { return other.name == name; });
  if (tool == tools.end()) entry.fail("must be " + allowed);
  if (!hasShapes(*tool)) {
    entry.fail((isGrasper(*tool) ? "a jaw has no shapes, must be " : "has no shapes, must be ") +
               allowed);
  }
  return *tool;
}

MoveStep::Place readPlace(const Entry& entry, bool grasper, const LengthRanges& lengths) {
  const MapReader map(entry, {"xyz", "rpy", "opening"});
  map["xyz"].vec3(lengths.place);  // unlike a shape's it has to be given
  MoveStep::Place place;
  place.pose = readPose(map, lengths.place);
  const Entry opening = map["opening"];
  if (opening.given() && !grasper) opening.fail("must be left out, only role grasper opens");
  place.opening = opening.numberOr(place.opening, lengths.gap);
  return place;
}

std::optional<int> readIncrements(const Entry& entry) {
  return entry.given() ? std::optional<int>(entry.integer(1, kMostIncrements)) : std::nullopt;
}

}  // namespace

void requireStands(const Entry& entry, const std::string& tool,
                   const std::set<std::string>& standing) {
  if (standing.count(tool) > 0) return;
  entry.fail(standing.empty() ? "no tool stands at this step, must be placed by a move before it"
                              : "the tool stands nowhere at this step, must be one that does: " +
                                    joined({standing.begin(), standing.end()}));
}

MoveStep readMove(const Entry& entry, const std::vector<ToolConfig>& tools,
                  const LengthRanges& lengths, std::set<std::string>& standing) {
  const MapReader map(entry, {"tool", "from", "to", "increments"});
  const ToolConfig& tool = readTool(map["tool"], tools);
  MoveStep step;
  step.tool = tool.name;
  const Entry from = map["from"];
  if (from.given()) {
    step.from = readPlace(from, isGrasper(tool), lengths);
  } else if (standing.count(tool.name) == 0) {
    from.fail("the tool stands nowhere at this step, must be a map of xyz, rpy, opening");
  }
  step.to = readPlace(map["to"], isGrasper(tool), lengths);
  step.increments = readIncrements(map["increments"]);
  standing.insert(tool.name);
  return step;
}

PushStep readPush(const Entry& entry, const std::vector<ToolConfig>& tools,
                  const std::set<std::string>& standing) {
  const MapReader map(entry, {"tool", "force", "increments"});
  PushStep step;
  step.tool = readTool(map["tool"], tools).name;
  requireStands(map["tool"], step.tool, standing);
  step.force = readNonZero(map["force"], ranges::force(), ranges::kLeastForce);
  step.increments = readIncrements(map["increments"]);
  return step;
}

GraspStep readGraspStep(const Entry& entry, const std::vector<ToolConfig>& tools,
                        const std::set<std::string>& standing) {
  const MapReader map(entry, {"tool"});
  const ToolConfig& tool = readTool(map["tool"], tools);
  if (!isGrasper(tool)) {
    map["tool"].fail("must be one of the tools of role grasper: " + namesOf(tools, isGrasper));
  }
  requireStands(map["tool"], tool.name, standing);
  return {tool.name};
}

}  // namespace robot_tissue
