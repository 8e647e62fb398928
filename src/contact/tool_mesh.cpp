#include "tool_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "robot_tissue/core/mesh_checks.h"
#include "robot_tissue/mesh/mesh_file.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Turned outwards as a whole, by its volume's sign. In a surface that crosses itself it cannot be
// known which parts are walls of cavities.
TriangleMesh turnedOutwards(TriangleMesh mesh) {
  if (enclosedVolume(mesh.vertices, mesh.triangles) >= 0.0) return mesh;
  for (MeshTriangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh checkedMesh(const std::string& resource, const Vec3& scale, const std::string& owner,
                         std::vector<std::string>& warnings, bool& crosses_itself) {
  const std::string name = owner + ": mesh '" + resource + "' ";
  try {
    std::string remark;
    TriangleMesh mesh = welded(loadMeshFile(resource, scale, &remark));
    if (!remark.empty()) warnings.push_back(name + remark);
    const auto fault = meshFault(mesh);
    if (!fault) return facingOutward(std::move(mesh));
    if (fault->rfind("intersects itself", 0) != 0) throw InputError(*fault);
    crosses_itself = true;
    warnings.push_back(name + *fault + "; depths near such places are only estimates");
    return turnedOutwards(std::move(mesh));
  } catch (const InputError& error) {
    throw InputError(
        name + error.what() +
        "; allowed is a package:// or file:// address of a closed mesh with volume, in " +
        kMeshFileRule);
  }
}

// So low over its longest side that its normal is rounding, or nearly.
bool isSliver(const Corners& c) {
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, (c[(k + 1) % 3] - c[k]).squaredNorm());
  }
  return (c[1] - c[0]).cross(c[2] - c[0]).norm() < tuning::kSliver * longest;
}

}  // namespace

ToolMesh::ToolMesh(const std::string& resource, const Vec3& scale, const std::string& owner,
                   std::vector<std::string>& warnings)
    : mesh_(checkedMesh(resource, scale, owner, warnings, crosses_itself_)),
      tree_(mesh_.vertices, mesh_.triangles),
      bounds_(tree_.bounds()) {
  findEdges();
  findNormals();
  findConcaveEdges();
  findSharpEdges();
  measureThickness();
}

Corners ToolMesh::corners(int triangle) const {
  const MeshTriangle& t = mesh_.triangles[at(triangle)];
  return {mesh_.vertices[at(t[0])], mesh_.vertices[at(t[1])], mesh_.vertices[at(t[2])]};
}

// The mesh is closed, so that each edge has two triangles.
void ToolMesh::findEdges() {
  std::map<std::pair<int, int>, int> numbers;
  neighbors_.resize(mesh_.vertices.size());
  for (const MeshTriangle& t : mesh_.triangles) {
    std::array<int, 3> own;
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3], opposite = t[(k + 2) % 3];
      const auto [place, is_new] =
          numbers.try_emplace(std::minmax(from, to), static_cast<int>(edges_.size()));
      own[k] = place->second;
      if (is_new) {
        edges_.push_back({{place->first.first, place->first.second}, {opposite, opposite}});
        neighbors_[at(from)].push_back(to);
        neighbors_[at(to)].push_back(from);
      } else {
        edges_[at(own[k])].opposite[1] = opposite;
      }
    }
    edges_of_triangles_.push_back(own);
  }
}

void ToolMesh::findNormals() {
  vertex_normals_.assign(mesh_.vertices.size(), Vec3::Zero());
  for (int triangle = 0; triangle < static_cast<int>(mesh_.triangles.size()); ++triangle) {
    const Corners c = corners(triangle);
    const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]).stableNormalized();
    normals_.push_back(normal);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = c[(k + 1) % 3] - c[k];
      const Vec3 b = c[(k + 2) % 3] - c[k];
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      vertex_normals_[at(mesh_.triangles[at(triangle)][k])] += angle * normal;
    }
  }
  for (Vec3& normal : vertex_normals_) normal = normal.stableNormalized();
  edge_normals_.assign(edges_.size(), Vec3::Zero());
  for (std::size_t triangle = 0; triangle < normals_.size(); ++triangle) {
    for (const int edge : edges_of_triangles_[triangle])
      edge_normals_[at(edge)] += normals_[triangle];
  }
}

// Where the one triangle's vertex is above the other one's plane.
void ToolMesh::findConcaveEdges() {
  is_concave_.assign(edges_.size(), 0);
  const double rounding = tuning::kFlatEdge * (bounds_.max() - bounds_.min()).norm();
  for (std::size_t triangle = 0; triangle < normals_.size(); ++triangle) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int edge = edges_of_triangles_[triangle][k];
      const Vec3& end = mesh_.vertices[at(edges_[at(edge)].ends[0])];
      for (const int opposite : edges_[at(edge)].opposite) {
        const double height = normals_[triangle].dot(mesh_.vertices[at(opposite)] - end);
        if (height > rounding) is_concave_[at(edge)] = 1;
      }
    }
  }
}

void ToolMesh::findSharpEdges() {
  std::vector<std::array<int, 2>> sides(edges_.size(), {-1, -1});
  for (int triangle = 0; triangle < static_cast<int>(normals_.size()); ++triangle) {
    for (const int edge : edges_of_triangles_[at(triangle)]) {
      std::array<int, 2>& of_edge = sides[at(edge)];
      of_edge[of_edge[0] < 0 ? 0 : 1] = triangle;
    }
  }
  for (std::size_t edge = 0; edge < edges_.size(); ++edge) {
    if (sides[edge][1] < 0) continue;
    for (std::size_t side = 0; side < 2; ++side) {
      addSharpEdge(edge, sides[edge][side], sides[edge][1 - side]);
    }
  }
}

