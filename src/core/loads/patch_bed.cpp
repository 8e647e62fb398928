#include "loads/patch_bed.h"

#include <algorithm>
#include <map>

#include "lattice/held_layers.h"

namespace robot_tissue {
namespace {

// Of the springs to each of the four nodes across the layer (N/m).
Vec3 lackingStiffness(const Cell& cell, const HeldLayer& layer, const TissueModel& model,
                      double spacing) {
  const Moduli moduli = model.moduliIn(cell);  // of what the cell has
  const double nodes_width = cell.share() / layer.thickness / kFaceNodes;
  const double lacking = (1.0 / layer.thickness - layer.thickness) / cell.stiffnessShare();
  Vec3 stiffness = Vec3::Constant(moduli.shear);
  // E / (1 - nu^2): the nodes across give way to the sides, but not as freely as a bar's.
  if (moduli.shear > 0.0) {
    stiffness[layer.side / 2] = 2.0 * moduli.shear / (1.0 - poissonRatio(moduli));
  }
  return lacking * nodes_width * spacing * stiffness;
}

// Indices of cells with one of these nodes, ascending.
std::vector<int> cellsAt(const CellSet& cells, const std::vector<int>& nodes) {
  std::vector<int> met;
  for (const int node : nodes) {
    for (const CellSet::Meeting& there : cells.meetings(node)) {
      if (cells.all()[at(there.cell)].fill != nullptr) met.push_back(static_cast<int>(there.cell));
    }
  }
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
  return met;
}

}  // namespace

std::vector<RimSpring> bedOf(const Lattice& lattice, const TissueModel& model,
                             const LatticeState& state, const std::vector<int>& nodes) {
  const auto is_held = [&](int node) {
    return std::binary_search(nodes.begin(), nodes.end(), node) ||
           (node < lattice.nodeCount() && lattice.isFixed(node));
  };
  std::map<int, Vec3> stiffness;
  for (const int number : cellsAt(*state.cells, nodes)) {
    const Cell& cell = state.cells->all()[at(number)];
    const auto layer = heldLayer(cell, is_held);
    if (!layer) continue;
    const Vec3 lacking = lackingStiffness(cell, *layer, model, lattice.spacing());
    if (lacking.isZero(0.0)) continue;
    for (int r = 0; r < kFaceNodes; ++r) {
      const int across = cell.nodes[at(faceCorner(layer->side ^ 1, r))];
      if (!is_held(across)) stiffness.emplace(across, Vec3::Zero()).first->second += lacking;
    }
  }
  std::vector<RimSpring> bed;
  for (const auto& [node, of_node] : stiffness) bed.push_back({node, of_node, Vec3::Zero()});
  return bed;
}

}  // namespace robot_tissue
