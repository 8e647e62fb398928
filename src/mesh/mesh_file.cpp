#include "robot_tissue/mesh/mesh_file.h"

#include <geometric_shapes/mesh_operations.h>
#include <rospack/rospack.h>

#include <exception>
#include <memory>

#include "robot_tissue/mesh/quiet_console.h"

namespace robot_tissue {
namespace {

const std::string kPackage = "package://";
const std::string kFile = "file://";

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

// file:// address of a package:// one. The retriever that geometric_shapes uses would print what it
// does not find.
std::string fileAddress(const std::string& resource) {
  if (!startsWith(resource, kPackage)) return resource;
  const std::string place = resource.substr(kPackage.size());
  const std::size_t slash = place.find('/');
  const std::string name = place.substr(0, slash);
  rospack::Rospack packages;
  packages.setQuiet(true);
  std::vector<std::string> search_path;
  std::string folder;
  if (packages.getSearchPathFromEnv(search_path)) {
    packages.crawl(search_path, false);
    packages.find(name, folder);
  }
  if (folder.empty()) throw InputError("cannot be loaded (no ROS package " + name + " is found)");
  return kFile + folder + (slash == std::string::npos ? "" : place.substr(slash));
}

}  // namespace

TriangleMesh loadMeshFile(const std::string& resource, const Vec3& scale) {
  // Anything else would be looked for on the network.
  if (!startsWith(resource, kPackage) && !startsWith(resource, kFile)) {
    throw InputError("is no package:// or file:// address");
  }
  const std::string address = fileAddress(resource);
  QuietConsole console;
  std::unique_ptr<shapes::Mesh> loaded;
  std::string reason;
  try {
    loaded.reset(shapes::createMeshFromResource(address, scale));
    reason = console.reason();
  } catch (const std::exception& error) {
    reason = std::string(" (") + error.what() + ")";
  }
  if (!loaded || loaded->triangle_count == 0) throw InputError("cannot be loaded" + reason);
  TriangleMesh mesh;
  for (unsigned int vertex = 0; vertex < loaded->vertex_count; ++vertex) {
    mesh.vertices.emplace_back(Eigen::Map<const Vec3>(loaded->vertices + 3 * vertex));
  }
  for (unsigned int t = 0; t < loaded->triangle_count; ++t) {
    const unsigned int* corners = loaded->triangles + 3 * t;
    mesh.triangles.push_back(
        {static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2])});
  }
  return mesh;
}

}  // namespace robot_tissue
