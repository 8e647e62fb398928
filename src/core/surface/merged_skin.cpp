#include "surface/merged_skin.h"

#include <algorithm>

#include "geometry/polygon_triangles.h"

namespace robot_tissue {
namespace {

// Fullness (1) of triangles that are no worse for being thinner than others. More: fewer vertices
// go; less: thinner triangles. Chosen.
constexpr double kFull = 0.05;
// A vertex with more triangles around it stays, as the work goes with the cube. Chosen.
constexpr std::size_t kMostAround = 24;
// What one vertex leaves may let the next one go: more than a few rounds gain little. Chosen.
constexpr int kMostRounds = 4;

std::size_t cornerAt(const MeshTriangle& triangle, int vertex) {
  return static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), vertex) -
                                  triangle.begin());
}

class SkinMerger {
 public:
  SkinMerger(const TissueSurface& surface, const std::vector<int>& mesh_triangles)
      : surface_(surface),
        triangles_(surface.triangles),
        mesh_triangles_(mesh_triangles),
        is_left_(triangles_.size(), 1),
        around_(surface.rest.size()) {
    for (std::size_t triangle = 0; triangle < triangles_.size(); ++triangle) {
      for (const int corner : triangles_[triangle]) {
        around_[at(corner)].push_back(static_cast<int>(triangle));
      }
    }
  }

  void removeAllBut(const std::vector<char>& is_of_mesh) {
    bool any = true;
    for (int round = 0; any && round < kMostRounds; ++round) {
      any = false;
      for (std::size_t vertex = 0; vertex < is_of_mesh.size(); ++vertex) {
        if (is_of_mesh[vertex] == 0) any = remove(static_cast<int>(vertex)) || any;
      }
    }
  }

  TissueSurface left() const {
    TissueSurface left;
    std::vector<int> number(surface_.rest.size(), -1);
    for (std::size_t triangle = 0; triangle < triangles_.size(); ++triangle) {
      if (is_left_[triangle] == 0) continue;
      MeshTriangle corners = triangles_[triangle];
      for (int& corner : corners) {
        int& known = number[at(corner)];
        if (known < 0) {
          known = static_cast<int>(left.rest.size());
          left.rest.push_back(surface_.rest[at(corner)]);
          left.carriers.push_back(surface_.carriers[at(corner)]);
          left.node.push_back(surface_.node[at(corner)]);
        }
        corner = known;
      }
      left.triangles.push_back(corners);
      left.opened.push_back(mesh_triangles_[triangle] < 0 ? 1 : 0);
    }
    return left;
  }

 private:
  // Around a vertex, in order: the edge from one corner to the next is of this part of the mesh.
  struct Edge {
    int from = 0, to = 0;
    int mesh_triangle = 0;
  };
  struct Part {
    std::vector<int> outline;
    int mesh_triangle = 0;
  };

  // False: it stays.
  bool remove(int vertex) {
    const std::vector<int> star = around_[at(vertex)];
    const std::vector<Part> parts = partsAround(ringOf(vertex, star));
    std::vector<MeshTriangle> fill;
    std::vector<int> of_mesh;
    double thinnest = kFull;
    for (const int triangle : star)
      thinnest = std::min(thinnest, fullnessOf(triangles_[at(triangle)]));
    for (const Part& part : parts) {
      const PolygonTriangles found = filled(part.outline);
      if (found.triangles.empty() || found.thinnest < thinnest) return false;
      for (const MeshTriangle& each : found.triangles) {
        fill.push_back(
            {part.outline[at(each[0])], part.outline[at(each[1])], part.outline[at(each[2])]});
        of_mesh.push_back(part.mesh_triangle);
      }
    }
    if (fill.empty() || makesEdgesTwice(fill, star)) return false;
    replace(star, fill, of_mesh);
    return true;
  }

  // Empty: none that goes round once, or a cut opened a face of it.
  std::vector<Edge> ringOf(int vertex, const std::vector<int>& star) const {
    std::vector<Edge> edges;
    if (star.size() < 3 || star.size() > kMostAround) return edges;
    for (const int triangle : star) {
      const int mesh_triangle = mesh_triangles_[at(triangle)];
      if (mesh_triangle < 0) return {};
      const MeshTriangle& corners = triangles_[at(triangle)];
      const std::size_t tip = cornerAt(corners, vertex);
      edges.push_back({corners[(tip + 1) % 3], corners[(tip + 2) % 3], mesh_triangle});
    }
    for (std::size_t i = 1; i < edges.size(); ++i) {
      const auto next =
          std::find_if(edges.begin() + static_cast<std::ptrdiff_t>(i), edges.end(),
                       [&](const Edge& edge) { return edge.from == edges[i - 1].to; });
      if (next == edges.end() || next->from == edges.front().from) return {};
      std::swap(edges[i], *next);
    }
    return edges.back().to == edges.front().from ? edges : std::vector<Edge>();
  }

