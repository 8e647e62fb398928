// How thick a mesh is, all over its surface (own).
#pragma once

#include <vector>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

struct WallSample {
  double thickness = 0.0;      // m: straight in to the next face
  Vec3 normal = Vec3::Zero();  // unit, outwards
  double area = 0.0;           // m^2, that it stands for
};

// Of some hundred triangles. None of edges that run out, where the next face is not nearly
// parallel: a body ends there, and no wall bends. The mesh is without fault and faces outwards.
std::vector<WallSample> wallSamples(const TriangleMesh& mesh);

}  // namespace robot_tissue
