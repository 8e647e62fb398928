#include "write_scene.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

namespace fs = std::filesystem;

struct Edit {
  std::size_t from = 0;  // byte of the text
  std::size_t length = 0;
  std::string text;
};

// Empty where the edits cannot be found.
using Edits = std::optional<std::vector<Edit>>;

// Not in place: what an anchor shares would change elsewhere, too.
void set(YAML::Node map, const std::string& key, const std::string& value) {
  map.remove(key);
  map[key] = value;
}

bool same(const YAML::Node& a, const YAML::Node& b) {
  if (a.Type() != b.Type()) return false;
  if (a.IsScalar()) return a.Scalar() == b.Scalar();
  if (a.size() != b.size()) return false;
  if (a.IsSequence()) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (!same(a[i], b[i])) return false;
    }
  }
  if (a.IsMap()) {
    for (const auto& entry : a) {
      const YAML::Node other = b[entry.first.Scalar()];
      if (!other.IsDefined() || !same(entry.second, other)) return false;
    }
  }
  return true;
}

// The same file, seen from another folder.
std::string moved(const std::string& resource, const std::string& from, const std::string& to) {
  if (resource.find("://") != std::string::npos || fs::path(resource).is_absolute()) {
    return resource;
  }
  return fs::proximate(fs::absolute(fs::path(from) / resource), fs::absolute(to)).string();
}

// Every map in the node that has a mesh file.
void collectMeshes(const YAML::Node& node, std::vector<YAML::Node>& maps) {
  if (node.IsMap()) {
    const YAML::Node resource = node["resource"];
    if (resource.IsDefined() && resource.IsScalar()) maps.push_back(node);
    for (const auto& entry : node) collectMeshes(entry.second, maps);
  } else if (node.IsSequence()) {
    for (const auto& item : node) collectMeshes(item, maps);
  }
}

bool addReplacement(const std::string& text, const YAML::Node& scalar, const std::string& value,
                    std::vector<Edit>& edits) {
  const YAML::Mark mark = scalar.Mark();
  const std::string& old = scalar.Scalar();
  if (mark.is_null() || old.empty()) return false;
  const auto from = static_cast<std::size_t>(mark.pos);
  if (text.compare(from, old.size(), old) != 0) return false;
  edits.push_back({from, old.size(), value});
  return true;
}

// New keys stand before the map's first one.
bool addKeys(const YAML::Node& map, const std::vector<std::string>& entries,
             std::vector<Edit>& edits) {
  if (entries.empty()) return true;
  if (!map.IsMap() || map.size() == 0) return false;
  const YAML::Mark mark = map.begin()->first.Mark();
  if (mark.is_null()) return false;
  const bool flow = map.Style() == YAML::EmitterStyle::Flow;
  const std::string gap =
      flow ? ", " : "\n" + std::string(static_cast<std::size_t>(mark.column), ' ');
  std::string added;
  for (const std::string& entry : entries) added += entry + gap;
  edits.push_back({static_cast<std::size_t>(mark.pos), 0, added});
  return true;
}

Edits findEdits(const std::string& text, const YAML::Node& root, const Rung& rung,
                const std::string& from, const std::string& to) {
  std::vector<Edit> edits;
  const std::string tolerance = numberText(rung.tolerance);
  bool found = addReplacement(text, root["tissue"]["spacing"], numberText(rung.spacing), edits);
  const YAML::Node solver = root["solver"];
  if (!solver.IsDefined() || solver.IsNull()) {
    found = found && !solver.IsDefined() && root.Style() != YAML::EmitterStyle::Flow;
    const std::string line_end = !text.empty() && text.back() == '\n' ? "" : "\n";
    edits.push_back(
        {text.size(), 0,
         line_end + "solver: {method: " + rung.method + ", tolerance: " + tolerance + "}\n"});
  } else {
    std::vector<std::string> missing;
    const auto put = [&](const std::string& key, const std::string& value) {
      if (!solver[key].IsDefined()) {
        missing.push_back(key + ": " + value);
      } else {
        found = found && addReplacement(text, solver[key], value, edits);
      }
    };
    put("method", rung.method);
    put("tolerance", tolerance);
    found = found && addKeys(solver, missing, edits);
  }
  std::vector<YAML::Node> meshes;
  collectMeshes(root, meshes);
  for (const YAML::Node& mesh : meshes) {
    const std::string path = mesh["resource"].Scalar();
    if (moved(path, from, to) == path) continue;
    found = found && addReplacement(text, mesh["resource"], moved(path, from, to), edits);
  }
  return found ? Edits(edits) : std::nullopt;
}

std::string edited(std::string text, std::vector<Edit> edits) {
  std::stable_sort(edits.begin(), edits.end(),
                   [](const Edit& a, const Edit& b) { return a.from > b.from; });
  for (const Edit& edit : edits) text.replace(edit.from, edit.length, edit.text);
  return text;
}

// Keys and values that the new text must have.
YAML::Node wanted(const std::string& text, const Rung& rung, const std::string& from,
                  const std::string& to) {
  YAML::Node root = YAML::Load(text);
  set(root["tissue"], "spacing", numberText(rung.spacing));
  YAML::Node solver = root["solver"].IsDefined() && root["solver"].IsMap()
                          ? YAML::Clone(root["solver"])
                          : YAML::Node(YAML::NodeType::Map);
  set(solver, "method", rung.method);
  set(solver, "tolerance", numberText(rung.tolerance));
  root.remove("solver");
  root["solver"] = solver;
  std::vector<YAML::Node> meshes;
  collectMeshes(root, meshes);
  for (const YAML::Node& mesh : meshes) {
    set(mesh, "resource", moved(mesh["resource"].Scalar(), from, to));
  }
  return root;
}

}  // namespace

std::string withRung(const std::string& text, const Rung& rung, const std::string& from,
                     const std::string& to) {
  const YAML::Node expected = wanted(text, rung, from, to);
  if (const Edits edits = findEdits(text, YAML::Load(text), rung, from, to)) {
    const std::string result = edited(text, *edits);
    try {
      if (same(YAML::Load(result), expected)) return result;
    } catch (const YAML::Exception&) {
    }
  }
  return YAML::Dump(expected) + "\n";
}

}  // namespace robot_tissue
