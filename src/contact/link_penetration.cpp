#include "link_penetration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tuning.h"

namespace robot_tissue {
namespace {

// Evenly spread points: heights in equal steps, each turned on by the golden angle.
std::vector<Vec3> spherePoints(double radius) {
  std::vector<Vec3> points;
  const double turn = M_PI * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < tuning::kSpherePoints; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / tuning::kSpherePoints;
    const double across = std::sqrt(1.0 - z * z);
    points.push_back(radius * Vec3(across * std::cos(turn * i), across * std::sin(turn * i), z));
  }
  return points;
}

// A grid of (kBoxSteps + 1)^2 points on each face, edges and corners among them.
std::vector<Vec3> boxPoints(const Vec3& size) {
  std::vector<Vec3> points;
  const auto isEnd = [](int i) { return i == 0 || i == tuning::kBoxSteps; };
  for (int i = 0; i <= tuning::kBoxSteps; ++i) {
    for (int j = 0; j <= tuning::kBoxSteps; ++j) {
      for (int k = 0; k <= tuning::kBoxSteps; ++k) {
        if (!isEnd(i) && !isEnd(j) && !isEnd(k)) continue;
        points.push_back(
            size.cwiseProduct(Vec3(i, j, k) / tuning::kBoxSteps - Vec3::Constant(0.5)));
      }
    }
  }
  return points;
}

std::vector<Vec3> cylinderPoints(double radius, double length) {
  std::vector<Vec3> points = {Vec3(0.0, 0.0, 0.5 * length), Vec3(0.0, 0.0, -0.5 * length)};
  for (int i = 0; i < tuning::kRimPoints; ++i) {
    const double angle = 2.0 * M_PI * i / tuning::kRimPoints;
    const Vec3 rim(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    for (int ring = 0; ring <= tuning::kSideRings; ++ring) {
      const double share = static_cast<double>(ring) / tuning::kSideRings;
      points.push_back(rim + Vec3(0.0, 0.0, (share - 0.5) * length));
    }
    for (int ring = 1; ring < tuning::kCapRings; ++ring) {
      const double share = static_cast<double>(ring) / tuning::kCapRings;
      points.push_back(share * rim + Vec3(0.0, 0.0, 0.5 * length));
      points.push_back(share * rim - Vec3(0.0, 0.0, 0.5 * length));
    }
  }
  return points;
}

// A fine mesh has vertices enough.
std::vector<Vec3> meshPoints(const ToolMesh& mesh, double padding) {
  const double apart = mesh.bounds().diagonal().maxCoeff() / tuning::kBoxSteps;
  std::vector<Vec3> points;
  const auto& vertices = mesh.vertices();
  const auto& normals = mesh.vertexNormals();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    points.push_back(vertices[i] + padding * normals[i]);
  }
  for (const ToolMesh::Edge& edge : mesh.edges()) {
    const auto [a, b] = edge.ends;
    if ((vertices[at(a)] - vertices[at(b)]).norm() <= apart) continue;
    const Vec3 normal = (normals[at(a)] + normals[at(b)]).stableNormalized();
    points.push_back(0.5 * (vertices[at(a)] + vertices[at(b)]) + padding * normal);
  }
  return points;
}

// Of a point inside the triangles, in the surface that is off them by `bulge`.
double depthOf(const Vec3& point, const TriangleBvh::Nearest& foot, const PointBulge& bulge) {
  if (foot.distance <= 0.0) return 0.0;
  const Vec3 inwards = (point - foot.point) / foot.distance;
  return foot.distance - bulge({foot.triangle, foot.weights}).dot(inwards);
}

}  // namespace

std::vector<Vec3> surfacePoints(const CollisionShape& shape) {
  const ToolShape& measures = shape.measures();
  std::vector<Vec3> points;
  switch (measures.type) {
    case ToolShape::Type::kSphere:
      return spherePoints(measures.radius + shape.padding());
    case ToolShape::Type::kBox:
      points = boxPoints(measures.size);
      break;
    case ToolShape::Type::kCylinder:
      points = cylinderPoints(measures.radius, measures.length);
      break;
    case ToolShape::Type::kMesh:
      return meshPoints(shape.mesh(), shape.padding());
    case ToolShape::Type::kPlane:
      break;
  }
  // Out to the padded surface. Seen from just outside, a point on an edge or corner moves along the
  // mean of its faces' normals.
  const Vec3 half = 0.5 * (shape.bounds().max() - shape.bounds().min());
  for (Vec3& point : points) {
    const Vec3 outside = point + 1e-6 * half.minCoeff() * point.cwiseQuotient(half);
    point += shape.padding() * shape.distance(outside).slope;
  }
  return points;
}

namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();

// The deepest point so far, and the surface's point next to it.
struct Deepest {
  double depth = 0.0;
  TriangleBvh::Nearest foot;  // none: no point is deeper than what was known before
  Vec3 place = Vec3::Zero();
};

// Inside as the nearest triangle sees it: nearly always it is.
bool isBehind(const Vec3& point, const TriangleBvh::Nearest& foot, const TriangleBvh& surface) {
  const Corners& corners = surface.corners(foot.triangle);
  const Vec3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  return (point - foot.point).dot(area) < 0.0;
}

// Looks on from it to where the convex shape reaches farthest from that foot.
void goFarther(const PlacedShape& placed, const TriangleBvh& surface, const PointBulge& bulge,
               Deepest& deepest) {
  const Box box = surface.bounds();
  for (int move = 0; move < tuning::kMostMoves; ++move) {
    const Vec3 inwards = (deepest.place - deepest.foot.point).normalized();
    const Vec3 direction = placed.shape_T_tissue.linear() * inwards;
    const Vec3 point = placed.tissue_T_shape * placed.shape->farthest(direction);
    const double least = deepest.depth + tuning::kLeastGain * placed.shape->thickness();
    if (!box.contains(point)) return;
    const auto foot = surface.nearest(point, kAnywhere, least);
    if (!foot || foot->distance <= least) return;
    const double depth = depthOf(point, *foot, bulge);
    if (depth <= least || !surface.isInside(point)) return;
    deepest = {depth, *foot, point};
  }
}

}  // namespace

double deepestInside(const PlacedShape& placed, const std::vector<Vec3>& points,
                     const TriangleBvh& surface, const PointBulge& bulge, double known,
                     ClearPoints& clear) {
  const Box box = surface.bounds();
  const double ahead = tuning::kLooksAhead * clear.lastWay();
  Deepest deepest;
  deepest.depth = known;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (clear.isClear(i)) continue;
    const Vec3 point = placed.tissue_T_shape * points[i];
    if (!box.contains(point)) {
      clear.note(i, box.exteriorDistance(point));
      continue;
    }
    const auto foot = surface.nearest(point, kAnywhere, deepest.depth);
    if (!foot || foot->distance <= deepest.depth) continue;
    // Inside or outside is the dearest question: not where neither answer tells anything.
    const bool may_clear = foot->distance > clear.lastWay();
    const double depth = depthOf(point, *foot, bulge);
    if (depth <= deepest.depth && (!may_clear || isBehind(point, *foot, surface))) continue;
    if (!surface.isInside(point)) {
      if (may_clear) clear.note(i, std::min(foot->distance, ahead));
    } else if (depth > deepest.depth) {
      deepest = {depth, *foot, point};
    }
  }
  if (deepest.foot.triangle >= 0 && !placed.shape->isMesh()) {
    goFarther(placed, surface, bulge, deepest);
  }
  return deepest.depth;
}

}  // namespace robot_tissue
