#include "robot_tissue/core/mesh_checks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text_of.h"
#include "geometry/connected_triangles.h"
#include "geometry/exact_points.h"
#include "geometry/tuning.h"

namespace robot_tissue {
namespace {

struct Edge {
  int low = 0;  // vertices
  int high = 0;
  bool upwards = true;  // the triangle runs along it from low to high

  bool joinsAs(const Edge& other) const { return low == other.low && high == other.high; }
  bool operator<(const Edge& other) const {
    return std::make_pair(low, high) < std::make_pair(other.low, other.high);
  }
};

// Those that stand for the same pair of vertices come one after the other.
std::vector<Edge> sortedEdges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  for (const MeshTriangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = t[i];
      const int to = t[(i + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::optional<std::string> edgeFault(const TriangleMesh& mesh) {
  const std::vector<Edge> edges = sortedEdges(mesh);
  int open = 0;
  int turned = 0;
  Vec3 open_place = Vec3::Zero();
  Vec3 turned_place = Vec3::Zero();
  for (auto first = edges.begin(); first != edges.end();) {
    const auto end =
        std::find_if(first, edges.end(), [&](const Edge& edge) { return !edge.joinsAs(*first); });
    const Vec3 middle = 0.5 * (mesh.vertices[at(first->low)] + mesh.vertices[at(first->high)]);
    if (end - first != 2) {
      if (open++ == 0) open_place = middle;
    } else if (first->upwards == (first + 1)->upwards) {
      if (turned++ == 0) turned_place = middle;
    }
    first = end;
  }
  if (open > 0) {
    return "is not closed: " + std::to_string(open) +
           " edges with one triangle or more than two, one of them at " + textOf(open_place) + " m";
  }
  if (turned > 0) {
    return "has " + std::to_string(turned) +
           " edges whose two triangles face opposite sides, one of them at " +
           textOf(turned_place) + " m";
  }
  return std::nullopt;
}

std::vector<std::vector<MeshTriangle>> shellsOf(const TriangleMesh& mesh) {
  std::vector<int> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<std::vector<MeshTriangle>> shells;
  for (const auto& list : connectedTriangles(mesh.triangles, all, mesh.vertices.size())) {
    shells.emplace_back();
    for (const int triangle : list) shells.back().push_back(mesh.triangles[at(triangle)]);
  }
  return shells;
}

bool isFlat(const TriangleMesh& mesh) {
  const Box box = boundsOf(mesh.vertices);
  const Vec3 extent = box.max() - box.min();
  const double smallest = tuning::kFlatShare * std::pow(extent.maxCoeff(), 3);
  if (!(extent.prod() > smallest)) return true;
  double volume = 0.0;
  for (const auto& shell : shellsOf(mesh)) volume += std::abs(enclosedVolume(mesh.vertices, shell));
  return !(volume > smallest);
}

// On which side of the line from a to b the point p is, seen from above, with p moved by (e, e^2,
// 0) for an e > 0 nearer to zero than any number: never on the line, so that a ray up from p meets
// no edge (simulation of simplicity, Edelsbrunner and Muecke 1990).
int turnAround(const ExactPoint& a, const ExactPoint& b, const ExactPoint& p) {
  const int exact = turn(a, b, p, 0, 1);
  if (exact != 0) return exact;
  if (a[1] != b[1]) return a[1] > b[1] ? 1 : -1;
  return b[0] > a[0] ? 1 : b[0] < a[0] ? -1 : 0;
}

// Counts the triangles over the point, which is on none of them.
bool isInside(const ExactPoint& point, const std::vector<ExactPoint>& points,
              const std::vector<MeshTriangle>& shell) {
  bool inside = false;
  for (const MeshTriangle& t : shell) {
    const ExactPoint& a = points[at(t[0])];
    const ExactPoint& b = points[at(t[1])];
    const ExactPoint& c = points[at(t[2])];
    const int facing = turnAround(a, b, point);
    if (facing == 0 || turnAround(b, c, point) != facing || turnAround(c, a, point) != facing) {
      continue;
    }
    if (side(a, b, c, point) == -facing) inside = !inside;
  }
  return inside;
}

}  // namespace

std::optional<std::string> meshFault(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return "has no triangles";
  for (const Vec3& vertex : mesh.vertices) {
    if (!vertex.allFinite()) return "has a vertex that is not finite";
  }
  // Before anything else, as the corners of the two sides of a flat mesh are one.
  if (isFlat(mesh)) return "has no volume";
  if (auto fault = edgeFault(mesh)) return fault;
  const auto pairs = intersectingTriangles(mesh);
  if (pairs.empty()) return std::nullopt;
  const MeshTriangle& t = mesh.triangles[at(pairs.front().first)];
  const Vec3 middle =
      (mesh.vertices[at(t[0])] + mesh.vertices[at(t[1])] + mesh.vertices[at(t[2])]) / 3.0;
  return "intersects itself: " + std::to_string(pairs.size()) +
         " pairs of triangles, one of them at " + textOf(middle) + " m";
}

TriangleMesh facingOutward(TriangleMesh mesh) {
  std::vector<std::vector<MeshTriangle>> shells = shellsOf(mesh);
  const std::vector<ExactPoint> points = exactPoints(mesh.vertices);
  std::vector<bool> in_cavity(shells.size(), false);
  for (std::size_t i = 0; i < shells.size(); ++i) {
    for (std::size_t j = 0; j < shells.size(); ++j) {
      if (i == j || !isInside(points[at(shells[i].front()[0])], points, shells[j])) continue;
      in_cavity[i] = !in_cavity[i];
    }
  }
  mesh.triangles.clear();
  for (std::size_t i = 0; i < shells.size(); ++i) {
    const bool faces_out = enclosedVolume(mesh.vertices, shells[i]) > 0.0;
    for (MeshTriangle& t : shells[i]) {
      if (faces_out == in_cavity[i]) std::swap(t[1], t[2]);
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

}  // namespace robot_tissue
