#include "mesh_seeds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "robot_tissue/core/disjoint_sets.h"
#include "triangle_minimum.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// The part of a segment in the plane that is on the triangle, by weights of its ends.
std::optional<std::array<Vec3, 2>> onTriangle(const Vec3& from, const Vec3& to) {
  double first = 0.0;
  double last = 1.0;
  for (int k = 0; k < 3; ++k) {
    if (from[k] < 0.0 && to[k] < 0.0) return std::nullopt;
    const double crossing = from[k] / (from[k] - to[k]);
    if (from[k] < 0.0) first = std::max(first, crossing);
    if (to[k] < 0.0) last = std::min(last, crossing);
  }
  if (!(first <= last)) return std::nullopt;
  return std::array<Vec3, 2>{from + first * (to - from), from + last * (to - from)};
}

std::optional<Slit> slitOf(int face, const ToolMesh& mesh, const Corners& corners,
                           const TrianglePlane& plane, const std::array<double, 3>& heights) {
  const bool is_below = heights[0] < 0.0;
  if ((heights[1] < 0.0) == is_below && (heights[2] < 0.0) == is_below) return std::nullopt;
  const Corners face_corners = mesh.corners(face);
  std::array<Vec3, 2> ends;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if ((heights[k] < 0.0) == (heights[next] < 0.0)) continue;
    const double t = heights[k] / (heights[k] - heights[next]);
    ends[count++] = plane.weights(face_corners[k] + t * (face_corners[next] - face_corners[k]));
  }
  const auto cut = onTriangle(ends[0], ends[1]);
  if (!cut) return std::nullopt;
  const auto& [from, to] = *cut;
  return Slit{face, 0.5 * (from + to), (pointOf(corners, to) - pointOf(corners, from)).norm()};
}

// Per slit the number of the connected line in which the mesh cuts the triangle: slits, of one face
// each, whose faces share an edge are of one line.
std::vector<std::size_t> connectedParts(const std::vector<Slit>& slits, const ToolMesh& mesh) {
  std::vector<std::pair<int, std::size_t>> slits_of_edges;
  for (std::size_t i = 0; i < slits.size(); ++i) {
    for (const int edge : mesh.edgesOfTriangles()[at(slits[i].face)]) {
      slits_of_edges.emplace_back(edge, i);
    }
  }
  std::sort(slits_of_edges.begin(), slits_of_edges.end());
  DisjointSets sets(slits.size());
  for (std::size_t i = 1; i < slits_of_edges.size(); ++i) {
    if (slits_of_edges[i].first != slits_of_edges[i - 1].first) continue;
    sets.join(static_cast<int>(slits_of_edges[i].second),
              static_cast<int>(slits_of_edges[i - 1].second));
  }
  std::vector<std::size_t> part;
  for (std::size_t i = 0; i < slits.size(); ++i) {
    part.push_back(at(sets.lowest(static_cast<int>(i))));
  }
  return part;
}

Vec3 farthestFrom(const Vec3& place, const std::vector<Slit>& slits,
                  const std::vector<std::size_t>& part, std::size_t number,
                  const Corners& corners) {
  Vec3 farthest = place;
  double most = -1.0;
  for (std::size_t i = 0; i < slits.size(); ++i) {
    const double away = (pointOf(corners, slits[i].middle) - pointOf(corners, place)).norm();
    if (part[i] != number || away <= most) continue;
    most = away;
    farthest = slits[i].middle;
  }
  return farthest;
}

// Of each connected part: its middle, and two places at its ends.
void seedsOfSlits(const std::vector<Slit>& slits, const ToolMesh& mesh, const Corners& corners,
                  std::vector<Vec3>& seeds) {
  const std::vector<std::size_t> part = connectedParts(slits, mesh);
  for (std::size_t number = 0; number < slits.size(); ++number) {
    if (part[number] != number) continue;
    Vec3 sum = Vec3::Zero();
    double length = 0.0;
    const double least = tuning::kAtOnePoint * longestEdge(corners);
    for (std::size_t i = number; i < slits.size(); ++i) {
      if (part[i] != number) continue;
      sum += (slits[i].length + least) * slits[i].middle;
      length += slits[i].length + least;
    }
    const Vec3 middle = sum / length;
    const Vec3 end = farthestFrom(middle, slits, part, number, corners);
    for (const Vec3& seed : {middle, end, farthestFrom(end, slits, part, number, corners)}) {
      seeds.push_back(seed);
    }
  }
}

