#include "touch_finder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "deepest_place.h"
#include "robot_tissue/core/triangle_mesh.h"
#include "stopwatch.h"
#include "tuning.h"

namespace robot_tissue {

// The contact of each touch in the present shape: its point, and the plane of its link there.
std::vector<std::optional<Contact>> TouchFinder::trackTouches(const RobotPose& pose,
                                                              const ContactSet& found) {
  const Stopwatch watch(contact_ms_);
  std::vector<std::optional<Contact>> tracked;
  const std::set<std::pair<int, int>> come_in = verticesComeIn();
  curved_.take(world_.tissue.surface(), vertices_);
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    if (!touch.contact.rim.is_beyond && come_in.count({touch.contact.link, touch.vertex}) != 0) {
      tracked.emplace_back();
      continue;
    }
    if (touch.contact.wanders) {
      tracked.push_back(goAlong(pose, found, touch));
      continue;
    }
    if (!touch.contact.rim.edges.empty()) {
      tracked.push_back(rims_.atRim(touch.contact, vertices_));
      if (tracked.back() || touch.contact.rim.is_beyond) continue;
      tracked.pop_back();
    }
    Contact contact = touch.contact;
    contact.normal = touch.spring.normal;
    contact.depth_m = 0.0;
    contact.point = pointOf(touch.spring, world_.tissue.state().displacement) - contact.bulge;
    curve(contact);
    const bool near = turn(pose, contact);
    rims_.mark(contact);
    const bool stays = near && !ToolRims::isTakenOver(contact);
    tracked.push_back(stays ? std::optional<Contact>(contact) : std::nullopt);
  }
  return tracked;
}

// Links and vertices whose touch beside a face has come under it since: what else of the tool they
// touched there, as its side, they do not any more.
std::set<std::pair<int, int>> TouchFinder::verticesComeIn() const {
  std::set<std::pair<int, int>> come_in;
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    if (!touch.contact.rim.is_beyond) continue;
    const std::optional<Contact> now = rims_.atRim(touch.contact, vertices_);
    if (now && !now->rim.is_beyond) come_in.insert({touch.contact.link, touch.vertex});
  }
  return come_in;
}

// Unit normal of the surface at the contact, into the tissue, as vertices and triangles have it;
// zero where it has none.
Vec3 TouchFinder::inwardsAt(const Contact& contact) const {
  const TissueSurface& surface = world_.tissue.surface();
  const int vertex = vertexAt(surface, contact.place);
  if (vertex >= 0) return -curved_.doubleAreaAt(vertex).normalized();
  return -doubleArea(vertices_, surface.triangles[at(contact.place.triangle)]).normalized();
}

// The same between vertices, of the curved surface: what slides along triangles would catch on
// facets as on teeth.
Vec3 TouchFinder::inwardsBetween(const Contact& contact) const {
  const double share = state_.smooth[at(contact.link)];
  const Vec3 smooth = curved_.normalAt(contact.place);
  return ((1.0 - share) * inwardsAt(contact) - share * smooth).normalized();
}

// Brings a contact, which is of a triangle, onto the curved surface that was taken. Its depth to
// first order.
void TouchFinder::curve(Contact& contact) const {
  const TissueSurface& surface = world_.tissue.surface();
  const double share = state_.smooth[at(contact.link)];
  contact.bulge.setZero();
  if (share == 0.0 || vertexAt(surface, contact.place) >= 0) return;
  contact.bulge = share * curved_.bulgeAt(contact.place);
  contact.point += contact.bulge;
  contact.depth_m -= contact.bulge.dot(contact.normal);
}

