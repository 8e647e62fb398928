#include "robot_tissue/coupling/sticking_contacts.h"

#include <algorithm>
#include <set>
#include <type_traits>
#include <utility>

#include "tuning.h"

namespace robot_tissue {

StickingContacts::StickingContacts(const Lattice& lattice, std::vector<std::string> tool_names)
    : lattice_(&lattice), names_(std::move(tool_names)), attachments_(names_.size()) {}

void StickingContacts::ride(const RobotPose& pose, const Tissue& tissue) {
  places_.clear();
  cells_ = tissue.state().cells;
  taken_ = fixedOrLoaded(tissue);
  left_.clear();
  for (std::size_t tool = 0; tool < attachments_.size(); ++tool) {
    for (auto attachment = attachments_[tool].begin(); attachment != attachments_[tool].end();) {
      const int node = attachment->first;
      const Pose& tissue_T_link = pose.links[at(attachment->second.link)];
      const Vec3 moved = placeOf(attachment->second, pose) - restPosition(*lattice_, *cells_, node);
      attachment->second.turn = tissue_T_link.linear() * attachment->second.link_R_tissue;
      const Vec3 way_out = tissue_T_link.linear() * attachment->second.pushed;
      const bool leaves = !attachment->second.grasped && letsGo(node, moved, way_out, tissue);
      if (taken_[at(node)] != 0 || leaves) {
        left_.push_back(node);
        attachment = attachments_[tool].erase(attachment);
      } else {
        places_[node] = moved;
        ++attachment;
      }
    }
  }
}

// In the tissue's frame.
Vec3 StickingContacts::placeOf(const Attachment& attachment, const RobotPose& pose) {
  const Vec3 on_link = pose.links[at(attachment.link)] * attachment.point;
  if (attachment.share_of_other == 0.0) return on_link;
  const Vec3 on_other = pose.links[at(attachment.other_link)] * attachment.point_on_other;
  return on_link + attachment.share_of_other * (on_other - on_link);
}

void StickingContacts::takeCells(const Tissue& tissue) {
  const std::shared_ptr<const CellSet> before = std::exchange(cells_, tissue.state().cells);
  if (before == nullptr || before == cells_) return;
  taken_ = fixedOrLoaded(tissue);
  const auto renumber = [&](auto& by_node) {
    std::decay_t<decltype(by_node)> renumbered;
    for (const auto& [node, value] : by_node) {
      const int here = cells_->nodeOf(*before, node);
      if (here >= 0 && !isGone(tissue.state(), here)) renumbered.emplace(here, value);
    }
    by_node = std::move(renumbered);
  };
  for (auto& attachments : attachments_) renumber(attachments);
  renumber(places_);
  left_.clear();
}

void StickingContacts::keepTouching(const ContactSet& contacts, const Tissue& tissue) {
  std::vector<std::set<int>> touching(attachments_.size());
  for (const Contact& contact : contacts.contacts) {
    for (const Carrier& carrier : supportOf(contact, tissue.surface())) {
      touching[at(contact.tool)].insert(carrier.node);
    }
  }
  // What lies flat on a face touches it at any of its points: a node at the face's edge stays as
  // long as one beside it touches.
  const auto isBesideOne = [&](int node, const std::set<int>& others) {
    return std::any_of(others.begin(), others.end(), [&](int other) {
      const Vec3 way =
          restPosition(*lattice_, *cells_, node) - restPosition(*lattice_, *cells_, other);
      return way.cwiseAbs().maxCoeff() < 1.5 * lattice_->spacing();
    });
  };
  for (std::size_t tool = 0; tool < attachments_.size(); ++tool) {
    for (auto attachment = attachments_[tool].begin(); attachment != attachments_[tool].end();) {
      const int node = attachment->first;
      const bool is_at_edge = !attachment->second.seat.edges.empty() && tissue.rimModuli(node);
      if (attachment->second.grasped || touching[tool].count(node) != 0 ||
          (is_at_edge && isBesideOne(node, touching[tool]))) {
        ++attachment;
        continue;
      }
      places_.erase(node);
      left_.push_back(node);
      attachment = attachments_[tool].erase(attachment);
    }
  }
}

// The smallest motion of the nodes that takes every contact's point out of its tool:
//   minimize sum |du_n|^2 / mobility_n   subject to   normal_c . sum w_cn du_n >= depth_c,
// by sweeps over the contacts' multipliers. All of a sweep look at the same shape, so that the
// order of the contacts, and with it the side a symmetric press would start on, does not matter.
void StickingContacts::pushOut(const ContactSet& contacts, const Tissue& tissue,
                               const RobotPose& pose) {
  const std::vector<Contact>& all = contacts.contacts;
  std::vector<Push> pushes;
  for (const Contact& contact : all) pushes.push_back(pushOf(contact, tissue));
  scale(pushes);
  std::map<int, Vec3> motion;
  for (int sweep = 0; sweep < tuning::kPushSweeps; ++sweep) {
    const double deepest = deepen(all, motion, pushes);
    motion = motionOf(all, pushes);
    if (deepest <= tuning::kPushedOut * lattice_->spacing()) break;
  }
  std::map<int, std::size_t> pushed_by;
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    if (pushes[i].multiplier <= 0.0) continue;
    for (const Carrier& carrier : pushes[i].support) pushed_by.emplace(carrier.node, i);
  }
  for (const auto& [node, i] : pushed_by) {
    attach(node, at(all[i].tool), all[i].link, motion.at(node), tissue, pose);
  }
}