// Whether a step from `place` towards `other` leads, at first, not nearer to the point that is the
// vector `away` from `place`.
bool leadsAway(const Vec3& place, const Vec3& other, const Vec3& away) {
  const Vec3 way = other - place;
  const double nearer = way.dot(away);
  if (nearer <= 0.0) return true;
  const double product = way.squaredNorm() * away.squaredNorm();
  // Most lead so clearly nearer that no roots need be taken.
  if (nearer * nearer > 4.0 * tuning::kSquare * tuning::kSquare * product) return false;
  return nearer <= tuning::kSquare * way.norm() * away.norm();
}

// Nearest points of vertices whose neighbors are all farther from the triangle; corners of the
// triangle are asked in any case.
void seedsUnderVertices(const std::vector<int>& faces, const ToolMesh& mesh, SeenVertices& seen,
                        Firsts& vertices, double reach, const Corners& corners,
                        std::vector<Vec3>& seeds) {
  vertices.begin(mesh.vertices().size());
  for (const int face : faces) {
    for (const int vertex : mesh.triangles()[at(face)]) vertices.add(vertex);
  }
  for (const int number : vertices.all()) {
    const Vec3& vertex = mesh.vertices()[at(number)];
    if ((seen[number].sides & (kAbove | kBelow)) != 0U) continue;
    const Vec3 weights = nearestInTriangle(vertex, corners);
    const Vec3 away = pointOf(corners, weights) - vertex;
    if (weights.maxCoeff() == 1.0 || away.norm() > reach) continue;
    const auto& around = mesh.neighbors()[at(number)];
    if (std::all_of(around.begin(), around.end(), [&](int other) {
          return leadsAway(vertex, mesh.vertices()[at(other)], away);
        })) {
      seeds.push_back(weights);
    }
  }
}

// The nearest points of segments a-b and c-d, as shares of the way from a to b and from c to d, by
// the normal equations of |a + s (b - a) - c - t (d - c)|^2; nothing when one is an end, or the
// segments are parallel.
std::optional<std::array<double, 2>> nearestWithin(const Vec3& a, const Vec3& b, const Vec3& c,
                                                   const Vec3& d) {
  const Vec3 ab = b - a, cd = d - c, ac = c - a;
  const double uu = ab.squaredNorm(), uv = ab.dot(cd), vv = cd.squaredNorm();
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > tuning::kSquare * uu * vv)) return std::nullopt;
  const double along_ab = ac.dot(ab) * vv - ac.dot(cd) * uv;
  const double along_cd = ac.dot(ab) * uv - ac.dot(cd) * uu;
  // Most miss each other so clearly that nothing need be divided.
  const double end = determinant * (1.0 + tuning::kBeyondRounding);
  if (along_ab < 0.0 || along_ab > end || along_cd < 0.0 || along_cd > end) return std::nullopt;
  const double u = along_ab / determinant, v = along_cd / determinant;
  if (u < 0.0 || u > 1.0 || v < 0.0 || v > 1.0) return std::nullopt;
  return std::array<double, 2>{u, v};
}

