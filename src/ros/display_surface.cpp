#include "robot_tissue/ros/display_surface.h"

#include <algorithm>
#include <tuple>

#include "robot_tissue/core/curved_surface.h"
#include "robot_tissue/core/disjoint_sets.h"
#include "robot_tissue/core/triangle_mesh.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

constexpr int kQuarters = 4;

std::size_t next(std::size_t corner) { return (corner + 1) % 3; }

std::uint64_t keyOf(int node_a, int node_b) {
  const auto [low, high] = std::minmax(node_a, node_b);
  return (static_cast<std::uint64_t>(low) << 32U) | static_cast<std::uint64_t>(high);
}

// Point of the cubic Bezier curve at a quarter of its parameter.
Vec3 bezier(const Vec3& a, const Vec3& from_a, const Vec3& from_b, const Vec3& b, int quarter) {
  const double t = static_cast<double>(quarter) / kQuarters;
  const double s = 1.0 - t;
  return s * s * s * a + 3.0 * s * s * t * from_a + 3.0 * s * t * t * from_b + t * t * t * b;
}

// Chord of the unit circle between two directions: their angle, where that is small (rad).
double bend(const Vec3& direction, const Vec3& chord) {
  return (direction.normalized() - chord.normalized()).norm();
}

}  // namespace

void DisplaySurface::bind(const TissueSurface& surface) {
  triangles_ = surface.triangles;
  opened_ = surface.opened;
  corner_weights_.clear();
  for (const MeshTriangle& corners : triangles_) {
    corner_weights_.push_back(CurvedSurface::cornerWeights(surface.rest, corners));
  }
  const std::vector<Side> sides = findEdges();
  findNormals(surface, sides);
  findNodes(surface);
  lips_.clear();
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const int edge = edge_of_[at(sides[i].triangle)][at(sides[i].corner)];
    const bool has_other = edge == edge_of_[at(sides[i + 1].triangle)][at(sides[i + 1].corner)];
    const auto is_opened = opened_[at(sides[i].triangle)];
    if (has_other && is_opened != opened_[at(sides[i + 1].triangle)]) lips_.push_back(edge);
  }
}

