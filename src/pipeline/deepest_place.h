// Where the curved surface over a triangle is deepest in a link: not where the triangle is (own).
#pragma once

#include <optional>
#include <vector>

#include "robot_tissue/core/curved_surface.h"
#include "world.h"

namespace robot_tissue {

class DeepestPlace {
 public:
  // A place on the triangle, the curved surface's point there, and its way out of the link.
  struct Place {
    Vec3 weights;  // of the triangle's corners
    Vec3 bulge;    // off the triangle (m)
    Vec3 point;    // m
    Vec3 normal;   // of the way out, from the link into the tissue
    double depth;  // m
  };

  // Of a contact's triangle and link; the surface is at `vertices` (m), and curved by that share
  // (1) of what `curved` says.
  DeepestPlace(const World& world, const CurvedSurface& curved, double share, const RobotPose& pose,
               const std::vector<Vec3>& vertices, const Contact& contact);

  // By steps along the depth's slope, from where these weights are. None: no way out is known
  // there.
  std::optional<Place> from(const Vec3& weights) const;

 private:
  std::optional<Place> placeAt(const Vec3& weights) const;
  Vec3 deeperFrom(const Place& place) const;

  const World& world_;
  const CurvedSurface& curved_;
  double share_;
  std::size_t link_;
  const Pose& tissue_T_link_;
  int triangle_;
  Eigen::Matrix3d corners_;  // a column each (m)
  double spacing_;           // m
};

}  // namespace robot_tissue
