#include "loads/tool_bed.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "loads/bed_columns.h"
#include "loads/rim_law.h"

namespace robot_tissue {
namespace {

class ToolBed {
 public:
  ToolBed(const Lattice& lattice, const TissueModel& model, const LatticeState& state,
          const std::vector<SeatedNode>& nodes)
      : lattice_(lattice), nodes_(nodes), cells_(*state.cells), columns_(lattice, model, cells_) {}

  std::vector<RimSpring> build() {
    std::vector<int> seated;
    for (const SeatedNode& seat : nodes_) seated.push_back(seat.node);
    for (const int number : cellsAt(cells_, seated)) addColumns(cells_.all()[at(number)]);
    if (columns_.empty()) return {};
    const std::map<int, Vec3> springs =
        columns_.springs([&](int node) { return on_plate_.count(node) != 0; });
    std::vector<RimSpring> bed;
    for (const int node : seated) {
      if (columns_.isHard(node) || in_column_.count(node) == 0) continue;
      const auto spring = springs.find(node);
      bed.push_back({node, spring == springs.end() ? Vec3::Zero() : spring->second, Vec3::Zero()});
    }
    return bed;
  }

 private:
  const SeatedNode* seatOf(int node) const {
    const auto found =
        std::lower_bound(nodes_.begin(), nodes_.end(), node,
                         [](const SeatedNode& seat, int other) { return seat.node < other; });
    return found != nodes_.end() && found->node == node ? &*found : nullptr;
  }

  // On the side where the tool is: of those that the surface of the cell's material is at, the one
  // that faces it most.
  std::optional<HeldLayer> layerOf(const Cell& cell) const {
    Vec3 outward = Vec3::Zero();
    for (int corner = 0; corner < kCorners; ++corner) {
      const SeatedNode* seat = cell.owns(corner) ? seatOf(cell.nodes[at(corner)]) : nullptr;
      if (seat != nullptr) outward += seat->outward;
    }
    std::optional<HeldLayer> found;
    double most = 0.0;
    for (int side = 0; side < kSides; ++side) {
      const double facing = (side % 2 == 0 ? -1.0 : 1.0) * outward[side / 2];
      if (facing <= most) continue;
      const auto layer = columns_.layerAt(cell, side);
      if (!layer) continue;
      found = layer;
      most = facing;
    }
    return found;
  }

  void addColumns(const Cell& cell) {
    const auto layer = layerOf(cell);
    if (!layer) return;
    columns_.add(cell, *layer, [&](int corner, const RimLaw& law) {
      return complianceAt(cell, corner, layer->side / 2, law);
    });
    for (int r = 0; r < kFaceNodes; ++r) {
      const int corner = faceCorner(layer->side, r);
      if (cell.owns(corner)) on_plate_.insert(cell.nodes[at(corner)]);
    }
    for (int corner = 0; corner < kCorners; ++corner) {
      if (cell.owns(corner)) in_column_.insert(cell.nodes[at(corner)]);
    }
  }

  // Of the joint at the cell's corner, over shear modulus times spacing, along the lattice's axes;
  // infinite where the tool holds no node. The compliances of a face's edges add.
  Vec3 complianceAt(const Cell& cell, int corner, int normal, const RimLaw& law) const {
    const SeatedNode* seat = seatOf(cell.nodes[at(corner)]);
    if (seat == nullptr) return Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 compliance = Vec3::Zero();
    for (const FaceEdge& edge : seat->edges) {
      Vec3 level = edge.outward;
      level[normal] = 0.0;
      int axis = 0;
      level.cwiseAbs().maxCoeff(&axis);
      const double depth = columns_.depthInTissue(cell, corner, axis, level[axis] > 0.0 ? 1 : -1,
                                                  edge.depth_m / lattice_.spacing());
      compliance += seat->share * complianceOf(level.normalized(), normal, depth, law);
    }
    return compliance;
  }

  // Along the axes, of an edge that may run aslant to them.
  static Vec3 complianceOf(const Vec3& outward, int normal, double depth, const RimLaw& law) {
    Vec3 compliance;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == normal) {
        compliance[axis] = 1.0 / rimStiffness(law.normal, depth);
        continue;
      }
      const double part = outward[axis] * outward[axis];
      compliance[axis] = 0.0;
      if (part > kBedSlack) compliance[axis] += part / rimStiffness(law.across, depth);
      if (part < 1.0 - kBedSlack) compliance[axis] += (1.0 - part) / rimStiffness(law.along, depth);
    }
    return compliance;
  }

  const Lattice& lattice_;
  const std::vector<SeatedNode>& nodes_;
  const CellSet& cells_;
  BedColumns columns_;
  std::set<int> on_plate_;   // nodes of columns, where the tool is
  std::set<int> in_column_;  // all their nodes; others are hard
};

}  // namespace

std::vector<RimSpring> bedOf(const Lattice& lattice, const TissueModel& model,
                             const LatticeState& state, const std::vector<SeatedNode>& nodes) {
  return ToolBed(lattice, model, state, nodes).build();
}

}  // namespace robot_tissue