// A sliver is no face. Its normal is noise: what is beyond it tells whether a face ends there
// (isFelt).
void ToolMesh::addSharpEdge(std::size_t edge, int face, int beyond) {
  if (isSliver(corners(face))) return;
  const std::array<Vec3, 2> ends = {mesh_.vertices[at(edges_[edge].ends[0])],
                                    mesh_.vertices[at(edges_[edge].ends[1])]};
  const Vec3& normal = normals_[at(face)];
  const Vec3 across = (ends[1] - ends[0]).stableNormalized().cross(normal);
  Vec3 inside = Vec3::Zero();  // of the face's own triangle, to tell a fold outwards
  for (const Vec3& corner : corners(face)) inside += (corner - ends[0]) / 3.0;
  if (isSliver(corners(beyond))) {
    sharp_edges_.push_back({ends, normal, inside.dot(across) < 0.0 ? across : Vec3(-across)});
    return;
  }
  if (normal.dot(normals_[at(beyond)]) > tuning::kSharpEdge) return;
  const Vec3 outward = across.dot(normals_[at(beyond)]) > 0.0 ? across : Vec3(-across);
  if (inside.dot(outward) < 0.0) sharp_edges_.push_back({ends, normal, outward});
}

bool ToolMesh::isFelt(std::size_t sharp_edge, double length) const {
  if (felt_.length != length) felt_ = {length, {}};
  felt_.edges.resize(sharp_edges_.size());
  std::optional<bool>& is_felt = felt_.edges[sharp_edge];
  if (!is_felt) is_felt = endsFace(sharp_edges_[sharp_edge], length);
  return *is_felt;
}

bool ToolMesh::endsFace(const SharpEdge& edge, double length) const {
  const auto off = [this](const Vec3& point) {
    return distance(point, std::numeric_limits<double>::infinity())
        .value_or(SignedDistance{kInfinity, Vec3::Zero()})
        .value;
  };
  const double just = tuning::kJustBeyond * length;
  for (const double along : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
    const Vec3 place = edge.ends[0] + along * (edge.ends[1] - edge.ends[0]);
    const auto turnsAway = [&](double beyond) {
      return off(place + beyond * edge.outward) > tuning::kTurnsAway * beyond;
    };
    const bool is_face = std::abs(off(place - just * edge.outward)) <= tuning::kTurnsAway * just;
    if (is_face && turnsAway(just) && turnsAway(length)) return true;
  }
  return false;
}

void ToolMesh::measureThickness() {
  thickness_ = std::numeric_limits<double>::infinity();
  const std::size_t stride = 1 + normals_.size() / tuning::kWidthDirections;
  for (std::size_t i = 0; i < normals_.size(); i += stride) {
    if (normals_[i].isZero()) continue;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vec3& vertex : mesh_.vertices) {
      const double along = normals_[i].dot(vertex);
      low = std::min(low, along);
      high = std::max(high, along);
    }
    thickness_ = std::min(thickness_, high - low);
  }
}

std::optional<SignedDistance> ToolMesh::distance(const Vec3& point, double reach,
                                                 double bound) const {
  const Box& box = bounds();
  // A point in the mesh's box may be inside, and deeper than the reach: it is looked for at any
  // distance.
  const bool in_box =
      (point.array() >= box.min().array()).all() && (point.array() <= box.max().array()).all();
  const auto nearest = tree_.nearest(point, in_box ? bound : std::min(reach, bound));
  if (!nearest) return std::nullopt;
  const SignedDistance found = signedBy(point, *nearest);
  if (found.value > reach) return std::nullopt;
  return found;
}

SignedDistance ToolMesh::distanceWithin(const Vec3& point, double bound) const {
  const auto nearest = tree_.nearest(point, bound);
  if (nearest) return signedBy(point, *nearest);
  const double infinity = std::numeric_limits<double>::infinity();
  return distance(point, infinity).value_or(SignedDistance{infinity, Vec3::Zero()});
}

SignedDistance ToolMesh::signedBy(const Vec3& point, const TriangleBvh::Nearest& nearest) const {
  SignedDistance found;
  found.value = isInside(point, nearest) ? -nearest.distance : nearest.distance;
  if (nearest.distance <= tuning::kOnSurface) {
    found.slope = normals_[at(nearest.triangle)];
  } else {
    found.slope = (point - nearest.point) / found.value;
  }
  return found;
}

// Inside or outside: by the side of the nearest face that the point is on or, where an edge is
// nearest, of the mean of its two faces (angle-weighted pseudonormals, Baerentzen and Aanaes 2005).
// At a vertex, where more than one fan of faces may meet, and where the height over the face is
// rounding, by how often the surface goes around the point.
bool ToolMesh::isInside(const Vec3& point, const TriangleBvh::Nearest& nearest) const {
  const Box& box = bounds();
  const bool in_box =
      (point.array() >= box.min().array()).all() && (point.array() <= box.max().array()).all();
  if (!in_box) return false;
  const Vec3& weights = nearest.weights;
  if (crosses_itself_ || weights.maxCoeff() == 1.0) return tree_.isInside(point);
  Vec3 normal = normals_[at(nearest.triangle)];
  Eigen::Index opposite = 0;
  if (weights.minCoeff(&opposite) == 0.0) {
    normal = edge_normals_[at(
        edges_of_triangles_[at(nearest.triangle)][(static_cast<std::size_t>(opposite) + 1) % 3])];
  }
  const double side = normal.dot(point - nearest.point);
  if (std::abs(side) <= tuning::kPlainSide * nearest.distance) return tree_.isInside(point);
  return side < 0.0;
}

}  // namespace robot_tissue
