#include "loads/patch_bed.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "lattice/held_layers.h"
#include "loads/rim_law.h"

namespace robot_tissue {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Of the spacing, as of boxes of nodes.
constexpr double kSlack = 1e-3;

// Of a layer that gives way across the axis, and along it (Pa).
Vec3 fullModuli(const Moduli& moduli, int side) {
  Vec3 full = Vec3::Constant(moduli.shear);
  // E / (1 - nu^2): the nodes across give way to the sides, but not as freely as a bar's.
  full[side / 2] = 2.0 * moduli.shear / (1.0 - poissonRatio(moduli));
  return full;
}

// Indices of cells with a node in the box or up to a spacing from it, ascending.
std::vector<int> cellsAround(const Lattice& lattice, const CellSet& cells, const Box& box) {
  const Vec3 beside = Vec3::Constant(lattice.spacing());
  std::vector<int> met;
  for (const int node : lattice.nodesIn({box.min() - beside, box.max() + beside})) {
    for (const CellSet::Meeting& there : cells.meetings(node)) {
      met.push_back(static_cast<int>(there.cell));
    }
  }
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
  return met;
}

struct Range {
  double from = 0.0;
  double to = 0.0;
};

// Of the cell's material, in spacings from its lowest corner.
Range materialAlong(const Cell& cell, int axis) {
  if (cell.fill == nullptr) return {0.0, 1.0};
  const double middle = 0.5 + cell.fill->centroid[axis];
  const double reach = cell.fill->reachAlong(Vec3::Unit(axis));
  return {std::max(0.0, middle - reach), std::min(1.0, middle + reach)};
}

// Each edge of a cell across a layer has a joint to the patch, as a node of a block's patch has one
// where its edge runs over tissue; it is where the edge goes through the surface.
class BedBuilder {
 public:
  BedBuilder(const Lattice& lattice, const TissueModel& model, const LatticeState& state,
             const Box& box, const std::vector<int>& nodes)
      : lattice_(lattice), model_(model), cells_(*state.cells), box_(box), nodes_(nodes) {}

  std::optional<std::vector<RimSpring>> build() {
    const std::vector<int> around = cellsAround(lattice_, cells_, box_);
    const auto isFilledInPart = [&](int number) {
      return lattice_.cells()[at(cells_.all()[at(number)].place)].share() < 1.0;
    };
    if (std::none_of(around.begin(), around.end(), isFilledInPart)) return std::nullopt;
    findSides(around);
    std::vector<Column> columns;
    for (const int number : around) addColumns(cells_.all()[at(number)], columns);
    for (const Column& column : columns) markHard(column);
    for (const Column& column : columns) joinOnPlate(column);
    for (const Column& column : columns) joinAcross(column);
    std::vector<RimSpring> bed;
    for (const auto& [node, of_node] : stiffness_) bed.push_back({node, of_node, Vec3::Zero()});
    return bed;
  }

 private:
  // An edge of a cell across a layer, with the quarter of the cell that is next to it.
  struct Column {
    int on_plate = 0;  // node
    int across = 0;    // node, -1: a cut is between
    double thickness = 1.0;
    Vec3 full = Vec3::Zero();   // of the layer, were it a spacing thick (N/m)
    Vec3 joint = Vec3::Zero();  // between patch and surface, by the law of the rim (N/m)
    bool is_rim = false;        // else the joint is hard
  };

  // Sides by which the box covers material.
  void findSides(const std::vector<int>& around) {
    for (const int number : around) {
      const Cell& cell = cells_.all()[at(number)];
      for (int side = 0; side < kSides; ++side) {
        if (layerAt(cell, side) && coverOf(cell, side) > kSlack) covered_[at(side)] = true;
      }
    }
  }

  // Where the box holds nodes on that side of the cell, which no material goes on beyond; a layer
  // of no thickness, where it holds those across, too. Nothing: it goes deeper.
  std::optional<HeldLayer> layerAt(const Cell& cell, int side) const {
    const int axis = side / 2;
    const int outwards = side % 2 == 0 ? -1 : 1;
    const double plane = lowest(cell)[axis] + (side % 2) * lattice_.spacing();
    const auto isInBox = [&](int planes_inwards) {
      const double there = plane - outwards * planes_inwards * lattice_.spacing();
      const double slack = kSlack * lattice_.spacing();
      return box_.min()[axis] - slack <= there && there <= box_.max()[axis] + slack;
    };
    if (!isInBox(0) || isInBox(2)) return std::nullopt;
    const double gap = cell.fill == nullptr ? 0.0 : gapAt(*cell.fill, side);
    if (gap == 0.0 && goesOn(cell, side)) return std::nullopt;
    return HeldLayer{side, isInBox(1) ? 0.0 : 1.0 - gap};
  }