// A triangle's deepest point is not where the curved surface over it is deepest: there it goes.
// False: it stays.
bool TouchFinder::deepen(const RobotPose& pose, const std::vector<Vec3>& vertices,
                         Contact& contact) const {
  const double share = state_.smooth[at(contact.link)];
  const bool is_off = contact.depth_m < -tuning::kDeepenedFrom * world_.tissue.lattice().spacing();
  if (share == 0.0 || is_off || vertexAt(world_.tissue.surface(), contact.place) >= 0) return false;
  const DeepestPlace deepest(world_, curved_, share, pose, vertices, contact);
  const auto place = deepest.from(contact.place.barycentric);
  if (!place) return false;
  contact.place.barycentric = place->weights;
  contact.bulge = place->bulge;
  contact.point = place->point;
  contact.normal = place->normal;
  contact.depth_m = place->depth;
  return true;
}

// What is thinner than half a spacing is among so few triangles that these count by themselves, one
// thicker than a spacing touches the smooth surface. Under a flat face normals are the face's;
// triangles at its edge lie partly on it, and their smooth normals would let it in.
std::vector<double> TouchFinder::smoothnesses(const RobotPose& pose, const ContactSet& contacts,
                                              const std::vector<Vec3>& vertices) const {
  const double spacing = world_.tissue.lattice().spacing();
  std::vector<double> smooth(pose.links.size(), 0.0);
  std::map<int, double> thicknesses;  // of what touches (m)
  for (const Contact& contact : contacts.contacts) {
    if (rims_.isSticking(contact.tool)) continue;
    double& thinnest = thicknesses.try_emplace(contact.link, kInfinity).first->second;
    thinnest = std::min(thinnest, world_.finder.thickness(contact));
  }
  for (const auto& [link, thickness] : thicknesses) {
    const double thick = 2.0 * thickness / spacing - 1.0;
    if (thick <= 0.0) continue;
    smooth[at(link)] = std::min(1.0, thick) *
                       (1.0 - rims_.flatness(link, pose.links[at(link)], contacts, vertices));
  }
  return smooth;
}

// A tool presses a surface inwards, as the surface lies: that way its point goes out of the tool,
// also where another side of the tool is nearer, as at edges and on thin tools. Between vertices
// it is pressed along its own normal: what touches it there is a corner, an edge or a rim, which
// has none, or a round tool, which has the same one.
bool TouchFinder::turnOut(const RobotPose& pose, Contact& contact) const {
  const double spacing = world_.tissue.lattice().spacing();
  const std::size_t link = at(contact.link);
  const bool is_vertex = vertexAt(world_.tissue.surface(), contact.place) >= 0;
  const Vec3 inwards = is_vertex ? inwardsAt(contact) : inwardsBetween(contact);
  if (!(inwards.norm() > 0.0)) return false;
  const Pose& tissue_T_link = pose.links[link];
  const auto nearest =
      world_.finder.wayOut(link, tissue_T_link, contact.point, tuning::kReach * spacing);
  if (!nearest) return false;
  const double farthest =
      tuning::kDetour * std::max(nearest->depth_m, 0.0) +
      tuning::kDetourBeyond * std::min(spacing, world_.finder.thickness(contact));
  const double off =
      tuning::kOffEdge + state_.smooth[link] * (tuning::kOffSharpEdge - tuning::kOffEdge);
  const auto along = world_.finder.wayOutAlong(link, tissue_T_link, contact.point, inwards,
                                               off * spacing, tuning::kReach * spacing, farthest);
  const WayOut& out = along ? *along : *nearest;
  if (out.normal.norm() < 0.5) return true;
  contact.normal = out.normal;
  contact.depth_m = out.depth_m;
  const double cosine = out.normal.dot(inwards);
  if (!is_vertex && cosine > tuning::kSameSide) {
    const bool is_on_edge = contact.place.barycentric.minCoeff() <= tuning::kInsideTriangle;
    const double share = is_on_edge ? state_.smooth[link] : 1.0;
    contact.normal = (share * inwards + (1.0 - share) * out.normal).normalized();
    contact.depth_m = out.depth_m / contact.normal.dot(out.normal);
  }
  return true;
}

