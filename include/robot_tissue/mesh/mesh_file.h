// Mesh files (STL, OBJ, DAE) as plain triangles.
#pragma once

#include <cstddef>
#include <string>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

constexpr std::size_t kLargestMeshFile = 100000000;  // bytes
const std::string kMeshFileRule = "a mesh file: STL, OBJ or DAE, up to 100 MB";

// `resource`: package:// or file:// address; nothing is fetched from the network, and a path does
// not leave its package; %XX in an address is a byte. The name tells the format, and the content
// must be of it. The triangles are as in the file, with coordinates times `scale`: not joined, not
// checked. A DAE file's own unit and up axis count for nothing: where that matters `remark`, else
// left as it is, becomes the end of such a line, too. Throws InputError whose text is the end of a
// line that begins with the mesh's name: "is no package:// or file:// address", "cannot be loaded
// (reason)".
TriangleMesh loadMeshFile(const std::string& resource, const Vec3& scale,
                          std::string* remark = nullptr);

// The path of an address that begins with file://, and the address of a path.
std::string pathOfFileAddress(const std::string& address);
std::string fileAddressOf(const std::string& path);

}  // namespace robot_tissue