  // There is a cell beyond the side.
  bool goesOn(const Cell& cell, int side) const {
    for (int r = 0; r < kFaceNodes; ++r) {
      const int corner = faceCorner(side, r);
      if (cell.owns(corner) && cellWith(cell.nodes[at(corner)], faceCorner(side ^ 1, r)) != nullptr)
        return true;
    }
    return false;
  }

  // Of the side by which most of the cell's material is covered; of several the thinnest.
  std::optional<HeldLayer> layerOf(const Cell& cell) const {
    std::optional<HeldLayer> found;
    double most = 0.0;
    for (int side = 0; side < kSides; ++side) {
      if (!covered_[at(side)]) continue;
      const auto layer = layerAt(cell, side);
      if (!layer) continue;
      const double cover = coverOf(cell, side);
      if (cover < most || cover <= 0.0) continue;
      if (found && cover == most && layer->thickness >= found->thickness) continue;
      found = layer;
      most = cover;
    }
    return found;
  }

  void addColumns(const Cell& cell, std::vector<Column>& columns) const {
    const Moduli moduli = model_.moduliIn(cell);
    if (moduli.shear <= 0.0) return;
    const auto layer = layerOf(cell);
    if (!layer) return;
    const double thickness = cell.fill == nullptr ? 1.0 : 1.0 - gapAt(*cell.fill, layer->side);
    const double wide = cell.share() / thickness;
    const double unit = wide / cell.stiffnessShare() * lattice_.spacing() / kFaceNodes;
    const Vec3 full = unit * fullModuli(moduli, layer->side);
    const RimLaw law = rimLaw(poissonRatio(moduli));
    for (int r = 0; r < kFaceNodes; ++r) {
      const int corner = faceCorner(layer->side, r);
      if (!cell.owns(corner)) continue;
      const Vec3 compliance = complianceAt(cell, corner, layer->side / 2, law);
      const Vec3 joint = compliance.cwiseInverse().cwiseMin(kHardestRim);
      if (joint.maxCoeff() == 0.0) continue;
      const int opposite = faceCorner(layer->side ^ 1, r);
      columns.push_back({cell.nodes[at(corner)],
                         cell.owns(opposite) ? cell.nodes[at(opposite)] : -1, layer->thickness,
                         full, unit * moduli.shear * joint, compliance.maxCoeff() > 0.0});
    }
  }

  Vec3 lowest(const Cell& cell) const {
    return lattice_.restPosition(lattice_.cells()[at(cell.place)].nodes.front());
  }

  // How much of the cell's material the box covers, seen along the side's normal, 0 to 1; less than
  // kSlack: none, and it is so near.
  double coverOf(const Cell& cell, int side) const {
    const Vec3 low = (box_.min() - lowest(cell)) / lattice_.spacing();
    const Vec3 high = (box_.max() - lowest(cell)) / lattice_.spacing();
    double share = 1.0;
    for (int next = 1; next <= 2; ++next) {
      const int along = (side / 2 + next) % 3;
      const Range material = materialAlong(cell, along);
      const double covered =
          std::min(material.to, high[along]) - std::max(material.from, low[along]);
      const double wide = std::max(kSlack, material.to - material.from);
      share *= covered > kSlack ? std::min(1.0, covered / wide)
                                : kSlack * std::max(0.0, 1.0 + std::min(0.0, covered));
    }
    return share;
  }

  // Of the joint at the cell's corner, over shear modulus times spacing. The compliances of the
  // edges around a corner of the patch add.
  Vec3 complianceAt(const Cell& cell, int corner, int normal, const RimLaw& law) const {
    Vec3 compliance = Vec3::Zero();
    for (int across = 0; across < 3; ++across) {
      if (across == normal) continue;
      for (const int side : {-1, 1}) {
        const double depth = depthOf(cell, corner, across, side);
        for (int axis = 0; axis < 3; ++axis) {
          const RimMode& mode =
              axis == across ? law.across : (axis == normal ? law.normal : law.along);
          compliance[axis] += 1.0 / rimStiffness(mode, depth);
        }
      }
    }
    return compliance;
  }

