#include <algorithm>
#include <cctype>

#include "robot_tissue/scene/readers.h"

namespace robot_tissue {
namespace {

const std::string kNameRule = "letters, digits and _, starting with a letter";

bool isGraphName(const std::string& name) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  return !name.empty() && letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&letter](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

// The first link's name when the scene gives none.
std::string readToolName(const Entry& entry, const ToolLinks& links) {
  const std::string& link = links.links.front().link;
  if (entry.given() || link.empty()) return readGraphName(entry);
  if (!isGraphName(link)) {
    links.names.front().fail("needs a name beside it, as the tool's name must be " + kNameRule);
  }
  return link;
}

ToolConfig::Role readRole(const Entry& entry, const std::string& model) {
  if (!entry.given() || entry.choice({"push", "grasper"}, {"blade"}) == "push") {
    return ToolConfig::Role::kPush;
  }
  if (hardPatchesOnly(model)) {
    entry.fail("with tissue.model " + model + " must be push, its method moves hard patches only");
  }
  return ToolConfig::Role::kGrasper;
}

ToolConfig::Patch readPatch(const Entry& entry, const std::string& model) {
  if (!entry.given()) {
    return hardPatchesOnly(model) ? ToolConfig::Patch::kRigid : ToolConfig::Patch::kConforming;
  }
  if (entry.choice({"conforming", "rigid"}, {}) == "rigid") return ToolConfig::Patch::kRigid;
  if (hardPatchesOnly(model)) {
    entry.fail("with tissue.model " + model + " must be rigid, its method moves hard patches only");
  }
  return ToolConfig::Patch::kConforming;
}

void readContact(const MapReader& map, const std::string& model, ToolConfig& tool,
                 Remarks& remarks) {
  tool.patch = readPatch(map["patch"], model);
  const Entry friction = map["friction"];
  tool.friction = friction.numberOr(tool.friction, ranges::friction());
  if (friction.given() && tool.patch == ToolConfig::Patch::kRigid) {
    remarks.push_back(friction.line("ignored, a rigid patch sticks to its tool"));
  }
  tool.max_force = map["max_force"].numberOr(tool.max_force, ranges::forceLimit());
}

GraspConfig readGrasp(const Entry& entry, const TissueConfig& tissue, SceneUser user,
                      Remarks& remarks) {
  const LengthRanges lengths = lengthsOf(tissue);
  const Entry given = entry.given() ? entry : entry.child(YAML::Node(YAML::NodeType::Map), "");
  const MapReader map(given, {"close_gap", "open_gap", "max_force", "opening_axis"});
  GraspConfig grasp;
  grasp.close_gap = map["close_gap"].numberOr(tissue.spacing, lengths.length);
  grasp.open_gap = map["open_gap"].numberOr(
      1.5 * grasp.close_gap, {grasp.close_gap, lengths.gap.highest, "m, not below the close_gap"});
  grasp.max_force = map["max_force"].numberOr(grasp.max_force, ranges::forceLimit());
  const Entry axis = map["opening_axis"];
  if (axis.given())
    grasp.opening_axis =
        readNonZero(axis, ranges::direction(), ranges::kLeastDirection).normalized();
  if (axis.given() && user == SceneUser::kNode) {
    remarks.push_back(axis.line("ignored, the robot's joints move the jaws"));
  }
  return grasp;
}

// A link of two tools: where both touch, each feels but a part of the force. With the same surface
// they touch everywhere.
void checkLinksAreOnce(const ToolLinks& links, const ToolConfig& tool,
                       const std::vector<ToolConfig>& earlier, Remarks& remarks) {
  const auto touches = [](const ToolConfig& of, std::size_t link) {
    const bool is_frame = of.role == ToolConfig::Role::kGrasper && link + 2 < of.links.size();
    return !of.links[link].link.empty() && (!is_frame || !of.links[link].shapes.empty());
  };
  const auto check = [&](std::size_t i, const ToolConfig& other, std::size_t j) {
    const ToolLink &here = tool.links[i], &there = other.links[j];
    if (here.link != there.link || !touches(tool, i) || !touches(other, j)) return;
    const std::string of_other = "is a link of tool '" + other.name + "' already, ";
    if (here.shapes.empty() && there.shapes.empty()) {
      links.names[i].fail(of_other +
                          "each would feel but a part of the force, must be of one tool only");
    }
    remarks.push_back(links.names[i].line(
        of_other + "where the shapes of both touch, each feels but a part of the force"));
  };
  for (std::size_t i = 0; i < tool.links.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) check(i, tool, j);
    for (const ToolConfig& other : earlier) {
      for (std::size_t j = 0; j < other.links.size(); ++j) check(i, other, j);
    }
  }
}

ToolConfig readTool(const Entry& entry, const SceneSource& source, const TissueConfig& tissue,
                    const std::vector<ToolConfig>& earlier, Remarks& remarks) {
  const MapReader map(
      entry, {"name", "link", "links", "jaws", "role", "padding", "collision_padding", "friction",
              "patch", "max_force", "grasp", "shapes"});
  ToolConfig tool;
  tool.role = readRole(map["role"], tissue.model);
  const ToolLinks links =
      readToolLinks(map, {source.folder, lengthsOf(tissue)}, source.user, tool.role, remarks);
  tool.links = links.links;
  tool.name = readToolName(map["name"], links);
  for (const ToolConfig& other : earlier) {
    if (other.name != tool.name) continue;
    entry.fail("the name " + tool.name + " is an earlier tool's, must be unique");
  }
  checkLinksAreOnce(links, tool, earlier, remarks);
  readContact(map, tissue.model, tool, remarks);
  if (tool.role == ToolConfig::Role::kGrasper) {
    tool.grasp = readGrasp(map["grasp"], tissue, source.user, remarks);
  } else if (map["grasp"].given()) {
    map["grasp"].fail("must be left out, only role grasper holds tissue");
  }
  return tool;
}

}  // namespace

std::string readGraphName(const Entry& entry) {
  const std::string name = entry.word(kNameRule);
  if (!isGraphName(name)) entry.fail("must be " + kNameRule);
  return name;
}

std::vector<ToolConfig> readTools(const Entry& entry, const SceneSource& source,
                                  const TissueConfig& tissue, Remarks& remarks) {
  std::vector<ToolConfig> tools;
  for (const Entry& tool_entry : entry.list(0, "tools")) {
    tools.push_back(readTool(tool_entry, source, tissue, tools, remarks));
  }
  return tools;
}

}  // namespace robot_tissue
