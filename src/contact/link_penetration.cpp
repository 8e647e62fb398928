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

std::vector<Vec3> meshPoints(const ToolMesh& mesh, double padding) {
  std::vector<Vec3> points;
  const auto& vertices = mesh.vertices();
  const auto& normals = mesh.vertexNormals();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    points.push_back(vertices[i] + padding * normals[i]);
  }
  for (const ToolMesh::Edge& edge : mesh.edges()) {
    const auto [a, b] = edge.ends;
    const Vec3 normal = (normals[at(a)] + normals[at(b)]).stableNormalized();
    points.push_back(0.5 * (vertices[at(a)] + vertices[at(b)]) + padding * normal);
  }
  return points;
}

// The nearest point of the surface to one that is inside; nothing when it is outside.
std::optional<TriangleBvh::Nearest> footOf(const Vec3& point, const TriangleBvh& surface) {
  if (!surface.isInside(point)) return std::nullopt;
  return surface.nearest(point, std::numeric_limits<double>::infinity());
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

double deepestInside(const PlacedShape& placed, const std::vector<Vec3>& points,
                     const TriangleBvh& surface, const PointBulge& bulge, double known) {
  const Box box = surface.bounds();
  double deepest = known;
  TriangleBvh::Nearest foot;
  Vec3 place = Vec3::Zero();
  const auto isDeeper = [&](const Vec3& point, double least) {
    if (!box.contains(point) || surface.nearest(point, least, least)) return false;
    const auto nearest = footOf(point, surface);
    if (!nearest || nearest->distance <= least) return false;
    const double depth = depthOf(point, *nearest, bulge);
    if (depth <= least) return false;
    deepest = depth;
    foot = *nearest;
    place = point;
    return true;
  };
  for (const Vec3& point : points) isDeeper(placed.tissue_T_shape * point, deepest);
  if (foot.triangle < 0) return deepest;
  for (int move = 0; move < tuning::kMostMoves; ++move) {
    const Vec3 inwards = (place - foot.point).normalized();
    const Vec3 direction = placed.shape_T_tissue.linear() * inwards;
    if (!isDeeper(placed.tissue_T_shape * placed.shape->farthest(direction),
                  deepest + tuning::kLeastGain)) {
      break;
    }
  }
  return deepest;
}

double deepestInside(const PlacedShape& placed, const std::vector<Vec3>& points,
                     const TriangleBvh& surface, const PointBulge& bulge, double known,
                     ClearPoints& clear) {
  const Box box = surface.bounds();
  const double ahead = tuning::kLooksAhead * clear.lastWay();
  double deepest = known;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (clear.isClear(i)) continue;
    const Vec3 point = placed.tissue_T_shape * points[i];
    if (!box.contains(point)) {
      clear.note(i, box.exteriorDistance(point));
      continue;
    }
    if (surface.nearest(point, deepest, deepest)) continue;
    const auto foot = surface.nearest(point, std::numeric_limits<double>::infinity());
    if (!foot) continue;
    // Inside or outside is the dearest question: not where neither answer tells anything.
    const bool is_far = foot->distance > clear.lastWay();
    const double depth = depthOf(point, *foot, bulge);
    if (!is_far && depth <= deepest) continue;
    if (surface.isInside(point)) {
      deepest = std::max(deepest, depth);
    } else if (is_far) {
      clear.note(i, std::min(foot->distance, ahead));
    }
  }
  return deepest;
}

}  // namespace robot_tissue