  // Of the cell's corner inside the patch's edge on this side, in spacings; infinite where the
  // tissue ends with the patch.
  double depthOf(const Cell& cell, int corner, int axis, int side) const {
    const double rest = lowest(cell)[axis] + (corner >> axis & 1) * lattice_.spacing();
    const double depth =
        (side > 0 ? box_.max()[axis] - rest : rest - box_.min()[axis]) / lattice_.spacing();
    if (depth >= 1.0 || depth <= -1.0) return depth;
    // The cell that the edge is in has the corner on its lower or upper side.
    const bool is_inside = depth > -kSlack;
    const bool is_upper = (side > 0) != is_inside;
    const int its_corner = is_upper ? corner | 1 << axis : corner & ~(1 << axis);
    const Cell* there = cellWith(cell.nodes[at(corner)], its_corner);
    if (there == nullptr) return is_inside ? kInfinite : depth;
    const Range material = materialAlong(*there, axis);
    const double edge = (is_upper ? 1.0 : 0.0) + side * depth;
    const bool ends = side > 0 ? material.to <= std::min(edge + kSlack, 1.0 - kSlack)
                               : material.from >= std::max(edge - kSlack, kSlack);
    return ends ? kInfinite : depth;
  }

  // The cell that has the node at that corner; null: there is none.
  const Cell* cellWith(int node, int corner) const {
    for (const CellSet::Meeting& there : cells_.meetings(node)) {
      if (static_cast<int>(there.corner) == corner)
        return &cells_.all()[at(static_cast<int>(there.cell))];
    }
    return nullptr;
  }

  bool isHard(int node) const {
    return hard_.count(node) != 0 || (node < lattice_.nodeCount() && lattice_.isFixed(node));
  }
  bool isInPatch(int node) const { return std::binary_search(nodes_.begin(), nodes_.end(), node); }

  // In the patch, and not at its rim.
  void markHard(const Column& column) {
    if (column.is_rim) return;
    if (isInPatch(column.on_plate)) hard_.insert(column.on_plate);
    if (column.thickness == 0.0 && isInPatch(column.across)) hard_.insert(column.across);
  }

  void joinOnPlate(const Column& column) {
    if (isHard(column.on_plate)) return;
    sprung_.insert(column.on_plate);
    add(column.on_plate, column.joint);
  }

  // Joint and layer in series, less what goes by the node on the plate: so what is across is held
  // as it would be, were the joint at the surface.
  void joinAcross(const Column& column) {
    const int node = column.across;
    if (node < 0 || isHard(node)) return;
    if (column.thickness == 0.0) return add(node, column.joint);
    if (isInPatch(node)) return;
    const auto inSeries = [](const Vec3& a, const Vec3& b) -> Vec3 {
      return (a.cwiseInverse() + b.cwiseInverse()).cwiseInverse();
    };
    const Vec3 through = column.thickness * column.full;
    const Vec3 there =
        sprung_.count(column.on_plate) != 0 ? inSeries(column.joint, through) : through;
    const Vec3 lacking = inSeries(column.joint, column.full / column.thickness) - there;
    add(node, lacking.cwiseMax(0.0));
  }

  void add(int node, const Vec3& stiffness) {
    if (stiffness.isZero(0.0)) return;
    stiffness_.emplace(node, Vec3::Zero()).first->second += stiffness;
  }

  const Lattice& lattice_;
  const TissueModel& model_;
  const CellSet& cells_;
  const Box& box_;
  const std::vector<int>& nodes_;
  std::array<bool, kSides> covered_{};
  std::set<int> hard_;             // nodes
  std::set<int> sprung_;           // nodes on the plate that a joint holds
  std::map<int, Vec3> stiffness_;  // per node
};

}  // namespace

std::optional<std::vector<RimSpring>> bedOf(const Lattice& lattice, const TissueModel& model,
                                            const LatticeState& state, const Box& box,
                                            const std::vector<int>& nodes) {
  return BedBuilder(lattice, model, state, box, nodes).build();
}

}  // namespace robot_tissue
