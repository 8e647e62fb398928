// Steps of the runner that a tool takes: each names a tool with shapes of its own, as there is no
// URDF, and all but the first move a tool that stands somewhere.
#include <algorithm>

#include "robot_tissue/scene/readers.h"

namespace robot_tissue {
namespace {

bool hasJaws(const ToolConfig& tool) { return tool.role.has_jaws; }

// Whether the runner can use the tool: some link has a shape, of a tool with jaws both jaws have;
// an edge needs none.
bool hasShapes(const ToolConfig& tool) {
  if (tool.role.has_edge || tool.role.shears) return true;
  const auto with_shapes = [](const ToolLink& link) { return !link.shapes.empty(); };
  if (!hasJaws(tool)) return std::any_of(tool.links.begin(), tool.links.end(), with_shapes);
  return std::all_of(tool.links.end() - 2, tool.links.end(), with_shapes);
}

bool pushes(const ToolConfig& tool) { return hasShapes(tool) && tool.role.touches(); }

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
    entry.fail((hasJaws(*tool) ? "a jaw has no shapes, must be " : "has no shapes, must be ") +
               allowed);
  }
  return *tool;
}

struct PlaceReading {
  bool jaws = false;
  const LengthRanges& lengths;
  MoveStep::Place place;
};

void readOpening(const Entry& entry, PlaceReading& reading) {
  if (entry.given() && !reading.jaws) {
    entry.fail("must be left out, only role " + toolRolesWith(&ToolRole::has_jaws) + " opens");
  }
  reading.place.opening = entry.numberOr(reading.place.opening, reading.lengths.gap);
}

const KeyTable<PlaceReading> kPlaceKeys = {{"xyz"}, {"rpy"}, {"opening", readOpening}};

MoveStep::Place readPlace(const Entry& entry, bool jaws, const LengthRanges& lengths) {
  const MapReader map(entry, namesOf(kPlaceKeys));
  map["xyz"].vec3(lengths.place);  // unlike a shape's it has to be given
  PlaceReading reading{jaws, lengths, {}};
  reading.place.pose = readPose(map, lengths.place);
  readKeys(map, kPlaceKeys, reading);
  return reading.place;
}

template <class ToolStep>
void readIncrements(const Entry& entry, ToolStep& step) {
  if (entry.given()) step.increments = entry.integer(1, kMostIncrements);
}

const KeyTable<MoveStep> kMoveKeys = {
    {"tool"},
    {"from"},
    {"to"},
    {"increments", readIncrements<MoveStep>},
    {"duration",
     [](const Entry& entry, MoveStep& step) {
       if (entry.given()) step.duration = entry.number(ranges::duration());
     }},
};

const KeyTable<WaitStep> kWaitKeys = {
    {"duration",
     [](const Entry& entry, WaitStep& step) { step.duration = entry.number(ranges::duration()); }},
    {"increments", readIncrements<WaitStep>},
};

const KeyTable<PushStep> kPushKeys = {
    {"tool"},
    {"force",
     [](const Entry& entry, PushStep& step) {
       step.force = readNonZero(entry, ranges::force(), ranges::kLeastForce);
     }},
    {"increments", readIncrements<PushStep>},
};

const KeyTable<GraspStep> kGraspStepKeys = {{"tool"}};

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
  const MapReader map(entry, namesOf(kMoveKeys));
  const ToolConfig& tool = readTool(map["tool"], tools);
  MoveStep step;
  step.tool = tool.name;
  const Entry from = map["from"];
  if (from.given()) {
    step.from = readPlace(from, hasJaws(tool), lengths);
  } else if (standing.count(tool.name) == 0) {
    from.fail("the tool stands nowhere at this step, must be a map of xyz, rpy, opening");
  }
  step.to = readPlace(map["to"], hasJaws(tool), lengths);
  readKeys(map, kMoveKeys, step);
  standing.insert(tool.name);
  return step;
}

WaitStep readWait(const Entry& entry) {
  WaitStep step;
  readKeys(MapReader(entry, namesOf(kWaitKeys)), kWaitKeys, step);
  return step;
}

PushStep readPush(const Entry& entry, const std::vector<ToolConfig>& tools,
                  const std::set<std::string>& standing) {
  const MapReader map(entry, namesOf(kPushKeys));
  PushStep step;
  const ToolConfig& tool = readTool(map["tool"], tools);
  step.tool = tool.name;
  if (!tool.role.touches()) {
    map["tool"].fail("role " + tool.role.name + " only " + tool.role.deed() +
                     ", must be a tool that pushes: " + namesOf(tools, pushes));
  }
  requireStands(map["tool"], step.tool, standing);
  readKeys(map, kPushKeys, step);
  return step;
}

GraspStep readGraspStep(const Entry& entry, const std::vector<ToolConfig>& tools,
                        const std::set<std::string>& standing) {
  const MapReader map(entry, namesOf(kGraspStepKeys));
  const ToolConfig& tool = readTool(map["tool"], tools);
  if (!tool.role.holds) {
    map["tool"].fail("must be one of the tools of role " + toolRolesWith(&ToolRole::holds) + ": " +
                     namesOf(tools, [](const ToolConfig& other) { return other.role.holds; }));
  }
  requireStands(map["tool"], tool.name, standing);
  GraspStep step{tool.name};
  readKeys(map, kGraspStepKeys, step);
  return step;
}

}  // namespace robot_tissue
