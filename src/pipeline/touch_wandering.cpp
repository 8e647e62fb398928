// Touches that wander: where a sharp edge or corner of a link is between the surface's vertices.
#include <algorithm>
#include <cmath>
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
  const auto edge = edgeAt(touch.contact.place);
  const auto is_found = [&](const Contact& contact) {
    if (!contact.wanders || contact.link != touch.contact.link) return false;
    const auto other = edgeAt(contact.place);
    if (!edge || !other) return contact.place.triangle == touch.contact.place.triangle;
    return other->vertices == edge->vertices;
  };
  if (std::any_of(found.contacts.begin(), found.contacts.end(), is_found)) return std::nullopt;
  const TissueSurface& surface = world_.tissue.surface();
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
  contact.point.setZero();
  for (int k = 0; k < 3; ++k) {
    const int vertex = surface.triangles[at(contact.place.triangle)][at(k)];
    contact.point += contact.place.barycentric[k] * vertices_[at(vertex)];
  }
  curve(contact);
  if (!turn(pose, contact)) return std::nullopt;
  contact.turn = curved_.hollowAt(contact.place);
  return contact;
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
