#include "loads/patch_bed.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "loads/bed_columns.h"
#include "loads/rim_law.h"

namespace robot_tissue {
namespace {

// Indices of cells with a node in the box or up to a spacing from it, ascending.
std::vector<int> cellsAround(const Lattice& lattice, const CellSet& cells, const Box& box) {
  const Vec3 beside = Vec3::Constant(lattice.spacing());
  return cellsAt(cells, lattice.nodesIn({box.min() - beside, box.max() + beside}));
}

class BedBuilder {
 public:
  BedBuilder(const Lattice& lattice, const TissueModel& model, const LatticeState& state,
             const Box& box, const std::vector<int>& nodes)
      : lattice_(lattice),
        cells_(*state.cells),
        box_(box),
        nodes_(nodes),
        columns_(lattice, model, *state.cells) {}

  std::optional<std::vector<RimSpring>> build() {
    const std::vector<int> around = cellsAround(lattice_, cells_, box_);
    const auto isFilledInPart = [&](int number) {
      return lattice_.cells()[at(cells_.all()[at(number)].place)].share() < 1.0;
    };
    if (std::none_of(around.begin(), around.end(), isFilledInPart)) return std::nullopt;
    findSides(around);
    for (const int number : around) addColumns(cells_.all()[at(number)]);
    std::vector<RimSpring> bed;
    for (const auto& [node, of_node] :
         columns_.springs([&](int node) { return isInPatch(node); })) {
      bed.push_back({node, of_node, Vec3::Zero()});
    }
    return bed;
  }

 private:
  // Sides by which the box covers material.
  void findSides(const std::vector<int>& around) {
    for (const int number : around) {
      const Cell& cell = cells_.all()[at(number)];
      for (int side = 0; side < kSides; ++side) {
        if (layerAt(cell, side) && coverOf(cell, side) > kBedSlack) covered_[at(side)] = true;
      }
    }
  }

  // Where the box holds nodes on that side of the cell, which no material goes on beyond; a layer
  // of no thickness, where it holds those across, too. Nothing: it goes deeper.
  std::optional<HeldLayer> layerAt(const Cell& cell, int side) const {
    const int axis = side / 2;
    const int outwards = side % 2 == 0 ? -1 : 1;
    const double plane = columns_.lowest(cell)[axis] + (side % 2) * lattice_.spacing();
    const auto isInBox = [&](int planes_inwards) {
      const double there = plane - outwards * planes_inwards * lattice_.spacing();
      const double slack = kBedSlack * lattice_.spacing();
      return box_.min()[axis] - slack <= there && there <= box_.max()[axis] + slack;
    };
    if (!isInBox(0) || isInBox(2)) return std::nullopt;
    std::optional<HeldLayer> layer = columns_.layerAt(cell, side);
    if (layer && isInBox(1)) layer->thickness = 0.0;
    return layer;
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

  void addColumns(const Cell& cell) {
    const auto layer = layerOf(cell);
    if (!layer) return;
    columns_.add(cell, *layer, [&](int corner, const RimLaw& law) {
      return complianceAt(cell, corner, layer->side / 2, law);
    });
  }

  // How much of the cell's material the box covers, seen along the side's normal, 0 to 1; less than
  // kBedSlack: none, and it is so near.
  double coverOf(const Cell& cell, int side) const {
    const Vec3 low = (box_.min() - columns_.lowest(cell)) / lattice_.spacing();
    const Vec3 high = (box_.max() - columns_.lowest(cell)) / lattice_.spacing();
    double share = 1.0;
    for (int next = 1; next <= 2; ++next) {
      const int along = (side / 2 + next) % 3;
      const MaterialRange material = materialAlong(cell, along);
      const double covered =
          std::min(material.to, high[along]) - std::max(material.from, low[along]);
      const double wide = std::max(kBedSlack, material.to - material.from);
      share *= covered > kBedSlack ? std::min(1.0, covered / wide)
                                   : kBedSlack * std::max(0.0, 1.0 + std::min(0.0, covered));
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
    const double rest = columns_.lowest(cell)[axis] + (corner >> axis & 1) * lattice_.spacing();
    const double depth =
        (side > 0 ? box_.max()[axis] - rest : rest - box_.min()[axis]) / lattice_.spacing();
    return columns_.depthInTissue(cell, corner, axis, side, depth);
  }

  bool isInPatch(int node) const { return std::binary_search(nodes_.begin(), nodes_.end(), node); }

  const Lattice& lattice_;
  const CellSet& cells_;
  const Box& box_;
  const std::vector<int>& nodes_;
  BedColumns columns_;
  std::array<bool, kSides> covered_{};
};

}  // namespace

std::optional<std::vector<RimSpring>> bedOf(const Lattice& lattice, const TissueModel& model,
                                            const LatticeState& state, const Box& box,
                                            const std::vector<int>& nodes) {
  return BedBuilder(lattice, model, state, box, nodes).build();
}

}  // namespace robot_tissue
