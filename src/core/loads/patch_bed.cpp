#include "loads/patch_bed.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "lattice/held_layers.h"

namespace robot_tissue {
namespace {

// Of a layer as thick as its cell is wide, on its plate (N/m).
Vec3 fullStiffness(const Cell& cell, const HeldLayer& layer, const TissueModel& model,
                   double spacing) {
  const Moduli moduli = model.moduliIn(cell);  // of what the cell has
  if (moduli.shear <= 0.0) return Vec3::Zero();
  Vec3 stiffness = Vec3::Constant(moduli.shear);
  // E / (1 - nu^2): the nodes across give way to the sides, but not as freely as a bar's.
  stiffness[layer.side / 2] = 2.0 * moduli.shear / (1.0 - poissonRatio(moduli));
  const double width = cell.share() / layer.thickness;
  return width / cell.stiffnessShare() * spacing * stiffness;
}

// Indices of cells that the mesh fills in part, with a node in the box or next to it, ascending.
std::vector<int> cellsAround(const Lattice& lattice, const CellSet& cells, const Box& box) {
  const Vec3 beside = Vec3::Constant(lattice.spacing());
  std::vector<int> met;
  for (const int node : lattice.nodesIn({box.min() - beside, box.max() + beside})) {
    for (const CellSet::Meeting& there : cells.meetings(node)) {
      const int number = static_cast<int>(there.cell);
      if (lattice.cells()[at(cells.all()[at(number)].place)].share() < 1.0) met.push_back(number);
    }
  }
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
  return met;
}

using Shares = std::array<double, kFaceNodes>;

// Of the spacing, as of boxes of nodes.
constexpr double kSlack = 1e-3;

// What the box holds of a cell's sides.
class CellInBox {
 public:
  // The box's corners, in spacings from the cell's lowest one.
  CellInBox(const Cell& cell, const Vec3& low, const Vec3& high)
      : cell_(cell), low_(low), high_(high) {}

  // Of the side's nodes: the mean of each one's shape function over the side, where the box is; 1
  // in sum where it holds all of the side, 0 where it does not reach it, or a cut took them.
  Shares sharesOf(int side) const {
    const int axis = side / 2;
    const double place = side % 2;
    Shares shares;
    shares.fill(low_[axis] <= place + kSlack && place - kSlack <= high_[axis] ? 1.0 : 0.0);
    for (int next = 0; next < 2; ++next) {
      const int along = (axis + 1 + next) % 3;
      const double from = std::clamp(low_[along], 0.0, 1.0);
      const double to = std::max(from, std::clamp(high_[along], 0.0, 1.0));
      const double of_upper = 0.5 * (to * to - from * from);
      for (int r = 0; r < kFaceNodes; ++r) {
        shares[at(r)] *= (r >> next & 1) != 0 ? of_upper : to - from - of_upper;
      }
    }
    for (int r = 0; r < kFaceNodes; ++r) {
      if (!cell_.owns(faceCorner(side, r))) shares[at(r)] = 0.0;
    }
    return shares;
  }

  double shareOf(int side) const {
    const Shares shares = sharesOf(side);
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    return sum < kSlack ? 0.0 : sum;
  }

 private:
  const Cell& cell_;
  Vec3 low_, high_;
};

}  // namespace

std::vector<RimSpring> bedOf(const Lattice& lattice, const TissueModel& model,
                             const LatticeState& state, const Box& box,
                             const std::vector<int>& nodes) {
  const auto is_held = [&](int node) {
    return std::binary_search(nodes.begin(), nodes.end(), node) ||
           (node < lattice.nodeCount() && lattice.isFixed(node));
  };
  std::map<int, Vec3> stiffness;
  for (const int number : cellsAround(lattice, *state.cells, box)) {
    const Cell& cell = state.cells->all()[at(number)];
    const Vec3 lowest = lattice.restPosition(lattice.cells()[at(cell.place)].nodes.front());
    const CellInBox in_box(cell, (box.min() - lowest) / lattice.spacing(),
                           (box.max() - lowest) / lattice.spacing());
    const auto layer = heldLayer(cell, [&](int side) { return in_box.shareOf(side); });
    if (!layer) continue;
    const Vec3 full = fullStiffness(cell, *layer, model, lattice.spacing());
    if (full.isZero(0.0)) continue;
    const Shares shares = in_box.sharesOf(layer->side);
    for (int r = 0; r < kFaceNodes; ++r) {
      const bool is_on_plate = is_held(cell.nodes[at(faceCorner(layer->side, r))]);
      const int across = cell.nodes[at(faceCorner(layer->side ^ 1, r))];
      const double there = is_on_plate ? layer->thickness / kFaceNodes : 0.0;
      const double lacking = shares[at(r)] / layer->thickness - there;
      // Where a cut is between, the part on the plate is free across.
      const bool is_parted = !cell.owns(faceCorner(layer->side ^ 1, r));
      if (lacking <= 0.0 || is_parted || is_held(across)) continue;
      stiffness.emplace(across, Vec3::Zero()).first->second += lacking * full;
    }
  }
  std::vector<RimSpring> bed;
  for (const auto& [node, of_node] : stiffness) bed.push_back({node, of_node, Vec3::Zero()});
  return bed;
}

}  // namespace robot_tissue
