#include "link_contacts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "mesh_minima.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// The normal where the tool gives none, as at the middle of a ball: into the tissue, across the
// triangle.
Vec3 inward(const Corners& corners) {
  const Vec3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double length = area.norm();
  return length > 0.0 ? Vec3(-area / length) : Vec3(-Vec3::UnitZ());
}

}  // namespace

void LinkContacts::find(const Asked& asked, const TissueSurface& surface,
                        const std::vector<Vec3>& vertices, ContactSet& found) {
  link_ = &asked.link;
  faces_ = &asked.faces;
  known_ = asked.known;
  surface_ = &surface;
  vertices_ = &vertices;
  margin_ = asked.margin;
  tool_ = asked.tool_index;
  link_index_ = asked.link_index;
  box_ = grownBy(margin_, boundsOf(asked.link));
  forgetVertices();
  edge_places_.clear();
  for (const int triangle : asked.triangles) askTriangle(triangle, found);
}

void LinkContacts::forgetVertices() {
  asked_.clearFor(vertices_->size());
  seen_.resize(std::max(seen_.size(), link_->size()));
  for (SparseValues<Seen>& of_shape : seen_) of_shape.clearFor(vertices_->size());
}

void LinkContacts::askTriangle(int triangle, ContactSet& found) {
  triangle_ = triangle;
  const MeshTriangle& corners = surface_->triangles[at(triangle)];
  Box box;
  for (const int vertex : corners) {
    const Vec3& corner = (*vertices_)[at(vertex)];
    if (!corner.allFinite()) return;
    box.extend(corner);
  }
  for (int k = 0; k < 3; ++k) {
    const int vertex = corners[at(k)];
    if (asked_.find(vertex) != nullptr) continue;
    asked_.add(vertex) = true;
    if (box_.contains((*vertices_)[at(vertex)])) askVertex(vertex, Vec3::Unit(k), found);
  }
  if ((box.max() - box.min()).isZero(0.0)) return;
  for (std::size_t shape = 0; shape < link_->size(); ++shape) {
    // Of a plane, a vertex is the deepest point.
    if ((*link_)[shape].shape->isPlane()) continue;
    if (grownBy(margin_, (*link_)[shape].bounds).intersects(box)) askShape(shape, corners, found);
  }
}

Corners LinkContacts::cornersOf(const MeshTriangle& triangle) const {
  return {(*vertices_)[at(triangle[0])], (*vertices_)[at(triangle[1])],
          (*vertices_)[at(triangle[2])]};
}

const LinkContacts::Seen& LinkContacts::seen(std::size_t shape, int vertex) {
  if (const Seen* known = seen_[shape].find(vertex)) return *known;
  Seen& seen = seen_[shape].add(vertex);
  const PlacedShape& placed = (*link_)[shape];
  seen.point = placed.shape_T_tissue * (*vertices_)[at(vertex)];
  if (placed.shape->isMesh()) {
    const auto found = placed.shape->distanceNear(seen.point, margin_);
    seen.is_near = found.has_value();
    if (found) seen.distance = *found;
  } else {
    seen.is_near = true;
    seen.distance = placed.shape->distance(seen.point);
  }
  return seen;
}

// Adds the contact of a vertex, with the shape of the link that it is deepest in.
void LinkContacts::askVertex(int vertex, const Vec3& weights, ContactSet& found) {
  std::optional<SignedDistance> least;
  Vec3 normal = Vec3::Zero();
  std::size_t deepest = 0;
  for (std::size_t shape = 0; shape < link_->size(); ++shape) {
    const Seen& here = seen(shape, vertex);
    if (!here.is_near || (least && here.distance.value >= least->value)) continue;
    least = here.distance;
    deepest = shape;
    normal = (*link_)[shape].tissue_T_shape.linear() * least->slope;
  }
  if (least && least->value < margin_) add(deepest, weights, -least->value, normal, found);
}

std::vector<TriangleMinimum> LinkContacts::minimaOf(std::size_t shape,
                                                    const MeshTriangle& triangle) {
  const CollisionShape& asked = *(*link_)[shape].shape;
  Corners corners;
  std::array<SignedDistance, 3> distances;
  for (std::size_t k = 0; k < 3; ++k) {
    const Seen& corner = seen(shape, triangle[k]);
    corners[k] = corner.point;
    distances[k] = corner.distance;
  }
  // Half of the error goes to the search for the deepest point, half to taking a vertex for it
  // (isVertexAlready).
  const double accuracy = 0.5 * accuracyFor(asked, corners);
  std::vector<TriangleMinimum> minima;
  if (asked.isMesh()) {
    minima = minimaInMesh(shape, triangle, corners, accuracy);
  } else {
    minima = {convexMinimum(asked, corners, distances, accuracy, margin_)};
  }
  minima.erase(std::remove_if(minima.begin(), minima.end(),
                              [&](const TriangleMinimum& minimum) {
                                return !(minimum.distance.value < margin_) ||
                                       isVertexAlready(minimum, shape, triangle, accuracy);
                              }),
               minima.end());
  return minima;
}