// Where springs hold what sticks (Tissue::springsUnder), it goes as a plate does: evenly, and nodes
// outside and inside of a mesh's surface, one behind the other, alike.
StickingContacts::Push StickingContacts::pushOf(const Contact& contact,
                                                const Tissue& tissue) const {
  Push push;
  push.support = supportOf(contact, tissue.surface());
  int axis = 0;
  contact.normal.cwiseAbs().maxCoeff(&axis);
  const auto areInOneColumn = [&](int one, int other) {
    Vec3 way = restPosition(*lattice_, *cells_, one) - restPosition(*lattice_, *cells_, other);
    way[axis] = 0.0;
    return way.norm() < 0.5 * lattice_->spacing();
  };
  for (Carrier& carrier : push.support) {
    carrier.way = carrier.weight;
    if (!tissue.rimModuli(carrier.node)) continue;
    push.evenly = true;
    for (const Carrier& other : push.support) {
      const bool is_behind = &other != &carrier && areInOneColumn(carrier.node, other.node);
      if (is_behind) carrier.way += other.weight;
    }
  }
  return push;
}

// Mobilities: a node that sits on a tool already, or is itself a contact's point, keeps its place
// (kSeatedMobility); the others give way. Row sums: by how much a unit of all multipliers moves
// each contact's point.
void StickingContacts::scale(std::vector<Push>& pushes) const {
  std::set<int> held;
  for (const auto& attachments : attachments_) {
    for (const auto& [node, attachment] : attachments) held.insert(node);
  }
  for (const Push& push : pushes) {
    if (push.support.size() == 1) held.insert(push.support.front().node);
  }
  std::map<int, double> shared;  // per node: sum of the contacts' weights
  for (Push& push : pushes) {
    for (Carrier& carrier : push.support) {
      carrier.mobility = held.count(carrier.node) != 0 ? tuning::kSeatedMobility : 1.0;
      shared[carrier.node] += carrier.way;
    }
  }
  for (Push& push : pushes) {
    for (Carrier& carrier : push.support) {
      if (push.evenly) carrier.mobility /= shared[carrier.node];
      push.row_sum += carrier.mobility * carrier.weight * shared[carrier.node];
    }
  }
}

// One sweep over the multipliers; returns the depth of the deepest contact before it (m).
double StickingContacts::deepen(const std::vector<Contact>& contacts,
                                const std::map<int, Vec3>& motion, std::vector<Push>& pushes) {
  double deepest = 0.0;
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    Push& push = pushes[i];
    if (push.row_sum <= 0.0) continue;
    double depth = contacts[i].depth_m;
    for (const Carrier& carrier : push.support) {
      const auto moved = motion.find(carrier.node);
      if (moved != motion.end()) depth -= carrier.weight * contacts[i].normal.dot(moved->second);
    }
    deepest = std::max(deepest, depth);
    push.multiplier = std::max(0.0, push.multiplier + depth / push.row_sum);
  }
  return deepest;
}

std::map<int, Vec3> StickingContacts::motionOf(const std::vector<Contact>& contacts,
                                               const std::vector<Push>& pushes) {
  std::map<int, Vec3> motion;
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    for (const Carrier& carrier : pushes[i].support) {
      Vec3& moved = motion.emplace(carrier.node, Vec3::Zero()).first->second;
      moved += carrier.mobility * carrier.way * pushes[i].multiplier * contacts[i].normal;
    }
  }
  return motion;
}

