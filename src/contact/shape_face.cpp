#include "shape_face.h"

#include <algorithm>
#include <cmath>

#include "tuning.h"

namespace robot_tissue {
namespace {

using Type = ToolShape::Type;

// Facing and point are in the shape's frame, and the face is, too.
struct Asked {
  const CollisionShape& shape;
  Vec3 facing, point;
  double reach;
};

std::optional<ShapeFace> boxFace(const Asked& asked) {
  const Vec3 half = 0.5 * asked.shape.measures().size;
  int across = 0;
  if (asked.facing.cwiseAbs().maxCoeff(&across) < tuning::kFaces) return std::nullopt;
  ShapeFace face;
  face.normal = std::copysign(1.0, asked.facing[across]) * Vec3::Unit(across);
  face.height_m = face.normal.dot(asked.point) - half[across];
  Vec3 on_face = asked.point.cwiseMax(-half).cwiseMin(half);
  on_face[across] = face.normal[across] * half[across];
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == across) continue;
    for (const double side : {-1.0, 1.0}) {
      Vec3 foot = on_face;
      foot[axis] = side * half[axis];
      face.edges.push_back({side * Vec3::Unit(axis), half[axis] - side * asked.point[axis], foot});
    }
  }
  return face;
}

std::optional<ShapeFace> cylinderFace(const Asked& asked) {
  if (std::abs(asked.facing.z()) < tuning::kFaces) return std::nullopt;
  ShapeFace face;
  face.normal = std::copysign(1.0, asked.facing.z()) * Vec3::UnitZ();
  const double half_length = 0.5 * asked.shape.measures().length;
  face.height_m = face.normal.dot(asked.point) - half_length;
  const double radius = asked.shape.measures().radius;
  const double from_axis = asked.point.head<2>().norm();
  const Vec3 radial = from_axis > 0.0
                          ? Vec3(asked.point.x() / from_axis, asked.point.y() / from_axis, 0.0)
                          : Vec3(Vec3::UnitX());
  const Vec3 middle = half_length * face.normal;
  face.edges = {{radial, radius - from_axis, middle + radius * radial},
                {-radial, radius + from_axis, middle - radius * radial}};
  return face;
}

// The nearest of its sharp edges tells the face.
std::optional<ShapeFace> meshFace(const Asked& asked) {
  struct Seen {
    const ToolMesh::SharpEdge* edge;
    double depth;
    Vec3 foot;
  };
  std::vector<Seen> near;
  const ToolMesh& mesh = asked.shape.mesh();
  const double felt = tuning::kFeltOfReach * asked.reach;
  for (std::size_t i = 0; i < mesh.sharpEdges().size(); ++i) {
    const ToolMesh::SharpEdge& edge = mesh.sharpEdges()[i];
    if (edge.normal.dot(asked.facing) < tuning::kFaces) continue;
    const Vec3 along = edge.ends[1] - edge.ends[0];
    const double share = (asked.point - edge.ends[0]).dot(along) / along.squaredNorm();
    const Vec3 foot = edge.ends[0] + std::min(std::max(share, 0.0), 1.0) * along;
    const Vec3 way = asked.point - foot;
    const double height = edge.normal.dot(way);
    const double off = (way - height * edge.normal).norm();
    if (off > asked.reach || std::abs(height) > asked.reach) continue;
    if (!mesh.isFelt(i, felt)) continue;
    near.push_back({&edge, way.dot(edge.outward) > 0.0 ? -off : off, foot});
  }
  if (near.empty()) return std::nullopt;
  std::stable_sort(near.begin(), near.end(), [](const Seen& a, const Seen& b) {
    return std::abs(a.depth) < std::abs(b.depth);
  });
  const ToolMesh::SharpEdge& first = *near.front().edge;
  ShapeFace face;
  face.normal = first.normal;
  face.height_m = first.normal.dot(asked.point - first.ends[0]);
  for (const Seen& seen : near) {
    if (seen.edge->normal.dot(first.normal) < tuning::kFaces) continue;
    face.edges.push_back({seen.edge->outward, seen.depth, seen.foot});
  }
  return face;
}

std::optional<ShapeFace> unpaddedFace(const Asked& asked) {
  switch (asked.shape.measures().type) {
    case Type::kBox:
      return boxFace(asked);
    case Type::kCylinder:
      return cylinderFace(asked);
    case Type::kMesh:
      return meshFace(asked);
    case Type::kSphere:
    case Type::kPlane:
      break;
  }
  return std::nullopt;
}

}  // namespace

bool hasFlatFaces(const CollisionShape& shape) {
  const Type type = shape.measures().type;
  if (type == Type::kMesh) return !shape.mesh().sharpEdges().empty();
  return type == Type::kBox || type == Type::kCylinder;
}

std::optional<ShapeFace> faceOf(const CollisionShape& shape, const Vec3& facing, const Vec3& point,
                                double reach) {
  auto face = unpaddedFace({shape, facing, point, reach});
  if (face) face->height_m -= shape.padding();
  return face;
}

}  // namespace robot_tissue
