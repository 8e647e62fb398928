// Finds the points of the deformed surface that are inside a tool.
// In: tool poses (tissue frame), deformed surface vertices (m, tissue frame).
// Out: contacts with depth > -touch_margin; normal from the tool into the tissue. In order of
// tools, then of triangles; a point in several shapes of a tool is one contact, with the deepest of
// them. FCL objects are built once, in the constructor. A mesh touches with its convex hull.
// Sampled: vertices; points on triangles, at most half of the thinnest shape apart and, for a tool
// with edges, a quarter of a triangle's edge (down to an eighth of it); and the points of the
// triangles nearest to the shapes' centers.
// Does not find a tool that lies wholly beneath the surface. A tool whose pose is not finite and
// rigid touches nothing.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/surface.h"

namespace robot_tissue {

class ContactFinder {
 public:
  // Points up to touch_margin (m) outside a tool are found, too, with a depth <= 0.
  // Throws InputError: a mesh that cannot be loaded or has no volume, a measure that is not > 0.
  explicit ContactFinder(const std::vector<ToolGeometry>& tools, double touch_margin = 0.0);
  ~ContactFinder();
  ContactFinder(ContactFinder&&) noexcept;
  ContactFinder& operator=(ContactFinder&&) noexcept;

  // Farthest that a point of the tool is from the tool's origin (m); 0 without shapes.
  double reach(std::size_t tool) const;

  // Mean place of the tool's shapes, tool frame (m).
  Vec3 center(std::size_t tool) const;

  // One line each, e.g. a mesh that is not convex.
  const std::vector<std::string>& warnings() const;

  // Throws InputError when the pose has not one entry a tool or the surface not one vertex each.
  ContactSet find(const RobotPose& pose, const Surface& surface, const std::vector<Vec3>& vertices);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace robot_tissue
