// Where the tools touch the tissue, and which way out of them the tissue's points go.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "robot_tissue/core/curved_surface.h"
#include "robot_tissue/core/triangle_point.h"
#include "tool_rims.h"
#include "world.h"

namespace robot_tissue {

// What a look at the touches leaves to the next.
struct TouchState {
  std::vector<double> depths;  // in each link, of the deepest point, by the nearest way out (m)
  std::vector<double> smooth;  // per link (1): how much of the surface that it touches is smooth
  RimState rims;
};

class TouchFinder {
 public:
  // The state is kept by the caller; the time that it takes is added to `contact_ms`.
  TouchFinder(const World& world, TouchState& state, double& contact_ms)
      : world_(world), state_(state), contact_ms_(contact_ms), rims_(world, state.rims) {}

  // With gaps that a solve may close: of the triangles. Where no tool went farther than `way` (m)
  // since the last search of this shape, at the places that it found; so touchesAt.
  ContactSet contactsAt(const RobotPose& pose, const std::vector<Vec3>& displacement,
                        double way = 0.0);
  // Of tools that stick alone, with the planes that turnOut finds.
  ContactSet stickingAt(const RobotPose& pose, const std::vector<Vec3>& displacement);
  // Of the curved surface with its vertices there.
  ContactSet contactsOf(const RobotPose& pose, const std::vector<Vec3>& vertices);
  ContactSet touchesAt(const RobotPose& pose, const std::vector<std::uint8_t>& held,
                       double way = 0.0);
  // After touchesAt.
  std::vector<std::optional<Contact>> trackTouches(const RobotPose& pose, const ContactSet& found);
  // As trackTouches, of those that wander alone; none of the others.
  std::vector<std::optional<Contact>> trackWandering(const RobotPose& pose,
                                                     const ContactSet& found) const;
  // Takes those of them that wander back, to a part of the way from the touches that were there
  // before.
  void wanderPartOfWay(const RobotPose& pose, ContactSet& found) const;
  // How deep each of these links is in the surface that it touches (m), as
  // ContactFinder::penetrations.
  std::vector<double> penetrations(const std::vector<std::size_t>& links, const RobotPose& pose);
  bool wouldTouchAtRest(const RobotPose& pose);

  void beginStep() { rims_.beginStep(); }
  const ToolRims& rims() const { return rims_; }  // of the last touchesAt
  // Of a contact that is so deep (m): without what the laws of rims and of narrow contacts, as they
  // are taken now, leave it.
  double ownDepth(const Contact& contact, double depth) const;

  // In each link, of the deepest point of the last touchesAt, by the nearest way out (m).
  const std::vector<double>& depths() const { return state_.depths; }
  void restoreDepths(const std::vector<double>& depths) { state_.depths = depths; }

 private:
  // Of the surface's triangles: numbers of its ends, the lower first, and which corners these are.
  struct Edge {
    std::array<int, 2> corners;
    std::array<int, 2> vertices;
  };
  bool wanders(const RobotPose& pose, const Contact& contact) const;
  std::optional<Edge> edgeAt(const SurfacePoint& place) const;
  std::optional<Contact> goAlong(const RobotPose& pose, const ContactSet& found,
                                 const SlidingContacts::ContactConstraint& touch) const;
  bool wanderTo(const SurfacePoint& place, const RobotPose& pose, Contact& contact) const;
  std::vector<std::pair<std::size_t, SurfacePoint>> placesBefore(const ContactSet& found) const;
  std::optional<SurfacePoint> between(const SurfacePoint& from, const SurfacePoint& to,
                                      double share) const;
  Vec3 placeOf(const SurfacePoint& point) const;
  Corners cornersOf(int triangle) const;
  bool areBeside(int one, int other) const;
  std::set<std::pair<int, int>> verticesComeIn() const;
  Vec3 inwardsAt(const Contact& contact) const;
  Vec3 inwardsBetween(const Contact& contact) const;
  ContactSet flatContacts(const RobotPose& pose, const std::vector<Vec3>& vertices,
                          double way = 0.0) const;
  void curve(Contact& contact) const;
  bool deepen(const RobotPose& pose, const std::vector<Vec3>& vertices, Contact& contact) const;
  bool turnOut(const RobotPose& pose, Contact& contact) const;
  bool turnAside(const RobotPose& pose, Contact& contact) const;
  bool turn(const RobotPose& pose, Contact& contact) const;
  std::vector<double> smoothnesses(const RobotPose& pose, const ContactSet& contacts,
                                   const std::vector<Vec3>& vertices) const;
  void takeRims(const std::vector<std::uint8_t>& held, ContactSet& contacts);

  const World& world_;
  TouchState& state_;
  double& contact_ms_;
  ToolRims rims_;
  std::vector<Vec3> vertices_;  // of the last contacts
  CurvedSurface curved_;
};

}  // namespace robot_tissue
