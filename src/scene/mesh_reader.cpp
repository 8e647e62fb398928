#include <filesystem>

#include "robot_tissue/core/mesh_checks.h"
#include "robot_tissue/mesh/mesh_file.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool isOfPackage(const std::string& address) { return startsWith(address, "package://"); }

TriangleMesh load(const Entry& resource, const std::string& address, const Vec3& scale) {
  try {
    return loadMeshFile(address, scale);
  } catch (const InputError& error) {
    resource.fail(onOneLine(error.what()) + ", must be " + kMeshFileRule);
  }
}

// Written so that NaN is out of reach.
void requireInReach(const Entry& resource, const TriangleMesh& mesh, const Range& place) {
  for (const Vec3& vertex : mesh.vertices) {
    if (vertex.cwiseAbs().maxCoeff() <= place.highest) continue;
    resource.fail("the mesh, scaled, has a coordinate that is not finite or beyond " +
                  numberText(place.highest) + " m, must have none");
  }
}

}  // namespace

std::string readResource(const Entry& entry, const std::string& scene_folder) {
  const std::string package = "package://";
  const std::string file = "file://";
  const std::string allowed = "package://PACKAGE/PATH, file:///PATH or a path";
  const std::string resource = entry.word(allowed);
  if (startsWith(resource, package) && resource.size() > package.size()) return resource;
  if (resource.find("://") != std::string::npos && !startsWith(resource, file)) {
    entry.fail("must be " + allowed);
  }
  std::filesystem::path path = startsWith(resource, file) ? pathOfFileAddress(resource) : resource;
  if (path.is_relative()) {
    if (scene_folder.empty() || startsWith(resource, file)) {
      entry.fail("must be package://PACKAGE/PATH or file:///PATH, a relative path has no start");
    }
    path = std::filesystem::absolute(scene_folder / path).lexically_normal();
  }
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    entry.fail("must be an existing file, there is none at " + path.string());
  }
  if (!std::filesystem::is_regular_file(path, ignored)) {
    entry.fail("is a folder, a pipe or a device, must be " + kMeshFileRule);
  }
  return fileAddressOf(path.string());
}

Vec3 readScale(const Entry& entry) {
  if (!entry.given()) return Vec3::Ones();
  if (entry.node().IsSequence()) return entry.vec3(ranges::scale());
  return Vec3::Constant(entry.number(ranges::scale()));
}

TriangleMesh readMeshShape(const MapReader& map, const std::string& scene_folder) {
  const Entry resource = map["resource"];
  const std::string address = readResource(resource, scene_folder);
  TriangleMesh mesh = load(resource, address, readScale(map["scale"]));
  requireInReach(resource, mesh, ranges::pickedPlace());
  mesh = welded(mesh);
  if (const auto fault = meshFault(mesh)) {
    resource.fail(
        "the mesh " + *fault +
        "; must be closed (mesh editors fill holes), its triangles all facing outwards or all "
        "inwards, and not intersect itself");
  }
  return facingOutward(std::move(mesh));
}

void requireToolMesh(const Entry& resource, const std::string& address, const Vec3& scale,
                     const LengthRanges& lengths) {
  if (isOfPackage(address)) return;
  const TriangleMesh mesh = load(resource, address, scale);
  requireInReach(resource, mesh, lengths.place);
  const Box box = boundsOf(mesh.vertices);
  if ((box.max() - box.min()).maxCoeff() < lengths.length.lowest) {
    resource.fail("the mesh, scaled, is smaller than " + numberText(lengths.length.lowest) +
                  " m, must be larger");
  }
  const auto fault = meshFault(welded(mesh));
  if (!fault || startsWith(*fault, "intersects itself")) return;  // a tool may, it is warned of
  resource.fail(
      "the mesh " + *fault +
      "; must be closed (mesh editors fill holes), its triangles all facing outwards or all "
      "inwards, and have a volume");
}

void requireSpacingWithin(const Entry& spacing, const TriangleMesh& mesh) {
  const Box bounds = boundsOf(mesh.vertices);
  const double smallest = (bounds.max() - bounds.min()).minCoeff();
  if (spacing.number(ranges::spacing()) <= smallest) return;
  spacing.fail("must be at most the mesh's smallest extent, " + numberText(smallest) + " m");
}

}  // namespace robot_tissue
