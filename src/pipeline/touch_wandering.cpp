// Touches that wander: where a sharp edge or corner of a link is between the surface's vertices.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "robot_tissue/core/golden_section.h"
#include "stopwatch.h"
#include "touch_finder.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Chosen: to 0.2 % of an edge.
constexpr int kSectionsOfEdge = 12;

}  // namespace

// Whether what touches is a sharp edge or corner of the link, which tissue slides past: its normal
// turns by more than kSharpTurn from one side of the point to the other.
bool TouchFinder::wanders(const RobotPose& pose, const Contact& contact) const {
  const std::size_t link = at(contact.link);
  const double aside = tuning::kBesideEdge * world_.tissue.lattice().spacing();
  if (state_.smooth[link] < tuning::kMostlySmooth || world_.isInWound(link)) return false;
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
  const bool pushes =
      touch.spring.multiplier > 0.0 ||
      normalForceOf(touch.spring, world_.tissue.state().displacement) > 0.0;  // a new one
  if (!pushes) return std::nullopt;
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
    const double share = lowestBetween(0.0, 1.0, kSectionsOfEdge, [&](double part) {
      const auto out =
          world_.finder.wayOut(link, pose.links[link], a + part * (b - a), 2.0 * reach);
      return out ? -out->depth_m : 2.0 * reach;
    });
    contact.place.barycentric[edge->corners[0]] = 1.0 - share;
    contact.place.barycentric[edge->corners[1]] = share;
  }
  if (contact.place.barycentric.maxCoeff() > tuning::kAtVertex) return std::nullopt;
  if (!wanderTo(contact.place, pose, contact)) return std::nullopt;
  return contact;
}

std::vector<std::optional<Contact>> TouchFinder::trackWandering(const RobotPose& pose,
                                                                const ContactSet& found) const {
  const Stopwatch watch(contact_ms_);
  std::vector<std::optional<Contact>> tracked;
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    tracked.push_back(touch.contact.wanders ? goAlong(pose, found, touch) : std::nullopt);
  }
  return tracked;
}

// Puts a contact that wanders there on the surface. False: its link is out of reach.
bool TouchFinder::wanderTo(const SurfacePoint& place, const RobotPose& pose,
                           Contact& contact) const {
  contact.place = place;
  contact.point = placeOf(place);
  curve(contact);
  if (!turn(pose, contact)) return false;
  contact.turn = curved_.hollowAt(place);
  contact.columns = rims_.columnsAt(contact);
  return true;
}

Corners TouchFinder::cornersOf(int triangle) const {
  const auto& [a, b, c] = world_.tissue.surface().triangles[at(triangle)];
  return {vertices_[at(a)], vertices_[at(b)], vertices_[at(c)]};
}

// Where a touch wanders to hangs on the shape, and the shape on where it is: going all of the way
// in each round, both would go to and fro for ever. Where it is deep it has farther to go.
void TouchFinder::wanderPartOfWay(const RobotPose& pose, ContactSet& found) const {
  const double deep = tuning::kDeepToWander * world_.tissue.lattice().spacing();
  for (const auto& [number, from] : placesBefore(found)) {
    Contact& contact = found.contacts[number];
    const double share = contact.depth_m > deep ? tuning::kWanderWhereDeep : tuning::kWander;
    const auto place = between(from, contact.place, share);
    if (!place) continue;
    Contact there = contact;
    if (wanderTo(*place, pose, there)) contact = there;
  }
}

// Contacts that wander, by their numbers, and where each was: the place of the nearest touch on
// this triangle or on one beside it. A touch is what one of them was, the nearest first: the others
// have only come.
std::vector<std::pair<std::size_t, SurfacePoint>> TouchFinder::placesBefore(
    const ContactSet& found) const {
  const auto& touches = world_.sliding.touches();
  const double farthest = tuning::kFarthestBefore * world_.tissue.lattice().spacing();
  std::vector<std::tuple<double, std::size_t, std::size_t>> near;  // m, contact, touch
  for (std::size_t i = 0; i < found.contacts.size(); ++i) {
    const Contact& contact = found.contacts[i];
    if (!contact.wanders) continue;
    for (std::size_t j = 0; j < touches.size(); ++j) {
      const Contact& before = touches[j].contact;
      if (!before.wanders || before.link != contact.link) continue;
      if (touches[j].spring.multiplier <= 0.0) continue;
      if (!areBeside(before.place.triangle, contact.place.triangle)) continue;
      const double off = (placeOf(before.place) - placeOf(contact.place)).norm();
      if (off < farthest) near.emplace_back(off, i, j);
    }
  }
  std::sort(near.begin(), near.end());
  std::vector<std::pair<std::size_t, SurfacePoint>> places;
  std::set<std::size_t> contacts_taken, touches_taken;
  for (const auto& [off, contact, touch] : near) {
    if (contacts_taken.count(contact) != 0 || touches_taken.count(touch) != 0) continue;
    contacts_taken.insert(contact);
    touches_taken.insert(touch);
    places.emplace_back(contact, touches[touch].contact.place);
  }
  return places;
}

// The surface's point at that share of the way between two on triangles that are one, or beside
// each other. None where that is a vertex.
std::optional<SurfacePoint> TouchFinder::between(const SurfacePoint& from, const SurfacePoint& to,
                                                 double share) const {
  const Vec3 there = (1.0 - share) * placeOf(from) + share * placeOf(to);
  SurfacePoint nearest;
  double nearest_off = std::numeric_limits<double>::infinity();
  for (const int triangle : {from.triangle, to.triangle}) {
    const SurfacePoint point = {triangle, nearestInTriangle(there, cornersOf(triangle))};
    const double off = (placeOf(point) - there).norm();
    if (off >= nearest_off) continue;
    nearest_off = off;
    nearest = point;
  }
  if (nearest.barycentric.maxCoeff() > tuning::kAtVertex) return std::nullopt;
  return nearest;
}

Vec3 TouchFinder::placeOf(const SurfacePoint& point) const {
  return pointOf(cornersOf(point.triangle), point.barycentric);
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
