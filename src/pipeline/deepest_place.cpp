#include "deepest_place.h"

#include "tuning.h"

namespace robot_tissue {

DeepestPlace::DeepestPlace(const World& world, const CurvedSurface& curved, double share,
                           const RobotPose& pose, const std::vector<Vec3>& vertices,
                           const Contact& contact)
    : world_(world),
      curved_(curved),
      share_(share),
      link_(at(contact.link)),
      tissue_T_link_(pose.links[link_]),
      triangle_(contact.place.triangle),
      spacing_(world.tissue.lattice().spacing()) {
  const MeshTriangle& corners = world.tissue.surface().triangles[at(triangle_)];
  for (int k = 0; k < 3; ++k) corners_.col(k) = vertices[at(corners[at(k)])];
}

std::optional<DeepestPlace::Place> DeepestPlace::from(const Vec3& weights) const {
  auto deepest = placeAt(weights);
  if (!deepest) return std::nullopt;
  Vec3 way = deeperFrom(*deepest);
  double step = tuning::kFirstDeepening;
  for (int look = 0; look < tuning::kDeepenings && step > tuning::kLastDeepening; ++look) {
    const double longest = way.cwiseAbs().maxCoeff();
    if (!(step * longest > tuning::kLeastDeepening * spacing_)) break;
    Vec3 next = (deepest->weights + step / longest * way).cwiseMax(0.0);
    next /= next.sum();
    const auto there = placeAt(next);
    if (there && there->depth > deepest->depth) {
      deepest = there;
      way = deeperFrom(*deepest);
    } else {
      step *= tuning::kShorterDeepening;
    }
  }
  return deepest;
}

std::optional<DeepestPlace::Place> DeepestPlace::placeAt(const Vec3& weights) const {
  const Vec3 bulge = share_ * curved_.bulgeAt({triangle_, weights});
  const Vec3 point = corners_ * weights + bulge;
  const auto out = world_.finder.wayOut(link_, tissue_T_link_, point, spacing_);
  if (!out || out->normal.isZero()) return std::nullopt;
  return Place{weights, bulge, point, out->normal, out->depth_m};
}

// How the depth changes with the weights (m), as their sum stays.
Vec3 DeepestPlace::deeperFrom(const Place& place) const {
  const Eigen::Matrix3d slopes =
      corners_ + share_ * curved_.bulgeSlopesAt({triangle_, place.weights});
  Vec3 way = -slopes.transpose() * place.normal;
  way.array() -= way.mean();
  return way;
}

}  // namespace robot_tissue