bool StickingContacts::letsGo(int node, const Vec3& displacement, const Vec3& way_out,
                              const Tissue& tissue) {
  if (surface_revision_ != tissue.surface().revision) findOutwardNormals(tissue);
  if (outward_[at(node)].dot(displacement) > 0.0) return true;
  return way_out.dot(displacement) < 0.0 && way_out.dot(tissue.nodeForce(node)) >= 0.0;
}

void StickingContacts::restore(const Attachments& attachments, const Tissue& tissue) {
  attachments_ = attachments;
  places_.clear();
  for (const auto& of_tool : attachments_) {
    for (const auto& [node, attachment] : of_tool)
      places_[node] = tissue.state().displacement[at(node)];
  }
  for (const LoadingPatch& patch : tissue.patches()) {
    if (!patch.tool) continue;
    for (const RimSpring& spring : patch.rim) {
      const auto place = places_.find(spring.node);
      if (place != places_.end()) place->second = spring.anchor;
    }
  }
}

std::vector<Vec3> StickingContacts::displacement(const Tissue& tissue) const {
  std::vector<Vec3> displacement = tissue.state().displacement;
  for (const auto& [node, place] : places_) displacement[at(node)] = place;
  return displacement;
}

void StickingContacts::clear() {
  for (auto& attachments : attachments_) attachments.clear();
  places_.clear();
  left_.clear();
}

void StickingContacts::tellEdges(const RobotPose& pose, const EdgesAt& edges_at) {
  for (auto& attachments : attachments_) {
    std::map<int, Vec3> outward;  // by link: mean of its nodes', as one of them may be off
    for (const auto& [node, attachment] : attachments) {
      outward.emplace(attachment.link, Vec3::Zero()).first->second -=
          pose.links[at(attachment.link)].linear() * attachment.pushed;
    }
    for (auto& [node, attachment] : attachments) {
      if (attachment.knows_edges) continue;
      attachment.knows_edges = true;
      const Pose& tissue_T_link = pose.links[at(attachment.link)];
      attachment.link_R_tissue = tissue_T_link.linear().transpose();
      attachment.turn.setIdentity();
      const Vec3 facing = outward.at(attachment.link).normalized();
      Edges edges = edges_at(attachment.link, facing, tissue_T_link * attachment.point);
      const Vec3 own = -(tissue_T_link.linear() * attachment.pushed).normalized();
      attachment.seat = {node, own, edges.share, std::move(edges.edges)};
    }
  }
}

// Of several links that turn otherwise, springs turn as the first one does.
LoadingPatch StickingContacts::loadingPatch(int tool, const Tissue& tissue) const {
  LoadingPatch patch;
  patch.name = names_[at(tool)];
  patch.tool = tool;
  const std::map<int, Attachment>& attachments = attachments_[at(tool)];
  std::vector<SeatedNode> seats;
  for (const auto& [node, attachment] : attachments) {
    if (attachment.grasped) continue;
    if (seats.empty()) patch.place.rotation = attachment.turn;
    seats.push_back(attachment.seat);
    seats.back().node = node;
  }
  std::set<int> loose;  // nodes that it does not hold
  if (!seats.empty()) {
    for (RimSpring spring : tissue.springsUnder(seats)) {
      spring.anchor = places_.at(spring.node);
      if (spring.stiffness.isZero(0.0)) {
        loose.insert(spring.node);
      } else {
        patch.rim.push_back(spring);
      }
    }
  }
  if (patch.rim.empty()) patch.place.rotation.setIdentity();
  for (const auto& [node, attachment] : attachments) {
    if (loose.count(node) != 0) continue;
    patch.nodes.push_back(node);
    patch.displacement.push_back(places_.at(node));
  }
  return patch;
}

std::vector<int> StickingContacts::nodes(int tool) const {
  std::vector<int> nodes;
  for (const auto& [node, attachment] : attachments_[at(tool)]) nodes.push_back(node);
  return nodes;
}

void StickingContacts::hold(int tool, const std::vector<Grip>& grips, const RobotPose& pose,
                            const Tissue& tissue) {
  const std::vector<std::uint8_t> taken = takenNodes(tissue);
  for (const Grip& grip : grips) {
    if (taken[at(grip.node)] != 0) continue;
    const Vec3 position = tissue.nodePosition(grip.node);
    Attachment& attachment = attachments_[at(tool)][grip.node];
    attachment.link = grip.link;
    attachment.grasped = true;
    attachment.other_link = grip.other_link;
    attachment.share_of_other = grip.share_of_other;
    attachment.point = pose.links[at(grip.link)].inverse() * position;
    attachment.point_on_other = pose.links[at(grip.other_link)].inverse() * position;
    places_[grip.node] = tissue.state().displacement[at(grip.node)];
  }
}