  // One, or two on both sides of an edge of the mesh; none: more meet there.
  static std::vector<Part> partsAround(std::vector<Edge> ring) {
    if (ring.empty()) return {};
    const auto is_of_first = [&](const Edge& edge) {
      return edge.mesh_triangle == ring.front().mesh_triangle;
    };
    const auto other = std::find_if_not(ring.begin(), ring.end(), is_of_first);
    if (other == ring.end()) return {partOf(ring.begin(), ring.end(), false)};
    std::rotate(ring.begin(), other, ring.end());
    const auto second = std::find_if_not(ring.begin(), ring.end(), is_of_first);
    if (!std::all_of(second, ring.end(), [&](const Edge& edge) {
          return edge.mesh_triangle == second->mesh_triangle;
        })) {
      return {};
    }
    return {partOf(ring.begin(), second, true), partOf(second, ring.end(), true)};
  }

  // Of some of the ring's edges, closed from the last one's end.
  static Part partOf(std::vector<Edge>::const_iterator first,
                     std::vector<Edge>::const_iterator last, bool with_end) {
    Part part;
    part.mesh_triangle = first->mesh_triangle;
    for (auto edge = first; edge != last; ++edge) part.outline.push_back(edge->from);
    if (with_end) part.outline.push_back(std::prev(last)->to);
    return part;
  }

  PolygonTriangles filled(const std::vector<int>& outline) const {
    std::vector<Vec3> corners;
    for (const int vertex : outline) corners.push_back(surface_.rest[at(vertex)]);
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      area += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    }
    return polygonTriangles(corners, area);
  }

  double fullnessOf(const MeshTriangle& triangle) const {
    return fullness(surface_.rest[at(triangle[0])], surface_.rest[at(triangle[1])],
                    surface_.rest[at(triangle[2])]);
  }

  // An edge that other triangles than those of the star have already, both ways.
  bool makesEdgesTwice(const std::vector<MeshTriangle>& fill, const std::vector<int>& star) const {
    for (const MeshTriangle& each : fill) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (isRunAlong(each[i], each[(i + 1) % 3], star)) return true;
      }
    }
    return false;
  }

  // From one vertex to the other, by a triangle that is not of the star.
  bool isRunAlong(int from, int to, const std::vector<int>& star) const {
    const std::vector<int>& around = around_[at(from)];
    return std::any_of(around.begin(), around.end(), [&](int triangle) {
      const MeshTriangle& corners = triangles_[at(triangle)];
      const std::size_t start = cornerAt(corners, from);
      return corners[(start + 1) % 3] == to &&
             std::find(star.begin(), star.end(), triangle) == star.end();
    });
  }

  void replace(const std::vector<int>& star, const std::vector<MeshTriangle>& fill,
               const std::vector<int>& of_mesh) {
    for (const int triangle : star) {
      is_left_[at(triangle)] = 0;
      for (const int corner : triangles_[at(triangle)]) {
        std::vector<int>& around = around_[at(corner)];
        around.erase(std::find(around.begin(), around.end(), triangle));
      }
    }
    for (std::size_t i = 0; i < fill.size(); ++i) {
      const std::size_t triangle = at(star[i]);
      triangles_[triangle] = fill[i];
      mesh_triangles_[triangle] = of_mesh[i];
      is_left_[triangle] = 1;
      for (const int corner : fill[i]) around_[at(corner)].push_back(star[i]);
    }
  }

  const TissueSurface& surface_;
  std::vector<MeshTriangle> triangles_;
  std::vector<int> mesh_triangles_;
  std::vector<char> is_left_;             // per triangle
  std::vector<std::vector<int>> around_;  // per vertex, triangles
};

}  // namespace

TissueSurface mergedSkin(const TissueSurface& surface, const std::vector<int>& mesh_triangles,
                         const std::vector<char>& is_of_mesh) {
  SkinMerger merger(surface, mesh_triangles);
  merger.removeAllBut(is_of_mesh);
  return merger.left();
}

}  // namespace robot_tissue