// Fills edges_ but for their normals, and edge_of_. Returns the sides, those of an edge in a row.
std::vector<DisplaySurface::Side> DisplaySurface::findEdges() {
  std::vector<Side> sides;
  sides.reserve(3 * triangles_.size());
  for (std::size_t triangle = 0; triangle < triangles_.size(); ++triangle) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto [low, high] =
          std::minmax(triangles_[triangle][corner], triangles_[triangle][next(corner)]);
      sides.push_back({low, high, static_cast<int>(triangle), static_cast<int>(corner)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  edges_.clear();
  edge_of_.assign(triangles_.size(), {});
  for (const Side& side : sides) {
    const bool is_new =
        edges_.empty() || edges_.back().a != side.low || edges_.back().b != side.high;
    if (is_new) {
      edges_.emplace_back();
      edges_.back().a = side.low;
      edges_.back().b = side.high;
    }
    edge_of_[at(side.triangle)][at(side.corner)] = static_cast<int>(edges_.size()) - 1;
  }
  return sides;
}

// Corners around a vertex have one normal in common up to the next crease.
void DisplaySurface::findNormals(const TissueSurface& surface, const std::vector<Side>& sides) {
  const auto cornerOf = [&](const Side& side, int vertex) {
    const auto corner = at(side.corner);
    const bool is_first = triangles_[at(side.triangle)][corner] == vertex;
    return 3 * side.triangle + static_cast<int>(is_first ? corner : next(corner));
  };
  const auto restNormal = [&](const Side& side) {
    return doubleArea(surface.rest, triangles_[at(side.triangle)]).stableNormalized();
  };
  DisjointSets normals(3 * triangles_.size());
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &side = sides[i], &other = sides[i + 1];
    if (side.low != other.low || side.high != other.high) continue;
    if (opened_[at(side.triangle)] != opened_[at(other.triangle)]) continue;
    if (restNormal(side).dot(restNormal(other)) < CurvedSurface::kSharpFold) continue;
    normals.join(cornerOf(side, side.low), cornerOf(other, side.low));
    normals.join(cornerOf(side, side.high), cornerOf(other, side.high));
  }
  normal_of_.assign(triangles_.size(), {});
  for (std::size_t i = 0; i < 3 * triangles_.size(); ++i) {
    normal_of_[i / 3][i % 3] = normals.lowest(static_cast<int>(i));
  }
  std::vector<std::uint8_t> has_side(edges_.size(), 0);
  for (const Side& side : sides) {
    const auto edge = at(edge_of_[at(side.triangle)][at(side.corner)]);
    const auto normalAtEnd = [&](int vertex) {
      const int corner = cornerOf(side, vertex);
      return normal_of_[at(corner / 3)][at(corner % 3)];
    };
    const int a = normalAtEnd(side.low), b = normalAtEnd(side.high);
    if (has_side[edge] == 0) edges_[edge].at_a = {a, a}, edges_[edge].at_b = {b, b};
    edges_[edge].at_a[1] = a;
    edges_[edge].at_b[1] = b;
    has_side[edge] = 1;
  }
}

// Vertices beside nodes, along cuts, are none of their edges' ends.
void DisplaySurface::findNodes(const TissueSurface& surface) {
  const auto nodeAt = [&](int vertex) {
    const CarrierRange carriers = surface.carriers[at(vertex)];
    return carriers.size() == 1 ? surface.node[at(vertex)] : -1;
  };
  edge_between_.clear();
  edge_between_.reserve(edges_.size());
  for (std::size_t edge = 0; edge < edges_.size(); ++edge) {
    const int a = nodeAt(edges_[edge].a), b = nodeAt(edges_[edge].b);
    if (a >= 0 && b >= 0) edge_between_.emplace(keyOf(a, b), static_cast<int>(edge));
  }
}

void DisplaySurface::fit(const std::vector<Vec3>& vertices) {
  vertices_ = vertices;
  fitNormals();
  curves_.resize(edges_.size());
  for (std::size_t edge = 0; edge < edges_.size(); ++edge) curves_[edge] = curveOf(edges_[edge]);
  limitPieces();
}

void DisplaySurface::fitNormals() {
  normals_.assign(3 * triangles_.size(), Vec3::Zero());
  for (std::size_t triangle = 0; triangle < triangles_.size(); ++triangle) {
    const Vec3 normal = doubleArea(vertices_, triangles_[triangle]).stableNormalized();
    for (std::size_t k = 0; k < 3; ++k) {
      normals_[at(normal_of_[triangle][k])] +=
          corner_weights_[triangle][static_cast<int>(k)] * normal;
    }
  }
  for (Vec3& normal : normals_) normal.stableNormalize();
}

// A third of the way to the other end, brought into the tangent plane; along a crease onto the line
// in which the planes of its sides meet.
Vec3 DisplaySurface::controlPoint(int vertex, int other, const std::array<int, 2>& normals) const {
  const Vec3& here = vertices_[at(vertex)];
  const Vec3 way = vertices_[at(other)] - here;
  const Vec3& normal = normals_[at(normals[0])];
  if (normals[0] == normals[1]) {
    const double rise = way.dot(normal), most = CurvedSurface::kMostRise * way.norm();
    return here + (way - std::clamp(rise, -most, most) * normal) / 3.0;
  }
  const Vec3 line = normal.cross(normals_[at(normals[1])]);
  const Vec3 along = line.dot(way) * line / std::max(line.squaredNorm(), 1e-30);
  // Nearly one plane, or a corner where the line leads elsewhere: straight.
  const bool leads_there =
      line.norm() > tuning::kLeastSine &&
      along.squaredNorm() > (1.0 - CurvedSurface::kMostRise) * way.squaredNorm();
  return here + (leads_there ? along : way) / 3.0;
}

DisplaySurface::Curve DisplaySurface::curveOf(const Edge& edge) const {
  const Vec3 &a = vertices_[at(edge.a)], &b = vertices_[at(edge.b)];
  Curve curve;
  curve.from_a = controlPoint(edge.a, edge.b, edge.at_a);
  curve.from_b = controlPoint(edge.b, edge.a, edge.at_b);
  const double bent = bend(curve.from_a - a, b - a) + bend(b - curve.from_b, b - a);
  curve.pieces = bent < tuning::kDrawnStraight ? 1 : bent < tuning::kDrawnInHalves ? 2 : kQuarters;
  return curve;
}

void DisplaySurface::limitPieces() {
  for (const int most : {kQuarters, 2, 1}) {
    std::size_t count = 0;
    for (Curve& curve : curves_) curve.pieces = std::min(curve.pieces, most);
    for (std::size_t triangle = 0; triangle < triangles_.size(); ++triangle) {
      count += at(piecesOf(triangle) * piecesOf(triangle));
    }
    if (count <= tuning::kMostDrawn) return;
  }
}

int DisplaySurface::piecesOf(std::size_t triangle) const {
  int pieces = 1;
  for (const int edge : edge_of_[triangle]) pieces = std::max(pieces, curves_[at(edge)].pieces);
  return pieces;
}

// On the line that both neighbors draw, whichever of them is drawn finer.
Vec3 DisplaySurface::edgePoint(std::size_t triangle, std::size_t corner, int quarters) const {
  const auto number = at(edge_of_[triangle][corner]);
  const Edge& edge = edges_[number];
  const Curve& curve = curves_[number];
  const Vec3 &a = vertices_[at(edge.a)], &b = vertices_[at(edge.b)];
  const int from_a = triangles_[triangle][corner] == edge.a ? quarters : kQuarters - quarters;
  const int piece = kQuarters / curve.pieces;
  const int left = from_a / piece * piece;
  const auto joint = [&](int quarter) { return bezier(a, curve.from_a, curve.from_b, b, quarter); };
  if (left == from_a) return joint(from_a);
  const double share = static_cast<double>(from_a - left) / piece;
  return (1.0 - share) * joint(left) + share * joint(left + piece);
}

Vec3 DisplaySurface::innerPoint(std::size_t triangle, const std::array<int, 3>& quarters) const {
  Vec3 ends = Vec3::Zero(), sides = Vec3::Zero(), corners = Vec3::Zero(), controls = Vec3::Zero();
  double middle = 6.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double w = static_cast<double>(quarters[k]) / kQuarters;
    const double u = static_cast<double>(quarters[next(k)]) / kQuarters;
    const auto number = at(edge_of_[triangle][k]);
    const Curve& curve = curves_[number];
    const bool forwards = triangles_[triangle][k] == edges_[number].a;
    const Vec3& near = forwards ? curve.from_a : curve.from_b;
    const Vec3& far = forwards ? curve.from_b : curve.from_a;
    const Vec3& corner = vertices_[at(triangles_[triangle][k])];
    ends += w * w * w * corner;
    sides += 3.0 * w * u * (w * near + u * far);
    corners += corner / 3.0;
    controls += (near + far) / 6.0;
    middle *= w;
  }
  return ends + sides + middle * (1.5 * controls - 0.5 * corners);
}

