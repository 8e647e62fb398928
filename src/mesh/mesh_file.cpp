#include "robot_tissue/mesh/mesh_file.h"

#include <rospack/rospack.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "mesh_formats.h"
#include "robot_tissue/mesh/regular_file.h"

namespace robot_tissue {
namespace {

const std::string kPackage = "package://";
const std::string kFile = "file://";

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

// By the ending of the name, whatever its case; null for other files.
TriangleMesh (*meshReaderFor(const std::string& path))(const std::string& bytes) {
  std::string ending = std::filesystem::path(path).extension();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".stl") return readStl;
  if (ending == ".obj") return readObj;
  return ending == ".dae" ? readDae : nullptr;
}

std::string packageFolder(const std::string& name) {
  rospack::Rospack packages;
  packages.setQuiet(true);
  std::vector<std::string> search_path;
  std::string folder;
  if (packages.getSearchPathFromEnv(search_path)) {
    packages.crawl(search_path, false);
    packages.find(name, folder);
  }
  if (folder.empty()) throw InputError("no ROS package " + name + " is found");
  return folder;
}

std::string pathInPackage(const std::string& place) {
  const std::size_t slash = std::min(place.find('/'), place.size());
  const std::string inner = std::filesystem::path("." + place.substr(slash)).lexically_normal();
  if (inner == ".." || startsWith(inner, "../")) throw InputError("its path leaves the package");
  return packageFolder(place.substr(0, slash)) + "/" + inner;
}

std::string pathOf(const std::string& resource) {
  if (startsWith(resource, kPackage)) return pathInPackage(resource.substr(kPackage.size()));
  return resource.substr(kFile.size());
}

TriangleMesh readByName(const std::string& path) {
  TriangleMesh (*const read)(const std::string&) = meshReaderFor(path);
  if (read == nullptr) throw InputError("its name ends neither in .stl nor .obj nor .dae");
  const TriangleMesh mesh = read(readRegularFile(path, kLargestMeshFile));
  if (mesh.triangles.empty()) throw InputError("has no triangles");
  return mesh;
}

}  // namespace

bool isMeshName(const std::string& path) { return meshReaderFor(path) != nullptr; }

TriangleMesh loadMeshFile(const std::string& resource, const Vec3& scale) {
  // Anything else would be looked for on the network.
  if (!startsWith(resource, kPackage) && !startsWith(resource, kFile + "/")) {
    throw InputError("is no package:// or file:// address");
  }
  try {
    TriangleMesh mesh = readByName(pathOf(resource));
    for (Vec3& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale);
    return mesh;
  } catch (const InputError& error) {
    throw InputError("cannot be loaded (" + std::string(error.what()) + ")");
  }
}

}  // namespace robot_tissue
