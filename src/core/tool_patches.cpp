#include "robot_tissue/core/tool_patches.h"

#include <algorithm>
#include <utility>

namespace robot_tissue {
namespace {

constexpr int kPushSweeps = 30;
constexpr double kPushedOut = 1e-4;  // of the spacing

std::size_t at(int index) { return static_cast<std::size_t>(index); }

}  // namespace

ToolPatches::ToolPatches(const Lattice& lattice, std::vector<std::string> tool_names)
    : lattice_(&lattice), names_(std::move(tool_names)), seats_(names_.size()) {}

void ToolPatches::ride(const RobotPose& pose, const Tissue& tissue) {
  displacement_ = tissue.state().displacement;
  holdNamedLoads(tissue);
  left_.clear();
  for (std::size_t tool = 0; tool < seats_.size(); ++tool) {
    const Pose& tissue_T_tool = pose.tools[tool];
    for (auto seat = seats_[tool].begin(); seat != seats_[tool].end();) {
      const int node = seat->first;
      const Vec3 moved = tissue_T_tool * seat->second.point - lattice_->restPosition(node);
      const Vec3 normal = tissue_T_tool.linear() * seat->second.normal;
      const bool lifted_off = normal.dot(moved) < 0.0;
      const bool pulled_away = normal.dot(tissue.nodeForce(node)) >= 0.0;
      if (taken_[at(node)] != 0 || (lifted_off && pulled_away)) {
        left_.push_back(node);
        seat = seats_[tool].erase(seat);
      } else {
        displacement_[at(node)] = moved;
        ++seat;
      }
    }
  }
}

// Gauss-Seidel over the contacts: each moves its nodes along its normal by the least that takes
// its point out of the tool.
void ToolPatches::pushOut(const ContactSet& contacts, const Surface& surface,
                          const RobotPose& pose) {
  std::vector<Support> supports;
  std::vector<Vec3> starts;
  const auto pointOf = [this](const Support& support) {
    Vec3 moved = Vec3::Zero();
    for (const NodeWeight& node : support.nodes) moved += node.weight * displacement_[at(node.node)];
    return moved;
  };
  for (const Contact& contact : contacts.contacts) {
    supports.push_back(supportOf(contact, surface));
    starts.push_back(pointOf(supports.back()));
  }
  std::vector<char> pushed(supports.size(), 0);
  const double out = kPushedOut * lattice_->spacing();
  for (int sweep = 0; sweep < kPushSweeps; ++sweep) {
    double deepest = 0.0;
    for (std::size_t i = 0; i < supports.size(); ++i) {
      const Contact& contact = contacts.contacts[i];
      if (supports[i].stiffness <= 0.0) continue;
      const double depth =
          contact.depth_m - contact.normal.dot(pointOf(supports[i]) - starts[i]);
      if (depth <= 0.0) continue;
      deepest = std::max(deepest, depth);
      pushed[i] = 1;
      for (const NodeWeight& node : supports[i].nodes) {
        displacement_[at(node.node)] +=
            depth * node.weight / supports[i].stiffness * contact.normal;
      }
    }
    if (deepest <= out) break;
  }
  for (std::size_t i = 0; i < supports.size(); ++i) {
    if (pushed[i] != 0) seat(contacts.contacts[i], supports[i], pose);
  }
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
