#include "robot_tissue/contact/tool_geometry.h"

#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <exception>
#include <memory>

#include "robot_tissue/mesh/quiet_console.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kNamesToList = 8;
const std::string kAllowedUrdf = "; allowed: a URDF that has the tools' links";

struct ParsedUrdf {
  std::shared_ptr<const urdf::ModelInterface> model;
  std::vector<std::string> errors;  // what the parser skipped over
};

ParsedUrdf parseUrdf(const std::string& urdf_xml) {
  if (urdf_xml.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError("robot_description: is empty" + kAllowedUrdf);
  }
  QuietConsole console;
  std::shared_ptr<const urdf::ModelInterface> model;
  try {
    model = urdf::parseURDF(urdf_xml);
  } catch (const std::exception& error) {
    throw InputError(std::string("robot_description: is no valid URDF (") + error.what() + ")" +
                     kAllowedUrdf);
  }
  if (!model) {
    const bool is_xacro = urdf_xml.find("xacro:") != std::string::npos;
    throw InputError(
        "robot_description: is no valid URDF" + console.reason() +
        (is_xacro ? ": it is xacro, of which `xacro FILE > robot.urdf` makes a URDF" : "") +
        kAllowedUrdf);
  }
  return {model, console.errors()};
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == kNamesToList) {
      return list + ", ... (" + std::to_string(names.size() - i) + " more)";
    }
    list += (i == 0 ? "" : ", ") + names[i];
  }
  return list;
}

std::string listLinks(const urdf::ModelInterface& model) {
  std::vector<std::string> names;
  for (const auto& [name, link] : model.links_) names.push_back(name);
  return listed(names);
}

Pose toPose(const urdf::Pose& urdf_pose) {
  const urdf::Rotation& q = urdf_pose.rotation;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  pose.translation() = Vec3(urdf_pose.position.x, urdf_pose.position.y, urdf_pose.position.z);
  return pose;
}

ToolShape toShape(const urdf::Geometry& geometry, const urdf::Pose& origin) {
  ToolShape shape;
  shape.pose = toPose(origin);
  switch (geometry.type) {
    case urdf::Geometry::SPHERE:
      shape.type = ToolShape::Type::kSphere;
      shape.radius = static_cast<const urdf::Sphere&>(geometry).radius;
      break;
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
      shape.type = ToolShape::Type::kBox;
      shape.size = Vec3(size.x, size.y, size.z);
      break;
    }
    case urdf::Geometry::CYLINDER:
      shape.type = ToolShape::Type::kCylinder;
      shape.radius = static_cast<const urdf::Cylinder&>(geometry).radius;
      shape.length = static_cast<const urdf::Cylinder&>(geometry).length;
      break;
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      shape.type = ToolShape::Type::kMesh;
      shape.resource = mesh.filename;
      shape.scale = Vec3(mesh.scale.x, mesh.scale.y, mesh.scale.z);
      break;
    }
  }
  return shape;
}

// Each with the padding of its name; the link's own is not in it yet.
std::vector<ToolShape> collisionShapes(const urdf::Link& link, const ToolLink& config) {
  std::vector<ToolShape> shapes;
  for (const auto& collision : link.collision_array) {
    if (!collision || !collision->geometry) continue;
    shapes.push_back(toShape(*collision->geometry, collision->origin));
    const auto padding = config.collision_padding.find(collision->name);
    if (padding != config.collision_padding.end()) shapes.back().padding = padding->second;
  }
  return shapes;
}

void requirePaddedCollisions(const urdf::Link& link, const ToolLink& config,
                             const std::string& key) {
  std::vector<std::string> names;
  for (const auto& collision : link.collision_array) {
    if (collision && !collision->name.empty()) names.push_back(collision->name);
  }
  for (const auto& [name, padding] : config.collision_padding) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw InputError(
        key + ".collision_padding: '" + name + "' is no name of a collision of link '" + link.name +
        (names.empty() ? "', whose collisions have no names" : "'; it has: " + listed(names)));
  }
}

// urdfdom gives up on a link at its first faulty element and hands out what came before.
void refuseHalfReadLink(const std::vector<std::string>& errors, const std::string& link) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i].find("[" + link + "]") == std::string::npos) continue;
    throw InputError("robot_description: link '" + link + "' cannot be read (" +
                     (i > 0 ? errors[i - 1] + "; " : "") + errors[i] + ")");
  }
}

std::string linkKey(const std::vector<ToolConfig>& tools, std::size_t tool, std::size_t link) {
  const std::string& path = tools[tool].links[link].path;
  if (!path.empty()) return path;
  return "tools[" + std::to_string(tool) + "].links[" + std::to_string(link) + "]";
}

// All but the links.
ToolGeometry toolOf(const ToolConfig& config, std::size_t index) {
  if (config.links.empty()) {
    throw InputError("tools[" + std::to_string(index) +
                     "].links: is empty; allowed is one link or more");
  }
  ToolGeometry tool;
  tool.name = config.name.empty() ? config.links.front().link : config.name;
  tool.role = config.role;
  tool.patch = config.patch;
  tool.friction = config.friction;
  tool.max_force = config.max_force;
  tool.grasp = config.grasp;
  tool.blade = config.blade;
  tool.scissors = config.scissors;
  return tool;
}

