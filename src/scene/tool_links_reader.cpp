// The links of a tool: its own or several, and its jaws.
#include <algorithm>
#include <optional>

#include "robot_tissue/scene/readers.h"

namespace robot_tissue {
namespace {

const std::string kLinkName = "the name of a link of the URDF";

// A link with the entry that names it, given or not.
struct NamedLink {
  ToolLink link;
  Entry name;
};

std::map<std::string, double> readCollisionPadding(const Entry& entry, const Range& gap) {
  std::map<std::string, double> padding;
  if (!entry.given()) return padding;
  if (!entry.node().IsMap()) entry.fail("must be a map of names of collisions of the URDF to m");
  std::vector<std::string> names;
  for (const auto& item : entry.node()) {
    if (item.first.IsScalar()) names.push_back(item.first.Scalar());
  }
  const MapReader map(entry, names);
  for (const std::string& name : names) padding[name] = map[name].number(gap);
  return padding;
}

struct LinkReading {
  const Surroundings& surroundings;
  Remarks& remarks;
  ToolLink link;
};

void readShapes(const Entry& entry, LinkReading& reading) {
  if (!entry.given()) return;
  ToolLink& link = reading.link;
  for (const Entry& shape : entry.list(0, "shapes")) {
    link.shapes.push_back(readToolShape(shape, reading.surroundings));
  }
  // Nothing else says what the tool is made of.
  if (link.link.empty() && link.shapes.empty()) entry.list(1, "shapes");
}

const KeyTable<LinkReading> kLinkKeys = {
    {"link",
     [](const Entry& entry, LinkReading& reading) {
       if (entry.given()) reading.link.link = entry.word(kLinkName);
     }},
    {"padding",
     [](const Entry& entry, LinkReading& reading) {
       const Range& gap = reading.surroundings.lengths.gap;
       reading.link.padding = entry.numberOr(reading.link.padding, gap);
     }},
    {"shapes", readShapes},
    {"collision_padding",
     [](const Entry& entry, LinkReading& reading) {
       const Range& gap = reading.surroundings.lengths.gap;
       reading.link.collision_padding = readCollisionPadding(entry, gap);
       if (!entry.given() || reading.link.shapes.empty()) return;
       reading.remarks.push_back(
           entry.line("ignored, shapes take the place of the URDF's collisions"));
     }},
};

NamedLink readLink(const MapReader& map, const Surroundings& surroundings, Remarks& remarks) {
  LinkReading reading{surroundings, remarks, {}};
  reading.link.path = map.entry().path();
  readKeys(map, kLinkKeys, reading);
  return {reading.link, map["link"]};
}

NamedLink readListedLink(const Entry& entry, const Surroundings& surroundings, Remarks& remarks) {
  if (entry.node().IsScalar()) {
    ToolLink link;
    link.link = entry.word(kLinkName);
    link.path = entry.path();
    return {link, entry};
  }
  const MapReader map(entry, namesOf(kLinkKeys));
  if (!map["link"].given() && !map["shapes"].given()) {
    entry.fail("must have link, shapes or both");
  }
  return readLink(map, surroundings, remarks);
}

std::vector<NamedLink> readLinkList(const Entry& entry, const Surroundings& surroundings,
                                    Remarks& remarks, std::size_t at_least, std::size_t at_most) {
  std::vector<NamedLink> links;
  for (const Entry& link_entry : entry.list(at_least, "links", at_most)) {
    const NamedLink named = readListedLink(link_entry, surroundings, remarks);
    const std::string& name = named.link.link;
    const bool twice = !name.empty() && std::any_of(links.begin(), links.end(), [&](const auto& o) {
      return o.link.link == name;
    });
    if (twice) named.name.fail("the link stands here twice, must stand once");
    links.push_back(named);
  }
  return links;
}

// Refuses the keys of a single link (padding, shapes ...) beside `links`, whose entries have them.
void requireSingleLinkKeysAbsent(const MapReader& map) {
  for (const std::string& key : namesOf(kLinkKeys)) {
    if (map[key].given()) map[key].fail("must not stand beside links, but with one of them");
  }
}

std::vector<NamedLink> readPlainLinks(const MapReader& tool, const Surroundings& surroundings,
                                      SceneUser user, const ToolRole& role, Remarks& remarks) {
  if (tool["jaws"].given())
    tool["jaws"].fail("must be left out, only role " + toolRolesWith(&ToolRole::has_jaws) +
                      " has jaws");
  if (tool["links"].given()) {
    requireSingleLinkKeysAbsent(tool);
    return readLinkList(tool["links"], surroundings, remarks, 1, kMostEntries);
  }
  const bool is_bare = !tool["link"].given() && !tool["shapes"].given();
  if (user == SceneUser::kRunner && is_bare && !role.has_edge) {
    tool.entry().fail("must have link, links or shapes");
  }
  return {readLink(tool, surroundings, remarks)};
}

// The tool's own link, which touches nothing without shapes, then the jaws.
std::vector<NamedLink> readLinksWithJaws(const MapReader& tool, const ToolRole& role,
                                         const Surroundings& surroundings, SceneUser user,
                                         Remarks& remarks) {
  if (tool["links"].given()) {
    tool["links"].fail("must be left out, role " + role.name + " has one link of its own and jaws");
  }
  std::vector<NamedLink> links = {readLink(tool, surroundings, remarks)};
  for (const char* key : {"padding", "collision_padding"}) {
    if (!tool[key].given() || !links.front().link.shapes.empty()) continue;
    tool[key].fail("the " + role.name + "'s own link has no shapes, must stand with the jaws");
  }
  if (user == SceneUser::kRunner && role.shears && !tool["jaws"].given()) {
    links.resize(3, links.front());  // edges need no shapes
    return links;
  }
  const std::vector<NamedLink> jaws = readLinkList(tool["jaws"], surroundings, remarks, 2, 2);
  links.insert(links.end(), jaws.begin(), jaws.end());
  return links;
}

// All links or none are of the URDF; the node has all of their poses from there.
void checkNames(const std::vector<NamedLink>& links, SceneUser user, bool jaws) {
  const bool any_named = std::any_of(links.begin(), links.end(),
                                     [](const auto& link) { return !link.link.link.empty(); });
  if (user == SceneUser::kRunner && !any_named) return;
  for (const NamedLink& named : links) {
    const bool frame_only = jaws && &named == &links.front() && named.link.shapes.empty();
    if (!named.link.link.empty() || (frame_only && !named.name.given())) continue;
    named.name.fail("must be " + kLinkName +
                    (user == SceneUser::kNode ? "" : ", as other links of the tool have one"));
  }
}

}  // namespace

std::vector<std::string> toolLinkKeys() {
  std::vector<std::string> keys = namesOf(kLinkKeys);
  keys.insert(keys.end(), {"links", "jaws"});
  return keys;
}

ToolLinks readToolLinks(const MapReader& tool, const Surroundings& surroundings, SceneUser user,
                        const ToolRole& role, Remarks& remarks) {
  const std::vector<NamedLink> named =
      role.has_jaws ? readLinksWithJaws(tool, role, surroundings, user, remarks)
                    : readPlainLinks(tool, surroundings, user, role, remarks);
  checkNames(named, user, role.has_jaws);
  ToolLinks links;
  for (const NamedLink& link : named) {
    links.links.push_back(link.link);
    links.names.push_back(link.name);
  }
  return links;
}

}  // namespace robot_tissue
