// The columns by which a plate holds a surface that stands between the lattice's nodes (own;
// doc/model.md, "Shapes by a mesh"): edges of cells across a layer, each with the quarter of the
// cell that is next to it. Each has a joint to the plate, as a node of a block's patch has one
// where its edge runs over tissue; it is where the edge goes through the surface.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "lattice/held_layers.h"
#include "loads/rim_law.h"
#include "material/tissue_model.h"
#include "robot_tissue/core/lattice.h"

namespace robot_tissue {

class BedColumns {
 public:
  BedColumns(const Lattice& lattice, const TissueModel& model, const CellSet& cells)
      : lattice_(lattice), model_(model), cells_(cells) {}

  // Of the joint at a corner of the cell, over shear modulus times spacing; zero: hard.
  using Compliance = std::function<Vec3(int corner, const RimLaw& law)>;
  void add(const Cell& cell, const HeldLayer& layer, const Compliance& compliance_at);
  // Stiffness by node (N/m), of those that are not hard (isHard); `is_in_plate`: nodes that go with
  // it.
  std::map<int, Vec3> springs(const std::function<bool(int node)>& is_in_plate);
  // Fixed, or in the plate and not at its rim.
  bool isHard(int node) const;
  bool empty() const { return columns_.empty(); }

  // From the material's plane on that side to the nodes across; nothing: tissue goes on beyond.
  std::optional<HeldLayer> layerAt(const Cell& cell, int side) const;
  // Of the cell's corner inside the plate's edge that way (spacings, < 0: beyond it), given;
  // infinite where the tissue ends with the plate.
  double depthInTissue(const Cell& cell, int corner, int axis, int side, double depth) const;
  Vec3 lowest(const Cell& cell) const;

 private:
  struct Column {
    int on_plate = 0;  // node
    int across = 0;    // node, -1: a cut is between
    double thickness = 1.0;
    Vec3 full = Vec3::Zero();   // of the layer, were it a spacing thick (N/m)
    Vec3 joint = Vec3::Zero();  // between plate and surface, by the law of the rim (N/m)
    bool is_rim = false;        // else the joint is hard
  };

  bool goesOn(const Cell& cell, int side) const;
  const Cell* cellWith(int node, int corner) const;
  void joinOnPlate(const Column& column);
  void joinAcross(const Column& column, const std::function<bool(int)>& is_in_plate);
  void add(int node, const Vec3& stiffness);

  const Lattice& lattice_;
  const TissueModel& model_;
  const CellSet& cells_;
  std::vector<Column> columns_;
  std::set<int> hard_;             // nodes
  std::set<int> sprung_;           // nodes on the plate that a joint holds
  std::map<int, Vec3> stiffness_;  // per node
};

// Of the cell's material along the axis, in spacings from its lowest corner.
struct MaterialRange {
  double from = 0.0;
  double to = 0.0;
};
MaterialRange materialAlong(const Cell& cell, int axis);

// Indices of cells that one of the nodes is a corner of, ascending.
std::vector<int> cellsAt(const CellSet& cells, const std::vector<int>& nodes);

// Of the spacing, as of boxes of nodes.
constexpr double kBedSlack = 1e-3;

}  // namespace robot_tissue
