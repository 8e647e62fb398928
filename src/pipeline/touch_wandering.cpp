// Touches that wander: where a sharp edge or corner of a link is between the surface's vertices.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "touch_finder.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Where in [0, 1] a concave function is highest, by golden sections (Kiefer 1953).
template <typename Function>
double highestAt(const Function& value) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = 0.0, high = 1.0;
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double at_left = value(left), at_right = value(right);
  for (int step = 0; step < 12; ++step) {
    if (at_left > at_right) {
      high = right;
      right = left, at_right = at_left;
      left = high - golden * (high - low);
      at_left = value(left);
    } else {
      low = left;
      left = right, at_left = at_right;
      right = low + golden * (high - low);
      at_right = value(right);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

// Whether what touches is a sharp edge or corner of the link, which tissue slides past: its normal
// turns by more than kSharpTurn from one side of the point to the other.
bool TouchFinder::wanders(const RobotPose& pose, const Contact& contact) const {
  const std::size_t link = at(contact.link);
  const double aside = tuning::kBesideEdge * world_.tissue.lattice().spacing();
  if (smooth_[link] < tuning::kMostlySmooth || world_.isInWound(link)) return false;
  if (vertexAt(world_.tissue.surface(), contact.place) >= 0) return false;
  const Vec3 off = contact.point + (contact.depth_m + aside) * contact.normal;
  const auto normalAt = [&](const Vec3& point) {
    const auto out = world_.finder.wayOut(link, pose.links[link], point, 4.0 * aside);
    return out ? out->normal : contact.normal;
  };
  const Vec3 across = contact.normal.unitOrthogonal();
  for (const Vec3& way : {across, Vec3(contact.normal.cross(across))}) {
    const double cosine = normalAt(off + aside * way).dot(normalAt(off - aside * way));
    if (cosine < tuning::kSharpTurn) return true;
  }
  return false;
}

// A touch that wanders and was not found: of a triangle only the deepest point is, but a tool's
// edge or corner may go on touching beside it. On an edge of the triangles it goes to the deepest
// point of that.
std::optional<Contact> TouchFinder::goAlong(const RobotPose& pose, const ContactSet& found,
                                            const SlidingContacts::ContactConstraint& touch) const {
  if (touch.spring.multiplier <= 0.0) return std::nullopt;
  const double near = tuning::kFoundNear * world_.tissue.lattice().spacing();
  const auto is_found = [&](const Contact& contact) {
    if (!contact.wanders || contact.link != touch.contact.link) return false;
    const Vec3 on_link = contact.point + contact.depth_m * contact.normal;
    return (on_link - touch.tool_point).squaredNorm() < near * near;
  };
  if (std::any_of(found.contacts.begin(), found.contacts.end(), is_found)) return std::nullopt;
  const auto edge = edgeAt(touch.contact.place);
  const std::size_t link = at(touch.contact.link);
  const double reach = tuning::kReach * world_.tissue.lattice().spacing();
  Contact contact = touch.contact;
  if (edge) {
    const Vec3 &a = vertices_[at(edge->vertices[0])], &b = vertices_[at(edge->vertices[1])];
    const double share = highestAt([&](double part) {
      const auto out =
          world_.finder.wayOut(link, pose.links[link], a + part * (b - a), 2.0 * reach);
      return out ? out->depth_m : -2.0 * reach;
    });
    contact.place.barycentric[edge->corners[0]] = 1.0 - share;
    contact.place.barycentric[edge->corners[1]] = share;
  }
  if (contact.place.barycentric.maxCoeff() > tuning::kAtVertex) return std::nullopt;
  if (!wanderTo(contact.place, pose, contact)) return std::nullopt;
  return contact;
}

// Puts a contact that wanders there on the surface. False: its link is out of reach.
bool TouchFinder::wanderTo(const SurfacePoint& place, const RobotPose& pose,
                           Contact& contact) const {
  contact.place = place;
  contact.point = pointOf(cornersOf(place.triangle), place.barycentric);
  curve(contact);
  if (!turn(pose, contact)) return false;
  contact.turn = curved_.hollowAt(place);
  return true;
}

Corners TouchFinder::cornersOf(int triangle) const {
  const auto& [a, b, c] = world_.tissue.surface().triangles[at(triangle)];
  return {vertices_[at(a)], vertices_[at(b)], vertices_[at(c)]};
}

// Where a touch wanders to hangs on the shape, and the shape on where it is: going all of the way
// in each round, both would go to and fro for ever.
void TouchFinder::wanderHalfWay(const RobotPose& pose, ContactSet& found) const {
  for (Contact& contact : found.contacts) {
    if (!contact.wanders) continue;
    const auto middle = halfWayTo(contact);
    if (!middle) continue;
    Contact half_way = contact;
    if (wanderTo(*middle, pose, half_way)) contact = half_way;
  }
}

// The surface's point half way from the nearest touch of the contact's link to the contact. None
// where no touch of this triangle or of one beside it is near.
std::optional<SurfacePoint> TouchFinder::halfWayTo(const Contact& contact) const {
  const auto placeOf = [&](const SurfacePoint& point) {
    return pointOf(cornersOf(point.triangle), point.barycentric);
  };
  const Vec3 to = placeOf(contact.place);
  double least = tuning::kFarthestBefore * world_.tissue.lattice().spacing();
  std::optional<SurfacePoint> from;
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    const Contact& before = touch.contact;
    if (!before.wanders || before.link != contact.link || touch.spring.multiplier <= 0.0) continue;
    if (!areBeside(before.place.triangle, contact.place.triangle)) continue;
    const double off = (placeOf(before.place) - to).norm();
    if (off >= least) continue;
    least = off;
    from = before.place;
  }
  if (!from) return std::nullopt;
  const Vec3 middle = 0.5 * (placeOf(*from) + to);
  SurfacePoint nearest;
  double nearest_off = std::numeric_limits<double>::infinity();
  for (const int triangle : {from->triangle, contact.place.triangle}) {
    const SurfacePoint point = {triangle, nearestInTriangle(middle, cornersOf(triangle))};
    const double off = (placeOf(point) - middle).norm();
    if (off >= nearest_off) continue;
    nearest_off = off;
    nearest = point;
  }
  if (nearest.barycentric.maxCoeff() > tuning::kAtVertex) return std::nullopt;
  return nearest;
}

// Whether two triangles of the surface are one, or have an edge in common.
bool TouchFinder::areBeside(int one, int other) const {
  const auto& triangles = world_.tissue.surface().triangles;
  const MeshTriangle &a = triangles[at(one)], &b = triangles[at(other)];
  const auto common = std::count_if(a.begin(), a.end(), [&](int vertex) {
    return std::find(b.begin(), b.end(), vertex) != b.end();
  });
  return common >= 2;
}

std::optional<TouchFinder::Edge> TouchFinder::edgeAt(const SurfacePoint& place) const {
  for (int k = 0; k < 3; ++k) {
    if (place.barycentric[k] > 1e-9) continue;
    Edge edge{{(k + 1) % 3, (k + 2) % 3}, {}};
    const MeshTriangle& corners = world_.tissue.surface().triangles[at(place.triangle)];
    for (std::size_t end = 0; end < 2; ++end) edge.vertices[end] = corners[at(edge.corners[end])];
    if (edge.vertices[0] > edge.vertices[1]) {
      std::swap(edge.vertices[0], edge.vertices[1]);
      std::swap(edge.corners[0], edge.corners[1]);
    }
    return edge;
  }
  return std::nullopt;
}

}  // namespace robot_tissue
