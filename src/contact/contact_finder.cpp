#include "robot_tissue/contact/contact_finder.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "collision_shape.h"
#include "link_contacts.h"
#include "link_penetration.h"
#include "placed_link.h"
#include "shape_gap.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

struct Link {
  int tool = 0;
  std::vector<CollisionShape> shapes;
  std::vector<GapShape> gap_shapes;               // as shapes
  std::vector<std::vector<Vec3>> surface_points;  // as shapes; shape's frame (m)
};

Link makeLink(int tool, const std::string& tool_name, const LinkGeometry& geometry,
              std::vector<std::string>& warnings) {
  Link link;
  link.tool = tool;
  const std::string owner =
      "tool '" + tool_name + "'" + (geometry.link.empty() ? "" : ", link '" + geometry.link + "'");
  for (std::size_t i = 0; i < geometry.shapes.size(); ++i) {
    link.shapes.emplace_back(geometry.shapes[i], owner + ", shape " + std::to_string(i + 1),
                             warnings);
    link.gap_shapes.emplace_back(link.shapes.back());
    link.surface_points.push_back(surfacePoints(link.shapes.back()));
  }
  return link;
}

void requireVertices(const Surface& surface, const std::vector<Vec3>& vertices) {
  if (vertices.size() == surface.rest.size()) return;
  throw InputError("surface: has " + std::to_string(vertices.size()) +
                   " deformed vertices; allowed is one for each of its " +
                   std::to_string(surface.rest.size()) + " vertices");
}

void requireLinks(const RobotPose& pose, std::size_t links) {
  if (pose.links.size() == links) return;
  throw InputError("robot pose: has " + std::to_string(pose.links.size()) +
                   " links; allowed is one for each of the " + std::to_string(links) +
                   " links of the scene's tools");
}

// The tree over a surface: made from its rest shape, so that it depends on nothing before, and
// moved to the deformed one.
class SurfaceTree {
 public:
  const AabbTree& of(const Surface& surface, const std::vector<Vec3>& vertices) {
    if (!tree_ || surface.rest != rest_ || surface.triangles != triangles_) {
      rest_ = surface.rest;
      triangles_ = surface.triangles;
      tree_.emplace(rest_, triangles_);
      vertices_.clear();
    }
    if (vertices != vertices_) {
      vertices_ = vertices;
      tree_->moveTo(vertices_);
    }
    return *tree_;
  }

 private:
  std::vector<Vec3> rest_, vertices_;
  std::vector<MeshTriangle> triangles_;
  std::optional<AabbTree> tree_;
};

}  // namespace

struct ContactFinder::Impl {
  std::vector<Link> links;
  std::vector<std::string> warnings;

  // What the last find() met.
  struct Found {
    RobotPose pose;
    std::vector<Vec3> vertices;
    std::vector<MeshTriangle> triangles;
    std::vector<double> deepest;  // per link (m)
  };
  std::optional<double> deepestFound(std::size_t link, const Pose& tissue_T_link,
                                     const Surface& surface,
                                     const std::vector<Vec3>& vertices) const {
    const bool same = link < found.deepest.size() && found.vertices == vertices &&
                      found.triangles == surface.triangles &&
                      found.pose.links[link].matrix() == tissue_T_link.matrix();
    return same ? std::optional<double>(found.deepest[link]) : std::nullopt;
  }

  // Scratch.
  LinkContacts contacts;
  SurfaceTree surface_tree;
  Found found;
};

ContactFinder::~ContactFinder() = default;
ContactFinder::ContactFinder(ContactFinder&&) noexcept = default;
ContactFinder& ContactFinder::operator=(ContactFinder&&) noexcept = default;

ContactFinder::ContactFinder(const std::vector<ToolGeometry>& tools)
    : impl_(std::make_unique<Impl>()) {
  for (std::size_t t = 0; t < tools.size(); ++t) {
    for (const LinkGeometry& link : tools[t].links) {
      impl_->links.push_back(makeLink(static_cast<int>(t), tools[t].name, link, impl_->warnings));
    }
  }
}

std::size_t ContactFinder::linkCount() const { return impl_->links.size(); }

