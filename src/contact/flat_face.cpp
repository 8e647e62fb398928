#include "flat_face.h"

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

std::optional<FlatFace> boxFace(const Asked& asked) {
  const Vec3 half = 0.5 * asked.shape.measures().size;
  int across = 0;
  if (asked.facing.cwiseAbs().maxCoeff(&across) < tuning::kFaces) return std::nullopt;
  FlatFace face;
  face.normal = std::copysign(1.0, asked.facing[across]) * Vec3::Unit(across);
  face.height_m = face.normal.dot(asked.point) - half[across];
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == across) continue;
    for (const double side : {-1.0, 1.0}) {
      face.edges.push_back({side * Vec3::Unit(axis), half[axis] - side * asked.point[axis]});
    }
  }
  return face;
}

std::optional<FlatFace> cylinderFace(const Asked& asked) {
  if (std::abs(asked.facing.z()) < tuning::kFaces) return std::nullopt;
  FlatFace face;
  face.normal = std::copysign(1.0, asked.facing.z()) * Vec3::UnitZ();
  face.height_m = face.normal.dot(asked.point) - 0.5 * asked.shape.measures().length;
  const double radius = asked.shape.measures().radius;
  const double from_axis = asked.point.head<2>().norm();
  const Vec3 radial = from_axis > 0.0
                          ? Vec3(asked.point.x() / from_axis, asked.point.y() / from_axis, 0.0)
                          : Vec3(Vec3::UnitX());
  face.edges = {{radial, radius - from_axis}, {-radial, radius + from_axis}};
  return face;
}

// The nearest of its sharp edges tells the face; others of the same plane end it on other sides.
std::optional<FlatFace> meshFace(const Asked& asked) {
  struct Seen {
    const ToolMesh::SharpEdge* edge;
    double depth;
  };
  std::vector<Seen> near;
  for (const ToolMesh::SharpEdge& edge : asked.shape.mesh().sharpEdges()) {
    if (edge.normal.dot(asked.facing) < tuning::kFaces) continue;
    const Vec3 along = edge.ends[1] - edge.ends[0];
    const double share = (asked.point - edge.ends[0]).dot(along) / along.squaredNorm();
    const Vec3 foot = edge.ends[0] + std::min(std::max(share, 0.0), 1.0) * along;
    const Vec3 way = asked.point - foot;
    const double height = edge.normal.dot(way);
    const double off = (way - height * edge.normal).norm();
    if (off > asked.reach || std::abs(height) > asked.reach) continue;
    near.push_back({&edge, way.dot(edge.outward) > 0.0 ? -off : off});
  }
  if (near.empty()) return std::nullopt;
  std::stable_sort(near.begin(), near.end(), [](const Seen& a, const Seen& b) {
    return std::abs(a.depth) < std::abs(b.depth);
  });
  const ToolMesh::SharpEdge& first = *near.front().edge;
  FlatFace face;
  face.normal = first.normal;
  face.height_m = first.normal.dot(asked.point - first.ends[0]);
  for (const Seen& seen : near) {
    if (seen.edge->normal.dot(first.normal) < tuning::kFaces) continue;
    const bool is_other = std::all_of(face.edges.begin(), face.edges.end(), [&](const auto& known) {
      return known.outward.dot(seen.edge->outward) < tuning::kOtherSide;
    });
    if (is_other) face.edges.push_back({seen.edge->outward, seen.depth});
  }
  return face;
}

std::optional<FlatFace> faceOf(const Asked& asked) {
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

// Sorts the edges, leaves those out of reach, and turns the face into the tissue's frame.
bool finish(const PlacedShape& placed, double reach, FlatFace& face) {
  face.height_m -= placed.shape->padding();
  face.roundness_m = placed.shape->padding();
  const auto is_far = [&](const FaceEdge& edge) { return std::abs(edge.depth_m) > reach; };
  const bool is_beside = std::any_of(face.edges.begin(), face.edges.end(),
                                     [&](const auto& edge) { return edge.depth_m < -reach; });
  face.edges.erase(std::remove_if(face.edges.begin(), face.edges.end(), is_far), face.edges.end());
  if (is_beside || face.edges.empty() || std::abs(face.height_m) > reach) return false;
  std::stable_sort(face.edges.begin(), face.edges.end(), [](const auto& a, const auto& b) {
    return std::abs(a.depth_m) < std::abs(b.depth_m);
  });
  face.normal = placed.tissue_T_shape.linear() * face.normal;
  for (FaceEdge& edge : face.edges) edge.outward = placed.tissue_T_shape.linear() * edge.outward;
  return true;
}

}  // namespace

bool hasFlatFaces(const CollisionShape& shape) {
  const Type type = shape.measures().type;
  if (type == Type::kMesh) return !shape.mesh().sharpEdges().empty();
  return type == Type::kBox || type == Type::kCylinder;
}

std::optional<FlatFace> flatFaceOf(const PlacedLink& link, const Vec3& facing, const Vec3& point,
                                   double reach) {
  std::optional<FlatFace> nearest;
  for (const PlacedShape& placed : link) {
    if (!hasFlatFaces(*placed.shape)) continue;
    auto face = faceOf({*placed.shape, placed.shape_T_tissue.linear() * facing,
                        placed.shape_T_tissue * point, reach});
    if (!face || !finish(placed, reach, *face)) continue;
    if (nearest && std::abs(nearest->height_m) <= std::abs(face->height_m)) continue;
    nearest = std::move(face);
  }
  return nearest;
}

}  // namespace robot_tissue
