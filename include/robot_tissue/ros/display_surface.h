// The surface as it is drawn. rviz shades every triangle flat, so where the surface bends it is
// drawn finer than the lattice: as curved PN triangles (Vlachos et al. 2001), cubics through the
// vertices, square to the vertices' normals. It is the surface that tools touch (curved_surface.h)
// but beside creases: there normals are those of one side of the crease, from edge to edge, where
// tools meet those of all triangles that no sharp edge parts from the touched one. ~surface has the
// flat triangles.
//
// Creases stay sharp: edges that are sharp at rest, as a block's, and edges between skin and what a
// cut opened. Along a crease the cubic follows the line in which the tangent planes of its two
// sides meet, the same from both sides; so no edge gapes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "robot_tissue/core/surface.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Three entries a triangle, counter-clockwise seen from outside.
struct DrawnTriangles {
  std::vector<Vec3> points;    // m, tissue frame
  std::vector<Vec3> normals;   // unit, of the smooth surface; only where asked for
  std::vector<double> values;  // of the vertices, linear in between; only where there are some
};

class DisplaySurface {
 public:
  // What hangs on the topology alone: to be called where the surface has another revision.
  void bind(const TissueSurface& surface);
  // The shape: deformed vertices (m, tissue frame), one for each of the surface's.
  void fit(const std::vector<Vec3>& vertices);

  // Adds the triangles that a cut opened, or the others; at most tuning::kMostDrawn, or as many as
  // the surface itself has. With `values`, one a vertex, also normals and values.
  void draw(bool opened, const std::vector<double>* values, DrawnTriangles& drawn) const;
  // The edge between two nodes of the lattice; -1: the surface has none there.
  int edgeBetween(int node_a, int node_b) const;
  // Adds its line as it is drawn, in segments of two points each.
  void drawEdge(int edge, std::vector<Vec3>& ends) const;
  // The same of all edges between skin and what a cut opened: they show a wound that is shut.
  void drawLips(std::vector<Vec3>& ends) const;

 private:
  struct Edge {
    int a = 0, b = 0;                   // vertices, a < b
    std::array<int, 2> at_a{}, at_b{};  // normals of its sides there, the same but for creases
  };
  // Of an edge in this shape: inner control points of its cubic, and in how many pieces it is
  // drawn.
  struct Curve {
    Vec3 from_a, from_b;
    int pieces = 1;
  };

  // A side of an edge: from corner `corner` of the triangle to the next, or back.
  struct Side {
    int low = 0, high = 0;  // vertices
    int triangle = 0, corner = 0;
  };

  std::vector<Side> findEdges();
  void findNormals(const TissueSurface& surface, const std::vector<Side>& sides);
  void findNodes(const TissueSurface& surface);
  void fitNormals();
  Vec3 controlPoint(int vertex, int other, const std::array<int, 2>& normals) const;
  Curve curveOf(const Edge& edge) const;
  void limitPieces();
  int piecesOf(std::size_t triangle) const;
  // From the triangle's corner towards the next: how many quarters of the way.
  Vec3 edgePoint(std::size_t triangle, std::size_t corner, int quarters) const;
  // Of the cubic, by weights of the corners, in quarters.
  Vec3 innerPoint(std::size_t triangle, const std::array<int, 3>& quarters) const;
  Vec3 pointAt(std::size_t triangle, const std::array<int, 3>& quarters) const;
  Vec3 normalAt(std::size_t triangle, const std::array<int, 3>& quarters) const;

  std::vector<MeshTriangle> triangles_;
  std::vector<std::uint8_t> opened_;
  std::vector<Vec3> corner_weights_;  // per triangle, in the normals of its corners (m^-2)
  std::vector<Edge> edges_;
  std::vector<std::array<int, 3>> edge_of_;              // per triangle: from corner k to the next
  std::vector<std::array<int, 3>> normal_of_;            // per triangle and corner
  std::vector<int> lips_;                                // edges
  std::unordered_map<std::uint64_t, int> edge_between_;  // by nodes of the lattice

  std::vector<Vec3> vertices_;
  std::vector<Vec3> normals_;  // unit, or zero
  std::vector<Curve> curves_;  // per edge
};

}  // namespace robot_tissue