double ContactFinder::reach(std::size_t link) const {
  double farthest = 0.0;
  for (const CollisionShape& shape : impl_->links[link].shapes) {
    if (shape.isPlane()) continue;
    const Box& box = shape.bounds();
    const Vec3 middle = shape.poseInLink() * Vec3(0.5 * (box.min() + box.max()));
    const Vec3 half = 0.5 * (box.max() - box.min());
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 signs((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                       (corner & 4) != 0 ? 1.0 : -1.0);
      const Vec3 away = middle + shape.poseInLink().linear() * half.cwiseProduct(signs);
      farthest = std::max(farthest, away.norm());
    }
  }
  return farthest;
}

Vec3 ContactFinder::center(std::size_t link) const {
  Vec3 sum = Vec3::Zero();
  const auto& shapes = impl_->links[link].shapes;
  for (const CollisionShape& shape : shapes) sum += shape.poseInLink().translation();
  return shapes.empty() ? sum : Vec3(sum / static_cast<double>(shapes.size()));
}

double ContactFinder::thickness(std::size_t link) const {
  double thinnest = std::numeric_limits<double>::infinity();
  for (const CollisionShape& shape : impl_->links[link].shapes) {
    thinnest = std::min(thinnest, shape.thickness());
  }
  return thinnest;
}

Box ContactFinder::bounds(std::size_t link, const Pose& tissue_T_link) const {
  return boundsOf(placed(impl_->links[link].shapes, tissue_T_link));
}

const std::vector<std::string>& ContactFinder::warnings() const { return impl_->warnings; }

ContactSet ContactFinder::find(const RobotPose& pose, const Surface& surface,
                               const std::vector<Vec3>& vertices, double margin) const {
  requireLinks(pose, impl_->links.size());
  requireVertices(surface, vertices);
  ContactSet found;
  for (std::size_t i = 0; i < impl_->links.size(); ++i) {
    const Link& link = impl_->links[i];
    impl_->contacts.find(placed(link.shapes, pose.links[i]), link.tool, static_cast<int>(i),
                         surface, vertices, margin, found);
  }
  impl_->found.pose = pose;
  impl_->found.vertices = vertices;
  impl_->found.triangles = surface.triangles;
  impl_->found.deepest.assign(impl_->links.size(), 0.0);
  for (const Contact& contact : found.contacts) {
    double& deepest = impl_->found.deepest[at(contact.link)];
    deepest = std::max(deepest, contact.depth_m);
  }
  return found;
}

std::optional<WayOut> ContactFinder::wayOut(std::size_t link, const Pose& tissue_T_link,
                                            const Vec3& point, double reach) const {
  return robot_tissue::wayOut(placed(impl_->links[link].shapes, tissue_T_link), point, reach);
}

// Sphere tracing: from a point at a signed distance the way out is at least as long as that.
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

double ContactFinder::penetration(std::size_t link, const Pose& tissue_T_link,
                                  const Surface& surface, const std::vector<Vec3>& vertices) const {
  requireVertices(surface, vertices);
  const PlacedLink here = placed(impl_->links[link].shapes, tissue_T_link);
  Box surface_box;
  for (const Vec3& vertex : vertices) {
    if (vertex.allFinite()) surface_box.extend(vertex);
  }
  if (here.empty() || !boxesMeet(boundsOf(here), surface_box, 0.0)) return 0.0;
  const auto known = impl_->deepestFound(link, tissue_T_link, surface, vertices);
  double deepest = known.value_or(0.0);
  if (!known) {
    ContactSet found;
    impl_->contacts.find(here, 0, 0, surface, vertices, 0.0, found);
    for (const Contact& contact : found.contacts) deepest = std::max(deepest, contact.depth_m);
  }
  const AabbTree& tree = impl_->surface_tree.of(surface, vertices);
  for (std::size_t i = 0; i < here.size(); ++i) {
    deepest = deepestInside(here[i], impl_->links[link].surface_points[i], tree, deepest);
  }
  return deepest;
}

double ContactFinder::gap(std::size_t link, std::size_t other, const RobotPose& pose) const {
  requireLinks(pose, impl_->links.size());
  const Link& a = impl_->links[link];
  const Link& b = impl_->links[other];
  const PlacedLink a_here = placed(a.shapes, pose.links[link]);
  const PlacedLink b_here = placed(b.shapes, pose.links[other]);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a_here.size(); ++i) {
    for (std::size_t j = 0; j < b_here.size(); ++j) {
      least = std::min(least, gapBetween({&a_here[i], &a.gap_shapes[i], &a.surface_points[i]},
                                         {&b_here[j], &b.gap_shapes[j], &b.surface_points[j]}));
    }
  }
  return least;
}

}  // namespace robot_tissue
