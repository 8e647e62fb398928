#include "robot_tissue/scene/scene_files.h"

#include <filesystem>

#include "robot_tissue/mesh/mesh_file.h"
#include "robot_tissue/scene/scene_parser.h"

namespace robot_tissue {

namespace fs = std::filesystem;

namespace {

// Of a mesh, as the scene or the address of a loaded one has it. Packages are not looked for.
void addMesh(const std::string& resource, const fs::path& folder, std::vector<std::string>& files) {
  const std::string scheme = "file://";
  const bool has_scheme = resource.find("://") != std::string::npos;
  const bool is_file = resource.compare(0, scheme.size(), scheme) == 0;
  if (resource.empty() || (has_scheme && !is_file)) return;
  files.push_back((folder / (is_file ? pathOfFileAddress(resource) : resource)).string());
}

void addShape(const YAML::Node& shape, const fs::path& folder, std::vector<std::string>& files) {
  if (!shape.IsDefined() || !shape.IsMap()) return;
  const YAML::Node resource = shape["resource"];
  if (resource.IsDefined() && resource.IsScalar()) addMesh(resource.Scalar(), folder, files);
}

}  // namespace

std::vector<std::string> inputFiles(const Scene& scene, const std::string& path) {
  const fs::path folder = fs::absolute(path).parent_path();
  std::vector<std::string> files = {path};
  const YAML::Node tissue = loadSceneText(path)["tissue"];
  addShape(tissue["shape"], folder, files);
  for (const YAML::Node& region : tissue["regions"]) addShape(region["shape"], folder, files);
  for (const ToolConfig& tool : scene.tools) {
    for (const ToolLink& link : tool.links) {
      for (const ToolShape& shape : link.shapes) addMesh(shape.resource, folder, files);
    }
  }
  return files;
}

std::string inputAt(const std::string& output, const std::vector<std::string>& inputs) {
  std::error_code none;  // what is not there is no other file
  for (const std::string& input : inputs) {
    if (fs::equivalent(input, output, none)) return input;
  }
  return "";
}

}  // namespace robot_tissue