std::vector<TriangleMinimum> LinkContacts::minimaInMesh(std::size_t shape,
                                                        const MeshTriangle& triangle,
                                                        const Corners& corners, double accuracy) {
  const CollisionShape& asked = *(*link_)[shape].shape;
  KnownMinima* const known = known_ == nullptr ? nullptr : &(*known_)[shape];
  if (known != nullptr) {
    if (auto minima = known->follow(triangle_, asked, corners, accuracy, margin_)) return *minima;
  }
  near_faces_.clear();
  if (const FacePairs* pairs = (*faces_)[shape]) pairs->facesNear(triangle_, near_faces_);
  // No face comes near: all of the triangle is inside, or all of it outside.
  std::vector<TriangleMinimum> minima;
  const Seen& corner = seen(shape, triangle[0]);
  if (!near_faces_.empty() || (corner.is_near && corner.distance.value <= 0.0)) {
    const auto at_first = corner.is_near ? std::optional(corner.distance.value) : std::nullopt;
    minima = meshMinima(seeds_, asked, corners, near_faces_, accuracy, margin_, at_first);
  }
  if (known != nullptr) known->note(triangle_, corners, margin_, minima);
  return minima;
}

void LinkContacts::askShape(std::size_t shape, const MeshTriangle& triangle, ContactSet& found) {
  const PlacedShape& placed = (*link_)[shape];
  const Corners corners = cornersOf(triangle);
  for (const TriangleMinimum& minimum : minimaOf(shape, triangle)) {
    // Where the point is deeper in another shape of the link, the contact is that shape's.
    if (link_->size() > 1) {
      const auto deepest = wayOut(*link_, pointOf(corners, minimum.weights), margin_);
      if (deepest && deepest->depth_m > -minimum.distance.value + tuning::kDeeper) continue;
    }
    if (isOnKnownEdge(minimum.weights, shape, triangle)) continue;
    add(shape, minimum.weights, -minimum.distance.value,
        placed.tissue_T_shape.linear() * minimum.distance.slope, found);
  }
}

// Whether a corner, which is a contact itself, stands for this deepest point: it is as deep but for
// the accuracy, and, of a mesh, which may have several deepest points, near to it.
bool LinkContacts::isVertexAlready(const TriangleMinimum& minimum, std::size_t shape,
                                   const MeshTriangle& triangle, double accuracy) {
  const bool is_mesh = (*link_)[shape].shape->isMesh();
  const Corners corners = cornersOf(triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    const Seen& corner = seen(shape, triangle[k]);
    if (!corner.is_near || !(corner.distance.value < margin_)) continue;
    if (corner.distance.value > minimum.distance.value + accuracy) continue;
    if (!is_mesh) return true;
    const double apart = (pointOf(corners, minimum.weights) - corners[k]).norm();
    if (apart <= std::max(accuracy, -corner.distance.value)) return true;
  }
  return false;
}

// Whether a point on an edge was found from the triangle across that edge. A convex shape has one
// deepest point on an edge; of a mesh they are told apart by their place along it.
bool LinkContacts::isOnKnownEdge(const Vec3& weights, std::size_t shape,
                                 const MeshTriangle& triangle) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (weights[static_cast<int>(k)] > tuning::kOnEdge) continue;
    const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
    const bool ascending = triangle[next] < triangle[last];
    const double along = weights[static_cast<int>(ascending ? last : next)];
    auto& places = edge_places_[std::minmax(triangle[next], triangle[last])];
    const bool is_mesh = (*link_)[shape].shape->isMesh();
    for (const EdgePlace& known : places) {
      if (known.shape != shape) continue;
      if (!is_mesh || std::abs(known.along - along) <= tuning::kSameAlong) return true;
    }
    places.push_back({shape, along});
    return false;
  }
  return false;
}

void LinkContacts::add(std::size_t shape, const Vec3& weights, double depth, const Vec3& normal,
                       ContactSet& found) {
  const Corners corners = cornersOf(surface_->triangles[at(triangle_)]);
  Contact contact;
  contact.tool = tool_;
  contact.link = link_index_;
  contact.shape = static_cast<int>(shape);
  contact.place = {triangle_, weights};
  contact.point = pointOf(corners, weights);
  contact.normal = normal.isZero() ? inward(corners) : normal;
  contact.depth_m = depth;
  found.contacts.push_back(contact);
}

}  // namespace robot_tissue
