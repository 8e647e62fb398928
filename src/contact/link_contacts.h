// Contacts of one link with the deformed surface.
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "known_minima.h"
#include "mesh_seeds.h"
#include "placed_link.h"
#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/sparse_values.h"
#include "robot_tissue/core/surface.h"
#include "surface_traversal.h"
#include "triangle_minimum.h"

namespace robot_tissue {

class LinkContacts {
 public:
  // Adds the contacts with depth > -margin of a link to `found`; tool and link are written into
  // them. Keeps its arrays from call to call, to spare allocations.
  struct Asked {
    const PlacedLink& link;
    int tool_index, link_index;
    const std::vector<int>& triangles;           // that may touch it, ascending
    const std::vector<const FacePairs*>& faces;  // per shape; of meshes near the surface, else null
    std::vector<KnownMinima>* known;             // per shape; null: all are looked for anew
    double margin;                               // m
  };
  void find(const Asked& asked, const TissueSurface& surface, const std::vector<Vec3>& vertices,
            ContactSet& found);

 private:
  // A vertex in a shape's frame and its distance, asked for once a search; they are of few
  // vertices.
  struct Seen {
    bool is_near = false;  // of a mesh: not farther than the margin; else always
    Vec3 point = Vec3::Zero();
    SignedDistance distance;
  };

  void forgetVertices();
  void askTriangle(int triangle, ContactSet& found);
  void askVertex(int vertex, const Vec3& weights, ContactSet& found);
  void askShape(std::size_t shape, const MeshTriangle& triangle, ContactSet& found);
  const Seen& seen(std::size_t shape, int vertex);        // until the next call
  Corners cornersOf(const MeshTriangle& triangle) const;  // tissue frame (m)
  std::vector<TriangleMinimum> minimaOf(std::size_t shape, const MeshTriangle& triangle);
  std::vector<TriangleMinimum> minimaInMesh(std::size_t shape, const MeshTriangle& triangle,
                                            const Corners& corners, double accuracy);
  bool isVertexAlready(const TriangleMinimum& minimum, std::size_t shape,
                       const MeshTriangle& triangle, double accuracy);
  bool isOnKnownEdge(const Vec3& weights, std::size_t shape, const MeshTriangle& triangle);
  void add(std::size_t shape, const Vec3& weights, double depth, const Vec3& normal,
           ContactSet& found);

  const PlacedLink* link_ = nullptr;
  const std::vector<const FacePairs*>* faces_ = nullptr;
  std::vector<KnownMinima>* known_ = nullptr;
  const TissueSurface* surface_ = nullptr;
  const std::vector<Vec3>* vertices_ = nullptr;
  double margin_ = 0.0;  // m
  int tool_ = 0;
  int link_index_ = 0;
  int triangle_ = 0;

  Box box_;                               // around the link and the margin (m)
  SparseValues<bool> asked_;              // vertices whose contacts were told
  std::vector<SparseValues<Seen>> seen_;  // per shape, of vertices
  std::vector<int> near_faces_;
  MeshSeeds seeds_;
  struct EdgePlace {
    std::size_t shape;
    double along;  // share of the edge
  };
  std::map<std::pair<int, int>, std::vector<EdgePlace>> edge_places_;
};

}  // namespace robot_tissue
