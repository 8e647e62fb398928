#include "robot_tissue/contact/contact_finder.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "contact_search.h"
#include "link_penetration.h"
#include "surface_traversal.h"

namespace robot_tissue {
namespace {

void requireVertices(const TissueSurface& surface, const std::vector<Vec3>& vertices) {
  if (vertices.size() == surface.rest.size()) return;
  throw InputError("surface: has " + std::to_string(vertices.size()) +
                   " deformed vertices; allowed is one for each of its " +
                   std::to_string(surface.rest.size()) + " vertices");
}

}  // namespace

void requireLinks(const RobotPose& pose, std::size_t links) {
  if (pose.links.size() == links) return;
  throw InputError("robot pose: has " + std::to_string(pose.links.size()) +
                   " links; allowed is one for each of the " + std::to_string(links) +
                   " links of the scene's tools");
}

ContactFinder::~ContactFinder() = default;
ContactFinder::ContactFinder(ContactFinder&&) noexcept = default;
ContactFinder& ContactFinder::operator=(ContactFinder&&) noexcept = default;

ContactFinder::ContactFinder(const std::vector<ToolGeometry>& tools)
    : impl_(std::make_unique<Impl>()) {
  for (std::size_t t = 0; t < tools.size(); ++t) {
    for (const LinkGeometry& link : tools[t].links) {
      impl_->links.emplace_back(static_cast<int>(t), tools[t].name, link, impl_->warnings);
      impl_->broad_phase.addLink(impl_->links.back().shapes);
    }
  }
}

void ContactFinder::forget() {
  impl_->found = {};
  for (TouchingLink& link : impl_->links) {
    link.face_pairs.assign(link.shapes.size(), {});
    link.known_minima.assign(link.shapes.size(), {});
    link.clear_points.assign(link.shapes.size(), {});
  }
}

std::shared_ptr<const ContactFinder::Kept> ContactFinder::kept() const {
  auto kept = std::make_shared<Kept>();
  kept->found = impl_->found;
  kept->is_found_of_tree = impl_->found.move == impl_->surface_tree.moves();
  kept->known_minima_of = impl_->known_minima_of;
  for (const TouchingLink& link : impl_->links) {
    kept->face_pairs.push_back(link.face_pairs);
    kept->known_minima.push_back(link.known_minima);
  }
  return kept;
}

void ContactFinder::restore(const Kept& kept, const TissueSurface& surface,
                            const std::vector<Vec3>& vertices) const {
  for (std::size_t link = 0; link < impl_->links.size(); ++link) {
    impl_->links[link].face_pairs = kept.face_pairs[link];
    impl_->links[link].known_minima = kept.known_minima[link];
  }
  impl_->known_minima_of = kept.known_minima_of;
  if (impl_->surface_tree.exists()) impl_->surface_tree.of(surface, vertices);
  impl_->found = kept.found;
  if (kept.is_found_of_tree) impl_->found.move = impl_->surface_tree.moves();
}

void ContactFinder::followPlaces() { impl_->follows_places = true; }

ContactSet ContactFinder::findAgain(const RobotPose& pose, const TissueSurface& surface,
                                    const std::vector<Vec3>& vertices, double margin,
                                    double way) const {
  requireLinks(pose, impl_->links.size());
  requireVertices(surface, vertices);
  impl_->boundsOf(surface, vertices);  // moves the tree
  if (impl_->knowsAll(pose, margin) || !impl_->knowsPlaces(pose, margin, way)) {
    return find(pose, surface, vertices, margin);
  }
  ContactSet again;
  for (Contact contact : impl_->found.contacts.contacts) {
    const std::size_t link = at(contact.link);
    const auto out = wayOut(link, pose.links[link], contact.point, margin);
    if (!out || out->depth_m <= -margin) continue;
    contact.depth_m = out->depth_m;
    if (!out->normal.isZero()) contact.normal = out->normal;
    again.contacts.push_back(contact);
  }
  return again;
}

std::vector<PlacedLink> ContactFinder::Impl::placedAt(const RobotPose& pose) const {
  std::vector<PlacedLink> here;
  for (std::size_t i = 0; i < links.size(); ++i) {
    here.push_back(links[i].placedAt(pose.links[i]));
  }
  return here;
}

void ContactFinder::Impl::addContacts(const PlacedLink& here, std::size_t link,
                                      const std::vector<std::size_t>& near_shapes,
                                      const TissueSurface& surface,
                                      const std::vector<Vec3>& vertices, double margin,
                                      Places places, ContactSet& contacts) {
  const TriangleBvh& tree = surface_tree.last();
  std::vector<int> triangles;
  std::vector<const FacePairs*> faces(here.size(), nullptr);
  for (const std::size_t shape : near_shapes) {
    const std::vector<int> near = trianglesNear(here[shape], tree, margin);
    triangles.insert(triangles.end(), near.begin(), near.end());
    if (!here[shape].shape->isMesh()) continue;
    faces[shape] = &links[link].face_pairs[shape].of(here[shape], tree, surface_tree.trees(),
                                                     vertices, margin);
  }
  if (near_shapes.size() > 1) {
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  }
  if (known_minima_of != surface_tree.trees()) forgetMinima();
  if (places == Places::kFollowed) {
    for (KnownMinima& minima : links[link].known_minima) minima.beginSearch();
  }
  const LinkContacts::Asked asked{here,
                                  links[link].tool,
                                  static_cast<int>(link),
                                  triangles,
                                  faces,
                                  places == Places::kAnew ? nullptr : &links[link].known_minima,
                                  margin};
  link_contacts.find(asked, surface, vertices, contacts);
}

ContactSet ContactFinder::find(const RobotPose& pose, const TissueSurface& surface,
                               const std::vector<Vec3>& vertices, double margin) const {
  requireLinks(pose, impl_->links.size());
  requireVertices(surface, vertices);
  const Box bounds = impl_->boundsOf(surface, vertices);
  if (impl_->knowsAll(pose, margin)) return impl_->found.contacts;
  const std::vector<PlacedLink> links = impl_->placedAt(pose);
  std::vector<std::vector<std::size_t>> near_shapes(links.size());
  const auto near = impl_->broad_phase.nearTo(bounds, links, margin);
  if (!near.empty() && !impl_->surface_tree.exists()) impl_->surface_tree.of(surface, vertices);
  for (const auto& [link, shape] : near) near_shapes[link].push_back(shape);
  ContactSet found;
  for (std::size_t link = 0; link < links.size(); ++link) {
    if (near_shapes[link].empty()) continue;
    impl_->addContacts(links[link], link, near_shapes[link], surface, vertices, margin,
                       impl_->follows_places ? Places::kFollowed : Places::kAnew, found);
  }
  impl_->found = {impl_->surface_tree.moves(), pose, margin, found};
  return found;
}

// `surface_tree` must be of these vertices.
double ContactFinder::Impl::penetration(const PlacedLink& here, std::size_t link,
                                        const Pose& tissue_T_link, const TissueSurface& surface,
                                        const std::vector<Vec3>& vertices, const Bulge& bulge) {
  const bool is_known = knows(link, tissue_T_link);
  ContactSet asked;
  if (!is_known) {
    std::vector<std::size_t> shapes(here.size());
    std::iota(shapes.begin(), shapes.end(), std::size_t{0});
    addContacts(here, link, shapes, surface, vertices, 0.0, Places::kAnew, asked);
  }
  const auto of_link = [&](const SurfacePoint& point) -> Vec3 {
    return bulge ? bulge(link, point) : Vec3::Zero();
  };
  double deepest = 0.0;
  for (const Contact& contact : (is_known ? found.contacts : asked).contacts) {
    if (at(contact.link) != link) continue;
    const Vec3 off_triangle = of_link(contact.place);
    if (contact.depth_m + off_triangle.norm() <= deepest) continue;
    const auto out = links[link].wayOutAt(tissue_T_link, contact.point + off_triangle, 0.0);
    if (out) deepest = std::max(deepest, out->depth_m);
  }
  for (std::size_t i = 0; i < here.size(); ++i) {
    const std::vector<Vec3>& points = links[link].surface_points[i];
    const TriangleBvh& tree = surface_tree.last();
    ClearPoints& clear = links[link].clear_points[i];
    clear.beginLook(here[i], surface_tree.trees(), vertices, points.size());
    deepest = deepestInside(here[i], points, tree, of_link, deepest, clear);
  }
  return deepest;
}

std::vector<double> ContactFinder::penetrations(const std::vector<std::size_t>& links,
                                                const RobotPose& pose, const TissueSurface& surface,
                                                const std::vector<Vec3>& vertices,
                                                const Bulge& bulge) const {
  requireLinks(pose, impl_->links.size());
  requireVertices(surface, vertices);
  std::vector<double> depths(links.size(), 0.0);
  const Box bounds = impl_->boundsOf(surface, vertices);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const PlacedLink here = impl_->links[links[i]].placedAt(pose.links[links[i]]);
    if (!robot_tissue::boundsOf(here).intersects(bounds)) continue;
    if (!impl_->surface_tree.exists()) impl_->surface_tree.of(surface, vertices);
    depths[i] = impl_->penetration(here, links[i], pose.links[links[i]], surface, vertices, bulge);
  }
  return depths;
}

bool ContactFinder::isInside(const Vec3& point, const TissueSurface& surface,
                             const std::vector<Vec3>& vertices) const {
  requireVertices(surface, vertices);
  return impl_->boundsOf(surface, vertices).contains(point) &&
         impl_->surface_tree.of(surface, vertices).isInside(point);
}

}  // namespace robot_tissue