Vec3 DisplaySurface::pointAt(std::size_t triangle, const std::array<int, 3>& quarters) const {
  for (std::size_t k = 0; k < 3; ++k) {
    if (quarters[k] == kQuarters) return vertices_[at(triangles_[triangle][k])];
    if (quarters[next(next(k))] == 0) return edgePoint(triangle, k, quarters[next(k)]);
  }
  return innerPoint(triangle, quarters);
}

Vec3 DisplaySurface::normalAt(std::size_t triangle, const std::array<int, 3>& quarters) const {
  Vec3 normal = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    normal += quarters[k] * normals_[at(normal_of_[triangle][k])];
  }
  return normal.stableNormalized();
}

void DisplaySurface::draw(bool opened, const std::vector<double>* values,
                          DrawnTriangles& drawn) const {
  const auto put = [&](std::size_t triangle, const std::array<int, 3>& quarters) {
    drawn.points.push_back(pointAt(triangle, quarters));
    if (values == nullptr) return;
    drawn.normals.push_back(normalAt(triangle, quarters));
    double value = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      value += quarters[k] * (*values)[at(triangles_[triangle][k])] / kQuarters;
    }
    drawn.values.push_back(value);
  };
  for (std::size_t triangle = 0; triangle < triangles_.size(); ++triangle) {
    if ((opened_[triangle] != 0) != opened) continue;
    const int step = kQuarters / piecesOf(triangle);
    const auto at_grid = [&](int i, int j) { put(triangle, {kQuarters - i - j, i, j}); };
    for (int i = 0; i < kQuarters; i += step) {
      for (int j = 0; i + j < kQuarters; j += step) {
        at_grid(i, j), at_grid(i + step, j), at_grid(i, j + step);
        if (i + j + 2 * step > kQuarters) continue;
        at_grid(i + step, j), at_grid(i + step, j + step), at_grid(i, j + step);
      }
    }
  }
}

int DisplaySurface::edgeBetween(int node_a, int node_b) const {
  const auto found = edge_between_.find(keyOf(node_a, node_b));
  return found == edge_between_.end() ? -1 : found->second;
}

void DisplaySurface::drawEdge(int edge, std::vector<Vec3>& ends) const {
  const Curve& curve = curves_[at(edge)];
  const Vec3 &a = vertices_[at(edges_[at(edge)].a)], &b = vertices_[at(edges_[at(edge)].b)];
  const int step = kQuarters / curve.pieces;
  for (int quarter = 0; quarter < kQuarters; quarter += step) {
    for (const int end : {quarter, quarter + step}) {
      ends.push_back(bezier(a, curve.from_a, curve.from_b, b, end));
    }
  }
}

void DisplaySurface::drawLips(std::vector<Vec3>& ends) const {
  for (const int edge : lips_) drawEdge(edge, ends);
}

}  // namespace robot_tissue
