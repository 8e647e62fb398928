// Pipeline: where the tools touch, and whether that is what the shape was solved for.
#include <algorithm>
#include <cmath>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "stopwatch.h"

namespace robot_tissue {
namespace {

constexpr double kNear = 0.25;         // of the spacing: a gap that a solve may close
constexpr double kLongestWay = 0.5;    // of the spacing, of the tissue beside a tool in one round
constexpr double kShareOfTool = 0.25;  // of a link's thickness, likewise
constexpr double kDepth = 0.1;         // of the spacing: how deep a point goes on such a way, and
constexpr double kDepthInTool = 0.2;   // of the link's thickness, whichever is less
constexpr double kDepthGrowth = 0.1;   // of that, where one is deeper already
constexpr int kDepthTrials = 4;        // of half the way each, to get less deep
constexpr double kReach = 1.0;       // of the spacing: farther from its tool, a touch is forgotten
constexpr double kClear = 0.03;      // of the spacing: off a tool, where its edges look round
constexpr double kDetour = 2.0;      // of the nearest way out: the surface's may be so long,
constexpr double kLongDetour = 0.5;  // and so much of the spacing, or of the link, longer
constexpr double kAcross = 0.3;      // cosine of two normals that look to the same side
constexpr double kInside = 1e-3;     // barycentric: a point that is not on an edge

bool isIn(const Box& box, const Vec3& point) {
  return (point.array() >= box.min.array()).all() && (point.array() <= box.max.array()).all();
}

}  // namespace

// Where a thin tool slips off, the tissue springs past it in one solve. So that it meets the tool,
// no vertex near a link goes farther at once than half a spacing, or half the link's thickness.
std::vector<Pipeline::Surroundings> Pipeline::surroundings() const {
  const double spacing = tissue_.lattice().spacing();
  std::vector<Surroundings> all;
  for (std::size_t link = 0; link < first_link_[tools_.size()]; ++link) {
    if (isAway(pose_.links[link])) continue;
    Surroundings here;
    here.box = finder_.bounds(link, pose_.links[link]);
    here.box.min.array() -= spacing;
    here.box.max.array() += spacing;
    here.longest = std::min(kLongestWay * spacing, kShareOfTool * finder_.thickness(link));
    all.push_back(here);
  }
  return all;
}

std::vector<double> Pipeline::longestWays() {
  const Stopwatch watch(report_.contact_ms);
  const std::vector<Vec3>& now = tissue_.vertices();
  std::vector<double> longest;
  for (const Surroundings& near : surroundings()) {
    longest.resize(now.size(), std::numeric_limits<double>::infinity());
    for (std::size_t vertex = 0; vertex < now.size(); ++vertex) {
      if (isIn(near.box, now[vertex])) longest[vertex] = std::min(longest[vertex], near.longest);
    }
  }
  return longest;
}

double Pipeline::contactShare(const std::vector<Vec3>& before) {
  const Stopwatch watch(report_.contact_ms);
  deform(tissue_.surface(), before, vertices_);
  const std::vector<Vec3>& now = tissue_.vertices();
  double share = 1.0;
  for (const Surroundings& near : surroundings()) {
    for (std::size_t vertex = 0; vertex < now.size(); ++vertex) {
      if (!isIn(near.box, now[vertex]) && !isIn(near.box, vertices_[vertex])) continue;
      const double way = (now[vertex] - vertices_[vertex]).norm();
      if (way > near.longest) share = std::min(share, near.longest / way);
    }
  }
  return shareOutside(share);
}

// Of that share of the way from `vertices_` to the shape, as much as takes no point deep into a
// link: from its middle on, nothing tells on which side it came in.
double Pipeline::shareOutside(double share) const {
  const std::vector<Vec3>& now = tissue_.vertices();
  std::vector<Vec3> there(now.size());
  std::vector<double> before;
  for (int trial = 0; trial < kDepthTrials; ++trial, share *= 0.5) {
    for (std::size_t vertex = 0; vertex < now.size(); ++vertex) {
      there[vertex] = vertices_[vertex] + share * (now[vertex] - vertices_[vertex]);
    }
    const std::vector<double> depths = depthsIn(there);
    bool deep = false;
    for (std::size_t link = 0; link < depths.size(); ++link) {
      const double most =
          std::min(kDepth * tissue_.lattice().spacing(), kDepthInTool * finder_.thickness(link));
      if (depths[link] <= most) continue;
      if (before.empty()) before = depthsIn(vertices_);
      deep = deep || depths[link] > before[link] + kDepthGrowth * most;
    }
    if (!deep) break;
  }
  return share;
}

// Of the deepest point that gives way in each of the tools' links (m).
std::vector<double> Pipeline::depthsIn(const std::vector<Vec3>& vertices) const {
  const std::vector<std::uint8_t> held = patches_.heldNodes(tissue_);
  std::vector<double> depths(first_link_[tools_.size()], 0.0);
  for (const Contact& contact : finder_.find(pose_, tissue_.surface(), vertices, 0.0).contacts) {
    if (at(contact.link) >= depths.size() || isRigid(contact.tool)) continue;
    const auto carriers = carriersAt(tissue_.surface(), contact.triangle, contact.barycentric);
    if (!SlidingContacts::givesWay(carriers, held)) continue;
    depths[at(contact.link)] = std::max(depths[at(contact.link)], contact.depth_m);
  }
  return depths;
}

// The shape was solved for the contacts of before: are they those of the shape?
bool Pipeline::updateContacts(std::vector<LoadingPatch>& of_tools, bool whole, bool last) {
  const bool new_surface = surface_version_ != tissue_.surfaceVersion();
  surface_version_ = tissue_.surfaceVersion();
  if (new_surface) contacts_.clear();
  const std::vector<std::uint8_t> held = patches_.heldNodes(tissue_);
  const ContactSet contacts = touchesAt(pose_, held);
  left_inside_ = deepest(contacts);
  if (new_surface) {
    contacts_.ride(pose_, tissue_);
    contacts_.meet(contacts, pose_, tissue_, held);
  } else {
    const bool settled =
        contacts_.update(trackTouches(pose_), contacts, pose_, tissue_, held, whole);
    if (settled && (!tissue_.isUntouched() || contacts_.touches().empty())) return false;
  }
  if (last) return true;
  of_tools = patchesOfTools();
  return !of_tools.empty();
}

// Where the touches are, from the links.
std::vector<std::optional<Contact>> Pipeline::trackTouches(const RobotPose& pose) {
  const Stopwatch watch(report_.contact_ms);
  std::vector<std::optional<Contact>> tracked;
  for (const SlidingContacts::ContactConstraint& touch : contacts_.touches()) {
    Contact contact{
        touch.tool,          touch.link, touch.triangle, touch.barycentric, Vec3::Zero(),
        touch.spring.normal, 0.0};
    contact.point = pointOf(touch.spring, tissue_.state().displacement);
    const bool near = turnOut(pose, contact);
    tracked.push_back(near ? std::optional<Contact>(contact) : std::nullopt);
  }
  return tracked;
}

// Into the tissue, across the surface at the point; zero where it has no normal there.
Vec3 Pipeline::inwardsAt(const Contact& contact) const {
  const int vertex = vertexAt(tissue_.surface(), contact.triangle, contact.barycentric);
  if (vertex >= 0) return -outwards_[at(vertex)].normalized();
  return -doubleArea(vertices_, tissue_.surface().triangles[at(contact.triangle)]).normalized();
}

// A tool presses a surface inwards, as the surface lies: that way its point goes out of the tool,
// also where another side of the tool is nearer, as at edges and on thin tools. Between its edges a
// triangle is pressed across itself: what touches it there is a corner, an edge or a rim, which has
// no normal of its own.
bool Pipeline::turnOut(const RobotPose& pose, Contact& contact) const {
  const double spacing = tissue_.lattice().spacing();
  const std::size_t link = at(contact.link);
  const Vec3 inwards = inwardsAt(contact);
  if (!(inwards.norm() > 0.0)) return false;
  const Pose& tissue_T_link = pose.links[link];
  const auto nearest = finder_.wayOut(link, tissue_T_link, contact.point, kReach * spacing);
  if (!nearest) return false;
  const double farthest = kDetour * std::max(nearest->depth_m, 0.0) +
                          kLongDetour * std::min(spacing, finder_.thickness(link));
  const auto along = finder_.wayOutAlong(link, tissue_T_link, contact.point, inwards,
                                         kClear * spacing, kReach * spacing, farthest);
  const WayOut& out = along ? *along : *nearest;
  if (out.normal.norm() < 0.5) return true;
  contact.normal = out.normal;
  contact.depth_m = out.depth_m;
  const double cosine = out.normal.dot(inwards);
  if (contact.barycentric.minCoeff() > kInside && cosine > kAcross) {
    contact.normal = inwards;
    contact.depth_m = out.depth_m / cosine;
  }
  return true;
}

ContactSet Pipeline::contactsAt(const RobotPose& pose, const std::vector<Vec3>& displacement) {
  const Stopwatch watch(report_.contact_ms);
  deform(tissue_.surface(), displacement, vertices_);
  return finder_.find(pose, tissue_.surface(), vertices_, kNear * tissue_.lattice().spacing());
}

// Of points that give way, with the ways out that turnOut finds.
ContactSet Pipeline::touchesAt(const RobotPose& pose, const std::vector<std::uint8_t>& held) {
  ContactSet contacts = contactsAt(pose, tissue_.state().displacement);
  const auto stands = [&](const Contact& contact) {
    const auto carriers = carriersAt(tissue_.surface(), contact.triangle, contact.barycentric);
    return !SlidingContacts::givesWay(carriers, held);
  };
  auto& all = contacts.contacts;
  all.erase(std::remove_if(all.begin(), all.end(), stands), all.end());
  const Stopwatch watch(report_.contact_ms);
  depths_.assign(pose.links.size(), 0.0);
  for (const Contact& contact : all) {
    depths_[at(contact.link)] = std::max(depths_[at(contact.link)], contact.depth_m);
  }
  outwards_.assign(vertices_.size(), Vec3::Zero());
  for (const MeshTriangle& corners : tissue_.surface().triangles) {
    const Vec3 area = doubleArea(vertices_, corners);
    for (const int corner : corners) outwards_[at(corner)] += area;
  }
  for (Contact& contact : contacts.contacts) turnOut(pose, contact);
  return contacts;
}

void Pipeline::meet(const RobotPose& pose) {
  const std::vector<std::uint8_t> held = patches_.heldNodes(tissue_);
  contacts_.meet(touchesAt(pose, held), pose, tissue_, held);
}

// A tool that has left the surface behind it may still be where the surface is at rest.
bool Pipeline::wouldTouchAtRest(const RobotPose& pose) {
  const std::vector<Vec3> rest(tissue_.state().displacement.size(), Vec3::Zero());
  return deepest(contactsAt(pose, rest)) > kDeepEnough * tissue_.lattice().spacing();
}

// Of the tools that touched, for the surface to come back to.
std::vector<LoadingPatch> Pipeline::lastTouches() const {
  std::vector<LoadingPatch> patches;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) {
    patches.push_back(patches_.loadingPatch(static_cast<int>(tool)));
    patches.back().contacts = contacts_.springsOf(static_cast<int>(tool));
  }
  return patches;
}

}  // namespace robot_tissue