LinkGeometry linkOf(const ToolLink& config, std::vector<ToolShape> shapes) {
  for (ToolShape& shape : shapes) shape.padding += config.padding;
  return {config.link, std::move(shapes)};
}

void warnOfUselessPadding(const ToolLink& config, const std::string& key,
                          std::vector<std::string>& warnings) {
  if (config.collision_padding.empty()) return;
  warnings.push_back(key +
                     ".collision_padding: is not used, as no collision geometry of a URDF is; the "
                     "shapes have a padding of their own");
}

urdf::LinkConstSharedPtr findLink(const ParsedUrdf& urdf, const ToolLink& config,
                                  const std::string& tool, const std::string& key) {
  const urdf::LinkConstSharedPtr link = urdf.model->getLink(config.link);
  if (link) return link;
  throw InputError(key + ".link: '" + config.link + "' of tool '" + tool +
                   "' is no link of the robot '" + urdf.model->getName() +
                   "'; it has: " + listLinks(*urdf.model));
}

// What cuts by its edges does without.
bool needsShapes(const ToolRole& role) { return !role.has_edge && !role.shears; }

LinkGeometry loadLink(const ParsedUrdf& urdf, const ToolLink& config, const std::string& tool,
                      const std::string& key, bool needs_shapes,
                      std::vector<std::string>& warnings) {
  const auto link = findLink(urdf, config, tool, key);
  if (!config.shapes.empty()) {
    warnOfUselessPadding(config, key, warnings);
    return linkOf(config, config.shapes);
  }
  refuseHalfReadLink(urdf.errors, config.link);
  requirePaddedCollisions(*link, config, key);
  LinkGeometry loaded = linkOf(config, collisionShapes(*link, config));
  if (loaded.shapes.empty() && needs_shapes) {
    warnings.push_back("tool '" + tool + "': its link '" + config.link +
                       "' touches nothing, as it has no collision geometry in the URDF; give it "
                       "some under " +
                       key + ".shapes");
  }
  return loaded;
}

// A grasper's own link is its frame, and touches nothing without shapes of the scene.
bool isFrameOnly(const ToolConfig& tool, std::size_t link) {
  return tool.role.has_jaws && link + 2 < tool.links.size() && tool.links[link].shapes.empty();
}

}  // namespace

void requireUrdf(const std::string& urdf_xml) { parseUrdf(urdf_xml); }

LoadedTools loadTools(const std::string& urdf_xml, const std::vector<ToolConfig>& configs) {
  LoadedTools loaded;
  if (configs.empty()) return loaded;
  const ParsedUrdf urdf = parseUrdf(urdf_xml);
  for (std::size_t i = 0; i < configs.size(); ++i) {
    ToolGeometry tool = toolOf(configs[i], i);
    for (std::size_t j = 0; j < configs[i].links.size(); ++j) {
      const ToolLink& link = configs[i].links[j];
      if (isFrameOnly(configs[i], j)) {
        if (!link.link.empty()) findLink(urdf, link, tool.name, linkKey(configs, i, j));
        tool.links.push_back({link.link, {}});
        continue;
      }
      tool.links.push_back(loadLink(urdf, link, tool.name, linkKey(configs, i, j),
                                    needsShapes(tool.role), loaded.warnings));
    }
    loaded.tools.push_back(std::move(tool));
  }
  return loaded;
}

std::optional<std::string> linkThatNeedsUrdf(const std::vector<ToolConfig>& configs) {
  for (const ToolConfig& tool : configs) {
    for (std::size_t link = 0; link < tool.links.size(); ++link) {
      const ToolLink& config = tool.links[link];
      const bool has_shapes = !config.shapes.empty() || isFrameOnly(tool, link);
      if (!has_shapes && !config.link.empty()) return config.link;
    }
  }
  return std::nullopt;
}

LoadedTools toolsOf(const std::vector<ToolConfig>& configs) {
  LoadedTools loaded;
  for (std::size_t i = 0; i < configs.size(); ++i) {
    ToolGeometry tool = toolOf(configs[i], i);
    for (std::size_t j = 0; j < configs[i].links.size(); ++j) {
      const ToolLink& link = configs[i].links[j];
      warnOfUselessPadding(link, linkKey(configs, i, j), loaded.warnings);
      tool.links.push_back(linkOf(link, link.shapes));
    }
    const bool bare = std::all_of(tool.links.begin(), tool.links.end(),
                                  [](const LinkGeometry& link) { return link.shapes.empty(); });
    if (bare && needsShapes(tool.role)) {
      loaded.warnings.push_back("tool '" + tool.name +
                                "' touches nothing: it has no shapes; give it some under " +
                                linkKey(configs, i, 0) + ".shapes");
    }
    loaded.tools.push_back(std::move(tool));
  }
  return loaded;
}

}  // namespace robot_tissue
