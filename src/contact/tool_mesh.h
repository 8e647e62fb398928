// A closed triangle mesh that touches as it is, concave parts too.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"
#include "signed_distance.h"
#include "triangle_bvh.h"

namespace robot_tissue {

class ToolMesh {
 public:
  struct Edge {
    std::array<int, 2> ends;      // vertices, ascending
    std::array<int, 2> opposite;  // of its two triangles
  };

  // A face's end where the mesh folds outwards.
  struct SharpEdge {
    std::array<Vec3, 2> ends;
    Vec3 normal;   // of the face; unit
    Vec3 outward;  // in the face, across the edge; unit
  };

  // `owner` begins the message. Throws InputError: a mesh that cannot be loaded, that is not closed
  // or has no volume. One that intersects itself is warned of.
  ToolMesh(const std::string& resource, const Vec3& scale, const std::string& owner,
           std::vector<std::string>& warnings);

  // Nothing when the point is outside and farther than `reach` (m).
  std::optional<SignedDistance> distance(const Vec3& point, double reach,
                                         double bound = kInfinity) const;
  // Of a point that the surface is known to be within `bound` (m) of.
  SignedDistance distanceWithin(const Vec3& point, double bound) const;

  const std::vector<Vec3>& vertices() const { return mesh_.vertices; }
  const std::vector<MeshTriangle>& triangles() const { return mesh_.triangles; }
  const std::vector<Edge>& edges() const { return edges_; }
  // Whether the mesh folds inwards there.
  bool isConcave(int edge) const { return is_concave_[at(edge)] != 0; }
  // Of each triangle, as numbers of edges(): the one from its corner k to the next is the k-th.
  const std::vector<std::array<int, 3>>& edgesOfTriangles() const { return edges_of_triangles_; }
  // Vertices joined by an edge with each vertex.
  const std::vector<std::vector<int>>& neighbors() const { return neighbors_; }
  // Twice, once for each of its two faces.
  const std::vector<SharpEdge>& sharpEdges() const { return sharp_edges_; }
  // Whether a face ends at that one of them as far as a length can feel (m): the face is not much
  // narrower, and the mesh still turns away so far beyond. Kept for one length.
  bool isFelt(std::size_t sharp_edge, double length) const;
  // Mean of the normals around a vertex, weighted by their angles; unit.
  const std::vector<Vec3>& vertexNormals() const { return vertex_normals_; }
  const TriangleBvh& tree() const { return tree_; }
  const Box& bounds() const { return bounds_; }
  // Smallest width over the directions of some hundred faces (m).
  double thickness() const { return thickness_; }
  Corners corners(int triangle) const;

 private:
  void findEdges();
  void findNormals();
  void findConcaveEdges();
  void findSharpEdges();
  void addSharpEdge(std::size_t edge, int face, int beyond);
  void measureThickness();
  SignedDistance signedBy(const Vec3& point, const TriangleBvh::Nearest& nearest) const;
  bool isInside(const Vec3& point, const TriangleBvh::Nearest& nearest) const;
  bool endsFace(const SharpEdge& edge, double length) const;

  bool crosses_itself_ = false;
  TriangleMesh mesh_;  // frame of the shape (m), facing outwards
  TriangleBvh tree_;
  Box bounds_;
  std::vector<Edge> edges_;
  std::vector<std::array<int, 3>> edges_of_triangles_;
  std::vector<std::uint8_t> is_concave_;  // per edge
  std::vector<SharpEdge> sharp_edges_;
  std::vector<std::vector<int>> neighbors_;
  std::vector<Vec3> normals_;  // of the triangles, unit; zero without area
  std::vector<Vec3> vertex_normals_;
  std::vector<Vec3> edge_normals_;  // sums of the two triangles'
  double thickness_ = 0.0;
  struct Felt {
    double length = 0.0;
    std::vector<std::optional<bool>> edges;  // as sharp_edges_; those that were asked for
  };
  mutable Felt felt_;
};

}  // namespace robot_tissue
