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

ToolRole readRole(const Entry& entry, const std::string& model) {
  if (!entry.given()) return {};
  std::vector<std::string> names;
  for (const ToolRole& role : toolRoles()) names.push_back(role.name);
  const ToolRole& role = toolRole(entry.choice(names));
  if (hardPatchesOnly(model) && !role.fits_hard_patches) {
    entry.fail("with tissue.model " + model + " must be " +
               toolRolesWith(&ToolRole::fits_hard_patches) +
               ", its method moves hard patches only");
  }
  return role;
}

ToolConfig::Patch readPatch(const Entry& entry, const std::string& model) {
  if (!entry.given()) {
    return hardPatchesOnly(model) ? ToolConfig::Patch::kRigid : ToolConfig::Patch::kConforming;
  }
  if (entry.choice({"conforming", "rigid"}) == "rigid") return ToolConfig::Patch::kRigid;
  if (hardPatchesOnly(model)) {
    entry.fail("with tissue.model " + model + " must be rigid, its method moves hard patches only");
  }
  return ToolConfig::Patch::kConforming;
}

struct GraspReading {
  const LengthRanges& lengths;
  SceneUser user;
  Remarks& remarks;
  GraspConfig grasp;
};

const KeyTable<GraspReading> kGraspKeys = {
    {"close_gap",
     [](const Entry& entry, GraspReading& reading) {
       reading.grasp.close_gap = entry.numberOr(reading.grasp.close_gap, reading.lengths.length);
     }},
    {"open_gap",
     [](const Entry& entry, GraspReading& reading) {
       GraspConfig& grasp = reading.grasp;
       grasp.open_gap = entry.numberOr(
           1.5 * grasp.close_gap,
           {grasp.close_gap, reading.lengths.gap.highest, "m, not below the close_gap"});
     }},
    {"max_force",
     [](const Entry& entry, GraspReading& reading) {
       reading.grasp.max_force = entry.numberOr(reading.grasp.max_force, ranges::forceLimit());
     }},
    {"on_max_force",
     [](const Entry& entry, GraspReading& reading) {
       if (!entry.given()) return;
       reading.grasp.tears_out = entry.choice({"release", "tear"}) == "tear";
       if (!reading.grasp.tears_out || reading.grasp.max_force > 0.0) return;
       entry.fail("must stand with a max_force above 0");
     }},
    {"opening_axis",
     [](const Entry& entry, GraspReading& reading) {
       if (!entry.given()) return;
       reading.grasp.opening_axis = readOpeningAxis(entry, reading.user, reading.remarks);
     }},
};

struct ToolReading {
  const TissueConfig& tissue;
  SceneUser user;
  Remarks& remarks;
  ToolConfig tool;
};

void readGrasp(const Entry& entry, ToolReading& reading) {
  if (!reading.tool.role.holds) {
    if (!entry.given()) return;
    entry.fail("must be left out, only role " + toolRolesWith(&ToolRole::holds) + " holds tissue");
  }
  const Entry given = entry.given() ? entry : entry.child(YAML::Node(YAML::NodeType::Map), "");
  const LengthRanges lengths = lengthsOf(reading.tissue);
  GraspReading grasp{lengths, reading.user, reading.remarks, {}};
  grasp.grasp.close_gap = reading.tissue.spacing;
  readKeys(MapReader(given, namesOf(kGraspKeys)), kGraspKeys, grasp);
  reading.tool.grasp = grasp.grasp;
}

void readFriction(const Entry& entry, ToolReading& reading) {
  reading.tool.friction = entry.numberOr(reading.tool.friction, ranges::friction());
  if (!entry.given() || reading.tool.patch != ToolConfig::Patch::kRigid) return;
  reading.remarks.push_back(entry.line("ignored, a rigid patch sticks to its tool"));
}

// Keys of a tool; those of its links are in tool_links_reader.cpp.
const KeyTable<ToolReading> kToolKeys = {
    {"name"},
    {"role"},
    {"patch",
     [](const Entry& entry, ToolReading& reading) {
       reading.tool.patch = readPatch(entry, reading.tissue.model);
     }},
    {"friction", readFriction},
    {"max_force",
     [](const Entry& entry, ToolReading& reading) {
       reading.tool.max_force = entry.numberOr(reading.tool.max_force, ranges::forceLimit());
     }},
    {"grasp", readGrasp},
    {"edge",
     [](const Entry& entry, ToolReading& reading) {
       readEdge(entry, reading.tissue, reading.tool, reading.remarks);
     }},
    {"resistance",
     [](const Entry& entry, ToolReading& reading) { readResistance(entry, reading.tool); }},
    {"edges", [](const Entry& entry,
                 ToolReading& reading) { readEdges(entry, reading.tissue, reading.tool); }},
    {"opening_axis",
     [](const Entry& entry, ToolReading& reading) {
       readOpeningOfScissors(entry, reading.user, reading.tool, reading.remarks);
     }},
};

// A link of two tools: where both touch, each feels but a part of the force. With the same surface
// they touch everywhere.
void checkLinksAreOnce(const ToolLinks& links, const ToolConfig& tool,
                       const std::vector<ToolConfig>& earlier, Remarks& remarks) {
  const auto touches = [](const ToolConfig& of, std::size_t link) {
    const bool is_frame = of.role.has_jaws && link + 2 < of.links.size();
    const bool is_bare = !of.role.touches() || (is_frame && of.links[link].shapes.empty());
    return !of.links[link].link.empty() && !is_bare;
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
  std::vector<std::string> keys = namesOf(kToolKeys);
  for (const std::string& key : toolLinkKeys()) keys.push_back(key);
  const MapReader map(entry, keys);
  ToolReading reading{tissue, source.user, remarks, {}};
  ToolConfig& tool = reading.tool;
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
  readKeys(map, kToolKeys, reading);
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