// The lips of a wound are pushed aside by the blade in it, each to the side that it looks from,
// from the middle of the blade on; ahead of its edge and behind its back it does not push. Where a
// lip is, is known to half a spacing: that is no overlap.
bool TouchFinder::turnAside(const RobotPose& pose, Contact& contact) const {
  const double spacing = world_.tissue.lattice().spacing();
  const std::size_t link = at(contact.link);
  const Pose& tissue_T_link = pose.links[link];
  const BladeSides& sides = world_.sidesOn(link);
  const Vec3 across = tissue_T_link.linear() * sides.across;
  const double side = across.dot(inwardsAt(contact));
  if (std::abs(side) < tuning::kLipLooksAside) return false;
  const Vec3 aside = side > 0.0 ? across : Vec3(-across);
  const double beyond = (contact.point - tissue_T_link * sides.middle).dot(aside);
  const Vec3 in_blade = contact.point - beyond * aside;
  if (!world_.finder.wayOut(link, tissue_T_link, in_blade, 0.0)) return false;
  const auto out =
      world_.finder.wayOutAlong(link, tissue_T_link, in_blade, aside, tuning::kOffEdge * spacing,
                                tuning::kReach * spacing, tuning::kReach * spacing);
  if (!out || out->normal.dot(aside) < tuning::kLipLooksAside) return false;
  contact.normal = out->normal;
  contact.depth_m = out->depth_m - beyond * aside.dot(out->normal) - tuning::kPlaceOfLip * spacing;
  return true;
}

bool TouchFinder::turn(const RobotPose& pose, Contact& contact) const {
  return world_.isInWound(at(contact.link)) ? turnAside(pose, contact) : turnOut(pose, contact);
}

ContactSet TouchFinder::contactsAt(const RobotPose& pose, const std::vector<Vec3>& displacement,
                                   double way) {
  const Stopwatch watch(contact_ms_);
  deform(world_.tissue.surface(), displacement, vertices_);
  return flatContacts(pose, vertices_, way);
}

ContactSet TouchFinder::stickingAt(const RobotPose& pose, const std::vector<Vec3>& displacement) {
  ContactSet contacts = contactsAt(pose, displacement);
  auto& all = contacts.contacts;
  const auto slides = [&](const Contact& contact) { return !rims_.isSticking(contact.tool); };
  all.erase(std::remove_if(all.begin(), all.end(), slides), all.end());
  if (all.empty()) return contacts;
  const Stopwatch watch(contact_ms_);
  curved_.take(world_.tissue.surface(), vertices_);
  state_.smooth.resize(pose.links.size(), 0.0);
  for (Contact& contact : all) turn(pose, contact);
  return contacts;
}

ContactSet TouchFinder::contactsOf(const RobotPose& pose, const std::vector<Vec3>& vertices) {
  ContactSet contacts = flatContacts(pose, vertices);
  curved_.take(world_.tissue.surface(), vertices);
  state_.smooth.resize(pose.links.size(), 0.0);
  for (Contact& contact : contacts.contacts) {
    curve(contact);
    if (contact.depth_m > 0.0) deepen(pose, vertices, contact);
  }
  return contacts;
}

ContactSet TouchFinder::flatContacts(const RobotPose& pose, const std::vector<Vec3>& vertices,
                                     double way) const {
  const double spacing = world_.tissue.lattice().spacing();
  const TissueSurface& surface = world_.tissue.surface();
  const auto find = [&](double gap) {
    return way > 0.0 ? world_.finder.findAgain(pose, surface, vertices, gap * spacing, way)
                     : world_.finder.find(pose, surface, vertices, gap * spacing);
  };
  if (!world_.anyInWound()) return find(tuning::kNearGap);
  ContactSet contacts = find(tuning::kPlaceOfLip + tuning::kNearGap);
  auto& all = contacts.contacts;
  const auto is_far = [&](const Contact& contact) {
    return !world_.isInWound(at(contact.link)) && contact.depth_m <= -tuning::kNearGap * spacing;
  };
  all.erase(std::remove_if(all.begin(), all.end(), is_far), all.end());
  return contacts;
}

