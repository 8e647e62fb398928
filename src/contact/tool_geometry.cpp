#include "robot_tissue/contact/tool_geometry.h"

#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <exception>
#include <memory>

#include "robot_tissue/mesh/quiet_console.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kLinksToList = 8;

struct ParsedUrdf {
  std::shared_ptr<const urdf::ModelInterface> model;
  std::vector<std::string> errors;  // what the parser skipped over
};

ParsedUrdf parseUrdf(const std::string& urdf_xml) {
  if (urdf_xml.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError("robot_description: is empty; the URDF that has the tools' links is needed");
  }
  QuietConsole console;
  std::shared_ptr<const urdf::ModelInterface> model;
  try {
    model = urdf::parseURDF(urdf_xml);
  } catch (const std::exception& error) {
    throw InputError(std::string("robot_description: is no valid URDF (") + error.what() + ")");
  }
  if (!model) throw InputError("robot_description: is no valid URDF" + console.reason());
  return {model, console.errors()};
}

std::string listLinks(const urdf::ModelInterface& model) {
  std::string list;
  std::size_t listed = 0;
  for (const auto& [name, link] : model.links_) {
    if (listed == kLinksToList) {
      return list + ", ... (" + std::to_string(model.links_.size() - listed) + " more)";
    }
    list += (listed == 0 ? "" : ", ") + name;
    ++listed;
  }
  return list;
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

std::vector<ToolShape> collisionShapes(const urdf::Link& link) {
  std::vector<ToolShape> shapes;
  for (const auto& collision : link.collision_array) {
    if (collision && collision->geometry) {
      shapes.push_back(toShape(*collision->geometry, collision->origin));
    }
  }
  return shapes;
}

// urdfdom gives up on a link at its first faulty element and hands out what came before.
void refuseHalfReadLink(const std::vector<std::string>& errors, const std::string& link) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i].find("[" + link + "]") == std::string::npos) continue;
    throw InputError("robot_description: link '" + link + "' cannot be read (" +
                     (i > 0 ? errors[i - 1] + "; " : "") + errors[i] + ")");
  }
}

std::string toolKey(std::size_t index) { return "tools[" + std::to_string(index) + "]"; }

}  // namespace

LoadedTools loadTools(const std::string& urdf_xml, const std::vector<ToolConfig>& configs) {
  LoadedTools loaded;
  if (configs.empty()) return loaded;
  const auto [model, errors] = parseUrdf(urdf_xml);
  for (std::size_t i = 0; i < configs.size(); ++i) {
    const ToolConfig& config = configs[i];
    const auto link = model->getLink(config.link);
    ToolGeometry tool{config.name.empty() ? config.link : config.name, config.link, config.padding,
                      config.shapes};
    if (!link) {
      throw InputError(toolKey(i) + ".link: '" + config.link + "' of tool '" + tool.name +
                       "' is no link of the robot '" + model->getName() +
                       "'; it has: " + listLinks(*model));
    }
    if (tool.shapes.empty()) {
      refuseHalfReadLink(errors, tool.link);
      tool.shapes = collisionShapes(*link);
    }
    if (tool.shapes.empty()) {
      loaded.warnings.push_back("tool '" + tool.name + "' touches nothing: its link '" + tool.link +
                                "' has no collision geometry in the URDF; give it some under " +
                                toolKey(i) + ".shapes");
    }
    loaded.tools.push_back(std::move(tool));
  }
  return loaded;
}

}  // namespace robot_tissue
