// The displayed surface: triangles over the lattice, closed, also along cuts (own).
#pragma once

#include <cstdint>
#include <vector>

#include "robot_tissue/core/carriers.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A vertex follows the nodes it hangs on: x = rest + sum of weight * displacement of node.
struct TissueSurface {
  std::vector<Vec3> rest;               // tissue frame (m)
  CarrierLists carriers;                // per vertex, weights sum to 1
  std::vector<int> node;                // per vertex: the lattice's node it stands at or, along a
                                        // cut, beside; -1 = beside several
  std::vector<MeshTriangle> triangles;  // counter-clockwise seen from outside
  std::vector<std::uint8_t> opened;     // per triangle, 1 = face opened by a cut
  // Surfaces with the same number have the same rest and triangles; 0: that is not known.
  std::uint64_t revision = 0;
};

// Sides of the cells that nothing joins to others. A part of a cut cell has of the cell what is
// around its own corners, up to where the blade passed (cutting/cell_division.h), and shows the
// sides of that: the surface encloses the parts' volumes, and its sides along a cut lie on the
// blade and on each other at rest. A vertex is carried as the part's material there, by its
// corners, and by ghosts where it lost them; where the model has none, by the own corners that are
// nearest. Two triangles run along every edge.
TissueSurface extractSurface(const Lattice& lattice, const LatticeState& state);

// Deformed vertices (m, tissue frame) for node displacements (m, from rest). Returns their bounds.
Box deform(const TissueSurface& surface, const std::vector<Vec3>& displacement,
           std::vector<Vec3>& vertices);

// What carries the point: nodes ascending, weights not zero.
std::vector<NodeWeight> carriersAt(const TissueSurface& surface, const SurfacePoint& point);

// The vertex that the point is; -1 when it is none.
int vertexAt(const TissueSurface& surface, const SurfacePoint& point);

// Volume inside closed triangles (m^3), by the divergence theorem.
double enclosedVolume(const TissueSurface& surface, const std::vector<Vec3>& vertices);

}  // namespace robot_tissue