void StickingContacts::letGo(int tool) { attachments_[at(tool)].clear(); }

bool StickingContacts::holds(int tool) const { return !attachments_[at(tool)].empty(); }

// Per node, 1 = fixed.
const std::vector<std::uint8_t>& StickingContacts::fixedNodes(const Tissue& tissue) const {
  const std::shared_ptr<const CellSet>& cells = tissue.state().cells;
  if (fixed_of_ == cells) return fixed_;
  fixed_of_ = cells;
  fixed_.assign(at(cells->nodeCount()), 0);
  for (int node = 0; node < cells->nodeCount(); ++node) {
    if (isFixed(*lattice_, *cells, node)) fixed_[at(node)] = 1;
  }
  return fixed_;
}

std::vector<std::uint8_t> StickingContacts::heldNodes(const Tissue& tissue) const {
  std::vector<std::uint8_t> held = fixedNodes(tissue);
  for (std::size_t patch = 0; patch < tissue.namedPatches(); ++patch) {
    if (byForce(tissue.patches()[patch])) continue;
    for (const int node : hardNodes(tissue.patches()[patch])) held[at(node)] = 1;
  }
  markAttached(held);
  return held;
}

std::vector<std::uint8_t> StickingContacts::takenNodes(const Tissue& tissue) const {
  std::vector<std::uint8_t> taken = fixedOrLoaded(tissue);
  markAttached(taken);
  return taken;
}

void StickingContacts::markAttached(std::vector<std::uint8_t>& nodes) const {
  for (std::size_t tool = 0; tool < attachments_.size(); ++tool) {
    for (const auto& [node, attachment] : attachments_[tool])
      nodes[at(node)] = attachment.grasped ? SlidingContacts::graspedBy(static_cast<int>(tool)) : 1;
  }
}

std::vector<StickingContacts::Carrier> StickingContacts::supportOf(
    const Contact& contact, const TissueSurface& surface) const {
  std::vector<Carrier> support;
  double above_zero = 1.0;  // sum of the weights that are; those below are beside the piece
  for (const auto& [node, weight] : carriersAt(surface, contact.place)) {
    if (weight < 0.0) above_zero -= weight;
    if (weight > 0.0 && taken_[at(node)] == 0) support.push_back({node, weight, 1.0});
  }
  for (Carrier& carrier : support) carrier.weight /= above_zero;
  return support;
}

// Moves the node by `moved` and seats it on the link. A node that another tool holds stays that
// tool's, at its new place.
void StickingContacts::attach(int node, std::size_t tool, int link, const Vec3& moved,
                              const Tissue& tissue, const RobotPose& pose) {
  Vec3& place = places_.try_emplace(node, tissue.state().displacement[at(node)]).first->second;
  place += moved;
  for (std::size_t other = 0; other < attachments_.size(); ++other) {
    const auto earlier = attachments_[other].find(node);
    if (earlier == attachments_[other].end()) continue;
    tool = other;
    link = earlier->second.link;
  }
  const Pose tool_T_tissue = pose.links[at(link)].inverse();
  Attachment& attachment = attachments_[tool][node];
  attachment.link = link;
  attachment.point = tool_T_tissue * Vec3(restPosition(*lattice_, *cells_, node) + place);
  attachment.pushed += tool_T_tissue.linear() * moved;
}

void StickingContacts::findOutwardNormals(const Tissue& tissue) {
  const TissueSurface& surface = tissue.surface();
  outward_.assign(tissue.state().displacement.size(), Vec3::Zero());
  for (const auto& triangle : surface.triangles) {
    const Vec3 area = doubleArea(surface.rest, triangle);
    for (const int vertex : triangle) {
      for (const NodeWeight& carrier : surface.carriers[at(vertex)]) {
        outward_[at(carrier.node)] += carrier.weight * area;
      }
    }
  }
  surface_revision_ = tissue.surface().revision;
}

// Per node, 1 = fixed, or in a named load.
std::vector<std::uint8_t> StickingContacts::fixedOrLoaded(const Tissue& tissue) const {
  std::vector<std::uint8_t> taken = fixedNodes(tissue);
  for (std::size_t patch = 0; patch < tissue.namedPatches(); ++patch) {
    for (const int node : tissue.patches()[patch].nodes) taken[at(node)] = 1;
  }
  return taken;
}

}  // namespace robot_tissue
