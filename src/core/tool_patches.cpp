#include "robot_tissue/core/tool_patches.h"

#include <algorithm>
#include <utility>

namespace robot_tissue {
namespace {

constexpr int kPushSweeps = 100;
constexpr double kPushedOut = 1e-4;  // of the spacing

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

ToolPatches::ToolPatches(const Lattice& lattice, std::vector<std::string> tool_names)
    : lattice_(&lattice), names_(std::move(tool_names)), seats_(names_.size()) {}

void ToolPatches::ride(const RobotPose& pose, const Tissue& tissue) {
  displacement_ = tissue.state().displacement;
  holdNamedLoads(tissue);
  if (surface_version_ != tissue.surfaceVersion()) findOutwardNormals(tissue);
  left_.clear();
  for (std::size_t tool = 0; tool < seats_.size(); ++tool) {
    const Pose& tissue_T_tool = pose.tools[tool];
    for (auto seat = seats_[tool].begin(); seat != seats_[tool].end();) {
      const int node = seat->first;
      const Vec3 moved = tissue_T_tool * seat->second.point - lattice_->restPosition(node);
      const Vec3 normal = tissue_T_tool.linear() * seat->second.normal;
      if (taken_[at(node)] != 0 || letsGo(node, moved, normal, tissue)) {
        left_.push_back(node);
        seat = seats_[tool].erase(seat);
      } else {
        displacement_[at(node)] = moved;
        ++seat;
      }
    }
  }
}

// Each contact asks its nodes for the least motion along its normal that takes its point out of the
// tool. A node follows the mean of what it is asked, so that the order of the contacts, and with it
// the side a symmetric press starts on, does not matter.
void ToolPatches::pushOut(const ContactSet& contacts, const Surface& surface,
                          const RobotPose& pose) {
  std::vector<Push> pushes;
  for (const Contact& contact : contacts.contacts) {
    pushes.push_back({&contact, supportOf(contact, surface), Vec3::Zero(), false});
    pushes.back().start = pointOf(pushes.back().support);
  }
  for (int sweep = 0; sweep < kPushSweeps; ++sweep) {
    if (pushOnce(pushes) <= kPushedOut * lattice_->spacing()) break;
  }
  for (const Push& push : pushes) {
    if (push.needed) seat(*push.contact, push.support, pose);
  }
}

// Returns the depth of the deepest contact before the motion (m).
double ToolPatches::pushOnce(std::vector<Push>& pushes) {
  struct Asked {
    Vec3 sum = Vec3::Zero();
    double weight = 0.0;
  };
  std::map<int, Asked> asked;
  double deepest = 0.0;
  for (Push& push : pushes) {
    if (push.support.stiffness <= 0.0) continue;
    const Contact& contact = *push.contact;
    const double depth =
        contact.depth_m - contact.normal.dot(pointOf(push.support) - push.start);
    if (depth <= 0.0) continue;
    push.needed = true;
    deepest = std::max(deepest, depth);
    for (const NodeWeight& node : push.support.nodes) {
      Asked& of_node = asked[node.node];
      of_node.sum += node.weight * (depth * node.weight / push.support.stiffness) * contact.normal;
      of_node.weight += node.weight;
    }
  }
  for (const auto& [node, of_node] : asked) {
    displacement_[at(node)] += of_node.sum / of_node.weight;
  }
  return deepest;
}

// Motion of a contact's point (m) that its free nodes give it.
Vec3 ToolPatches::pointOf(const Support& support) const {
  Vec3 moved = Vec3::Zero();
  for (const NodeWeight& node : support.nodes) moved += node.weight * displacement_[at(node.node)];
  return moved;
}

bool ToolPatches::letsGo(int node, const Vec3& displacement, const Vec3& normal,
                         const Tissue& tissue) const {
  if (outward_[at(node)].dot(displacement) > 0.0) return true;
  return normal.dot(displacement) < 0.0 && normal.dot(tissue.nodeForce(node)) >= 0.0;
}

void ToolPatches::clear() {
  for (auto& seats : seats_) seats.clear();
}

bool ToolPatches::empty() const {
  return std::all_of(seats_.begin(), seats_.end(), [](const auto& seats) { return seats.empty(); });
}

std::vector<LoadingPatch> ToolPatches::loadingPatches() const {
  std::vector<LoadingPatch> patches;
  for (std::size_t tool = 0; tool < seats_.size(); ++tool) {
    if (seats_[tool].empty()) continue;
    LoadingPatch patch;
    patch.name = names_[tool];
    for (const auto& [node, seat] : seats_[tool]) {
      patch.nodes.push_back(node);
      patch.displacement.push_back(displacement_[at(node)]);
    }
    patches.push_back(std::move(patch));
  }
  return patches;
}

std::vector<int> ToolPatches::nodes(int tool) const {
  std::vector<int> nodes;
  for (const auto& [node, seat] : seats_[at(tool)]) nodes.push_back(node);
  return nodes;
}

Vec3 ToolPatches::normal(int tool, const Pose& tissue_T_tool) const {
  Vec3 sum = Vec3::Zero();
  for (const auto& [node, seat] : seats_[at(tool)]) sum += tissue_T_tool.linear() * seat.normal;
  return sum.norm() > 1e-12 ? Vec3(sum.normalized()) : Vec3(Vec3::Zero());
}

ToolPatches::Support ToolPatches::supportOf(const Contact& contact, const Surface& surface) const {
  std::map<int, double> weights;
  for (int corner = 0; corner < 3; ++corner) {
    const int vertex = surface.triangles[at(contact.triangle)][at(corner)];
    for (const NodeWeight& carrier : surface.carriers[at(vertex)]) {
      weights[carrier.node] += contact.barycentric[corner] * carrier.weight;
    }
  }
  Support support;
  for (const auto& [node, weight] : weights) {
    if (taken_[at(node)] != 0 || weight <= 0.0) continue;
    support.nodes.push_back({node, weight});
    support.stiffness += weight * weight;
  }
  return support;
}

// A node that another tool holds keeps that seat, at its new place.
void ToolPatches::seat(const Contact& contact, const Support& support, const RobotPose& pose) {
  for (const NodeWeight& carrier : support.nodes) {
    std::size_t owner = at(contact.tool);
    for (std::size_t tool = 0; tool < seats_.size(); ++tool) {
      if (seats_[tool].count(carrier.node) != 0) owner = tool;
    }
    const Pose tool_T_tissue = pose.tools[owner].inverse();
    Seat& seat = seats_[owner][carrier.node];
    seat.point = tool_T_tissue * Vec3(lattice_->restPosition(carrier.node) +
                                      displacement_[at(carrier.node)]);
    if (owner == at(contact.tool)) seat.normal = tool_T_tissue.linear() * contact.normal;
  }
}

void ToolPatches::findOutwardNormals(const Tissue& tissue) {
  const Surface& surface = tissue.surface();
  outward_.assign(at(lattice_->nodeCount()), Vec3::Zero());
  for (const auto& triangle : surface.triangles) {
    const Vec3& a = surface.rest[at(triangle[0])];
    const Vec3 area =
        (surface.rest[at(triangle[1])] - a).cross(surface.rest[at(triangle[2])] - a);
    for (const int vertex : triangle) {
      if (surface.carriers[at(vertex)].size() > 1) continue;
      outward_[at(surface.carriers[at(vertex)].front().node)] += area;
    }
  }
  surface_version_ = tissue.surfaceVersion();
}

void ToolPatches::holdNamedLoads(const Tissue& tissue) {
  taken_.assign(at(lattice_->nodeCount()), 0);
  for (int node = 0; node < lattice_->nodeCount(); ++node) {
    if (lattice_->isFixed(node)) taken_[at(node)] = 1;
  }
  for (std::size_t patch = 0; patch < tissue.namedPatches(); ++patch) {
    for (const int node : tissue.patches()[patch].nodes) taken_[at(node)] = 1;
  }
}

}  // namespace robot_tissue