// Contacts of points that give way, with the planes that turnOut finds.
ContactSet TouchFinder::touchesAt(const RobotPose& pose, const std::vector<std::uint8_t>& held,
                                  double way) {
  ContactSet contacts = contactsAt(pose, world_.tissue.state().displacement, way);
  const auto stands = [&](const Contact& contact) {
    return !SlidingContacts::givesWay(contact, world_.tissue, held);
  };
  auto& all = contacts.contacts;
  all.erase(std::remove_if(all.begin(), all.end(), stands), all.end());
  const Stopwatch watch(contact_ms_);
  curved_.take(world_.tissue.surface(), vertices_);
  state_.smooth = smoothnesses(pose, contacts, vertices_);
  std::vector<double> nearest;  // depths by the nearest way out, of those that stay
  std::size_t kept = 0;
  for (Contact& contact : all) {
    curve(contact);
    double depth = contact.depth_m;
    if (!turn(pose, contact) && world_.isInWound(at(contact.link))) continue;
    contact.wanders = wanders(pose, contact);
    if (contact.wanders) {
      contact.turn = curved_.hollowAt(contact.place);
    } else if (!world_.finder.hasMesh(at(contact.link)) && deepen(pose, vertices_, contact)) {
      depth = contact.depth_m;
      turn(pose, contact);
    }
    nearest.push_back(depth);
    all[kept++] = contact;
  }
  all.resize(kept);
  rims_.look(pose, vertices_, contacts);
  state_.depths.assign(pose.links.size(), 0.0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (world_.isInWound(at(all[i].link))) continue;
    const double depth = ownDepth(all[i], nearest[i]);
    state_.depths[at(all[i].link)] = std::max(state_.depths[at(all[i].link)], depth);
  }
  takeRims(held, contacts);
  return contacts;
}

double TouchFinder::ownDepth(const Contact& contact, double depth) const {
  const double recess = std::max(0.0, world_.sliding.recessOf(contact.link));
  const double of_columns = world_.sliding.columnRecess(contact.link, rims_.columnsAt(contact));
  return (1.0 - rims_.partOfDepth(contact)) * depth - recess - of_columns;
}

// What is at the rim of a flat face is pushed as the rim has it, and what is beside the face, too.
void TouchFinder::takeRims(const std::vector<std::uint8_t>& held, ContactSet& contacts) {
  auto& all = contacts.contacts;
  for (Contact& contact : all) rims_.mark(contact);
  all.erase(std::remove_if(all.begin(), all.end(), ToolRims::isTakenOver), all.end());
  for (const Contact& contact : rims_.beyond(vertices_).contacts) {
    if (SlidingContacts::givesWay(contact, world_.tissue, held)) all.push_back(contact);
  }
}

std::vector<double> TouchFinder::penetrations(const std::vector<std::size_t>& links,
                                              const RobotPose& pose) {
  const TissueSurface& surface = world_.tissue.surface();
  const std::vector<Vec3>& vertices = world_.tissue.vertices();
  curved_.take(surface, vertices);
  const auto smooth = smoothnesses(pose, flatContacts(pose, vertices), vertices);
  const auto bulge = [&](std::size_t link, const SurfacePoint& point) -> Vec3 {
    if (smooth[link] == 0.0) return Vec3::Zero();
    return smooth[link] * curved_.bulgeAt(point);
  };
  return world_.finder.penetrations(links, pose, surface, vertices, bulge);
}

// A tool that no longer touches the deformed surface may be in the way of its return to rest.
bool TouchFinder::wouldTouchAtRest(const RobotPose& pose) {
  const std::vector<Vec3> rest(world_.tissue.state().displacement.size(), Vec3::Zero());
  return deepest(contactsAt(pose, rest)) > tuning::kDeepEnough * world_.tissue.lattice().spacing();
}

}  // namespace robot_tissue