// Places on the triangle's edges that are nearest to an edge of the mesh: local least distances, as
// on the triangle and on the mesh's faces beside the edge every way leads apart.
void seedsBesideEdges(const std::vector<int>& faces, const ToolMesh& mesh, SeenVertices& seen,
                      Firsts& edges, double reach, const Corners& corners,
                      std::vector<Vec3>& seeds) {
  edges.begin(mesh.edges().size());
  for (const int face : faces) {
    for (const int edge : mesh.edgesOfTriangles()[at(face)]) edges.add(edge);
  }
  for (const int number : edges.all()) {
    const ToolMesh::Edge& edge = mesh.edges()[at(number)];
    const unsigned sides = seen[edge.ends[0]].sides & seen[edge.ends[1]].sides;
    if ((sides & (kAbove | kBelow)) != 0U) continue;
    const Vec3& from = mesh.vertices()[at(edge.ends[0])];
    const Vec3& to = mesh.vertices()[at(edge.ends[1])];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if ((sides & (beyondEdge(k) | insideEdge(k) | beforeEdge(k) | afterEdge(k))) != 0U) continue;
      const auto shares = nearestWithin(corners[k], corners[next], from, to);
      if (!shares) continue;
      const Vec3 place = corners[k] + (*shares)[0] * (corners[next] - corners[k]);
      const Vec3 beside = from + (*shares)[1] * (to - from);
      const Vec3 away = place - beside;
      if (away.norm() > reach || !leadsAway(place, corners[(k + 2) % 3], -away) ||
          !leadsAway(beside, mesh.vertices()[at(edge.opposite[0])], away) ||
          !leadsAway(beside, mesh.vertices()[at(edge.opposite[1])], away)) {
        continue;
      }
      Vec3 weights = Vec3::Zero();
      weights[static_cast<int>(next)] = (*shares)[0];
      weights[static_cast<int>(k)] = 1.0 - (*shares)[0];
      seeds.push_back(weights);
    }
  }
}

}  // namespace

// Whether the faces hang together by their edges, none of which folds inwards.
bool MeshSeeds::areConvex(const ToolMesh& mesh, const std::vector<int>& faces) {
  for (const int face : faces) {
    for (const int edge : mesh.edgesOfTriangles()[at(face)]) {
      if (mesh.isConcave(edge)) return false;
    }
  }
  DisjointSets parts(faces.size());
  face_at_edge_.resize(std::max(face_at_edge_.size(), mesh.edges().size()), -1);
  std::size_t joins = 0;
  for (int i = 0; i < static_cast<int>(faces.size()); ++i) {
    for (const int edge : mesh.edgesOfTriangles()[at(faces[at(i)])]) {
      const int other = std::exchange(face_at_edge_[at(edge)], i);
      if (other < 0 || parts.lowest(other) == parts.lowest(i)) continue;
      parts.join(other, i);
      ++joins;
    }
  }
  for (const int face : faces) {
    for (const int edge : mesh.edgesOfTriangles()[at(face)]) face_at_edge_[at(edge)] = -1;
  }
  return joins + 1 == faces.size();
}

const std::vector<Vec3>& MeshSeeds::on(const Corners& corners, const ToolMesh& mesh,
                                       const std::vector<int>& faces, double reach) {
  seeds_.clear();
  if (areConvex(mesh, faces)) {
    seeds_.push_back(Vec3::Constant(1.0 / 3.0));
    return seeds_;
  }
  const TrianglePlane plane(corners);
  seen_.begin(mesh, plane, reach);
  slits_.clear();
  near_.clear();
  for (const int face : faces) {
    const MeshTriangle& ends = mesh.triangles()[at(face)];
    const SeenFrom &a = seen_[ends[0]], &b = seen_[ends[1]], &c = seen_[ends[2]];
    if ((a.sides & b.sides & c.sides & (kAbove | kBelow | kBeyondAny)) != 0U) continue;
    near_.push_back(face);
    const auto slit = slitOf(face, mesh, corners, plane, {a.height, b.height, c.height});
    if (slit) slits_.push_back(*slit);
  }
  seedsOfSlits(slits_, mesh, corners, seeds_);
  if (reach > 0.0) {
    seedsUnderVertices(near_, mesh, seen_, vertices_, reach, corners, seeds_);
    seedsBesideEdges(near_, mesh, seen_, edges_, reach, corners, seeds_);
  }
  seeds_.push_back(Vec3::Constant(1.0 / 3.0));
  return seeds_;
}

}  // namespace robot_tissue
