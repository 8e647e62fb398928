// Where the tools touch the tissue, and which way out of them the tissue's points go.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "tool_rims.h"
#include "vertex_areas.h"
#include "world.h"

namespace robot_tissue {

class TouchFinder {
 public:
  explicit TouchFinder(World& world) : world_(world), rims_(world) {}

  // With gaps that a solve may close.
  ContactSet contactsAt(const RobotPose& pose, const std::vector<Vec3>& displacement,
                        double way = 0.0);
  // Likewise, of the surface with its vertices there.
  ContactSet contactsOf(const RobotPose& pose, const std::vector<Vec3>& vertices,
                        double way = 0.0) const;
  // Where no tool went farther than `way` (m) since the last search of this shape, at the places
  // that it found.
  ContactSet touchesAt(const RobotPose& pose, const std::vector<std::uint8_t>& held,
                       double way = 0.0);
  // After touchesAt.
  std::vector<std::optional<Contact>> trackTouches(const RobotPose& pose);
  bool wouldTouchAtRest(const RobotPose& pose);

  void beginStep() { rims_.beginStep(); }
  const ToolRims& rims() const { return rims_; }  // of the last touchesAt

  // In each link, of the deepest point of the last touchesAt, by the nearest way out (m).
  const std::vector<double>& depths() const { return depths_; }
  void restoreDepths(const std::vector<double>& depths) { depths_ = depths; }

 private:
  std::set<std::pair<int, int>> verticesComeIn() const;
  Vec3 inwardsAt(const Contact& contact) const;
  Vec3 inwardsBetween(const Contact& contact) const;
  bool turnOut(const RobotPose& pose, Contact& contact) const;
  bool turnAside(const RobotPose& pose, Contact& contact) const;
  bool turn(const RobotPose& pose, Contact& contact) const;
  void findSmooth(const RobotPose& pose, const ContactSet& contacts);
  void takeRims(const std::vector<std::uint8_t>& held, ContactSet& contacts);

  World& world_;
  ToolRims rims_;
  std::vector<Vec3> vertices_;  // of the last contacts
  VertexAreas areas_;
  std::vector<double> depths_;
  std::vector<double> smooth_;  // per link (1): how much of the surface that it touches is smooth
};

}  // namespace robot_tissue
