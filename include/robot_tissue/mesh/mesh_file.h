// Mesh files (STL, OBJ, DAE and what else Assimp reads) as plain triangles.
#pragma once

#include <string>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

// `resource`: package:// or file:// address; nothing is fetched from the network. The triangles are
// as in the file, with coordinates times `scale`: not joined, not checked. A DAE file's own unit
// and up axis count for nothing, as for tool meshes. Throws InputError whose text is the end of a
// line that begins with the mesh's name: "is no package:// or file:// address", "cannot be loaded
// (reason)".
TriangleMesh loadMeshFile(const std::string& resource, const Vec3& scale);

}  // namespace robot_tissue
