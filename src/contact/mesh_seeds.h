// Where to begin the search for the places of a triangle that are deepest in a mesh (own).
#pragma once

#include <vector>

#include "tool_mesh.h"
#include "triangle_bvh.h"
#include "triangle_view.h"

namespace robot_tissue {

// Where a face of the mesh cuts the triangle.
struct Slit {
  int face = 0;
  Vec3 middle = Vec3::Zero();  // weights
  double length = 0.0;         // m
};

// Keeps its arrays from call to call, to spare allocations.
class MeshSeeds {
 public:
  // Weights of the corners. Of each connected part of the mesh's surface that cuts the triangle:
  // its middle and two ends. Of what does not cut it but is nearer than `reach` (m): where a vertex
  // is over the triangle, or an edge beside one of its edges, and every way leads apart. And the
  // middle, last; alone where the faces near it are one part that folds outwards only: the distance
  // to that is convex. In: corners of the triangle in the mesh's frame, with area; the faces near
  // it. Until the next call.
  const std::vector<Vec3>& on(const Corners& corners, const ToolMesh& mesh,
                              const std::vector<int>& faces, double reach);

 private:
  bool areConvex(const ToolMesh& mesh, const std::vector<int>& faces);

  SeenVertices seen_;
  Firsts vertices_, edges_;
  std::vector<int> face_at_edge_;  // per edge: place of a face that has it; -1 between calls
  std::vector<Slit> slits_;
  std::vector<int> near_;  // faces
  std::vector<Vec3> seeds_;
};

}  // namespace robot_tissue
