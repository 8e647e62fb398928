// ContactFinder: what is asked of its links alone, wherever the tissue is.
#include <algorithm>
#include <limits>
#include <optional>

#include "collision_shape.h"
#include "contact_search.h"
#include "flat_face.h"
#include "shape_face.h"
#include "shape_gap.h"
#include "tuning.h"

namespace robot_tissue {

std::size_t ContactFinder::linkCount() const { return impl_->links.size(); }

void ContactFinder::useShapes(std::size_t link, std::size_t count) {
  if (impl_->links[link].shapesInUse() == count) return;
  impl_->links[link].useShapes(count);
  impl_->found = {};
}

double ContactFinder::reach(std::size_t link) const { return impl_->links[link].reach(); }

std::vector<Vec3> ContactFinder::corners(std::size_t link) const {
  return impl_->links[link].corners();
}

std::vector<Vec3> ContactFinder::surfacePoints(std::size_t link) const {
  return impl_->links[link].surfacePoints();
}

std::vector<Vec3> ContactFinder::innerPoints(std::size_t link) const {
  return impl_->links[link].innerPoints();
}

double ContactFinder::thickness(std::size_t link) const { return impl_->links[link].thickness(); }

double ContactFinder::thickness(const Contact& contact) const {
  const TouchingLink& link = impl_->links[at(contact.link)];
  return contact.shape < 0 ? link.thickness() : link.shapes[at(contact.shape)].thickness();
}

double ContactFinder::thicknessIn(const Box& box, std::size_t link,
                                  const Pose& tissue_T_link) const {
  return impl_->links[link].thicknessIn(box, tissue_T_link);
}

std::vector<double> ContactFinder::thicknesses(std::size_t link) const {
  std::vector<double> all;
  for (const CollisionShape& shape : impl_->links[link].shapes) all.push_back(shape.thickness());
  return all;
}

std::vector<ToolIndenter> ContactFinder::indenters(std::size_t link) const {
  return impl_->links[link].indenters();
}

Box ContactFinder::bounds(std::size_t link, const Pose& tissue_T_link) const {
  return boundsOf(impl_->links[link].placedAt(tissue_T_link));
}

const std::vector<std::string>& ContactFinder::warnings() const { return impl_->warnings; }

std::optional<WayOut> ContactFinder::wayOut(std::size_t link, const Pose& tissue_T_link,
                                            const Vec3& point, double reach) const {
  return impl_->links[link].wayOutAt(tissue_T_link, point, reach);
}

// Sphere tracing (Hart 1996): at a depth d every way out to `clear` off the link is at least d +
// clear long, so the probe goes as far at once; a least step ends ways that graze the link.
std::optional<WayOut> ContactFinder::wayOutAlong(std::size_t link, const Pose& tissue_T_link,
                                                 const Vec3& point, const Vec3& direction,
                                                 double clear, double reach,
                                                 double farthest) const {
  double gone = 0.0;
  while (gone <= farthest) {
    const Vec3 probe = point + gone * direction;
    const auto out = wayOut(link, tissue_T_link, probe, std::max(reach, 2.0 * clear));
    if (!out) return std::nullopt;
    if (out->depth_m <= -0.9 * clear) {
      return WayOut{out->depth_m + gone * out->normal.dot(direction), out->normal};
    }
    gone += std::max(out->depth_m + clear, tuning::kLeastStep * clear);
  }
  return std::nullopt;
}

bool ContactFinder::hasFlatFaces(std::size_t link) const {
  const TouchingLink& of = impl_->links[link];
  const auto end = of.shapes.begin() + static_cast<std::ptrdiff_t>(of.shapesInUse());
  return std::any_of(of.shapes.begin(), end,
                     [](const CollisionShape& shape) { return robot_tissue::hasFlatFaces(shape); });
}

std::optional<FlatFace> ContactFinder::flatFace(std::size_t link, const Pose& tissue_T_link,
                                                const Vec3& facing, const Vec3& point,
                                                double reach) const {
  return flatFaceOf(impl_->links[link].placedAt(tissue_T_link), facing, point, reach);
}

bool ContactFinder::hasMesh(std::size_t link) const {
  const std::vector<CollisionShape>& shapes = impl_->links[link].shapes;
  return std::any_of(shapes.begin(), shapes.end(),
                     [](const CollisionShape& shape) { return shape.isMesh(); });
}

double ContactFinder::gap(std::size_t link, std::size_t other, const RobotPose& pose,
                          double reach) const {
  requireLinks(pose, impl_->links.size());
  const TouchingLink& a = impl_->links[link];
  const TouchingLink& b = impl_->links[other];
  const PlacedLink a_here = a.placedAt(pose.links[link]);
  const PlacedLink b_here = b.placedAt(pose.links[other]);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a_here.size(); ++i) {
    for (std::size_t j = 0; j < b_here.size(); ++j) {
      const double gap =
          gapBetween({&a_here[i], &a.gap_shapes[i], &a.surface_points[i]},
                     {&b_here[j], &b.gap_shapes[j], &b.surface_points[j]}, std::min(least, reach));
      least = std::min(least, gap);
    }
  }
  return least;
}

}  // namespace robot_tissue
