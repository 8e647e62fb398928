// The levels of a tissue and what joins them: on each the part that is open, between a level and
// the next coarser one the transfer P, and which node of the tissue is which entry of the finest.
//
// Of a block, cut or not, each level is open in a part only, wider from level to level; nodes
// beyond are where the next coarser level has them, u = P u_coarse. Where two spacings meet, the
// forces of the fine cells go to the coarse nodes by P^T, so that nothing is lost there (fast
// adaptive composite grid: McCormick 1984). A part has all that is cut, so that what meets beyond
// it is whole. What was no block before cuts is open as a whole on every level.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "material/elastic_model.h"
#include "robot_tissue/core/lattice.h"
#include "solvers/multigrid/hierarchy/grid_transfer.h"
#include "solvers/multigrid/hierarchy/level_source.h"
#include "solvers/multigrid/hierarchy/light_nodes.h"
#include "solvers/multigrid/hierarchy/membrane_levels.h"
#include "solvers/multigrid/hierarchy/node_loads.h"
#include "solvers/multigrid/level/grid_level.h"

namespace robot_tissue {

// What another grid of the same lattice knows, of a block. All but the sources: where few cells
// have changed since.
struct KnownLevels {
  std::vector<LevelSource> sources;
  std::vector<double> stiffness;  // as GridLevel::greatestStiffness, per level; empty: not known
  GridBox changed;                // points of the finest lattice around those cells
  GridBox box;                    // to be open from the first on, with so many layers
  int layers = 0;
  GridBox between = kNowhere;  // FreeEnds::between; empty: all of the lattice
};

// A box as seen from that point.
inline GridBox from(const GridBox& box, const std::array<int, 3>& origin) {
  GridBox local = box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    local.low[axis] -= origin[axis];
    local.high[axis] -= origin[axis];
  }
  return local;
}

template <typename Real>
class CompositeGrid {
 public:
  // A block is open in its middle where its stiffness is not known. The workers, null for none,
  // must outlive the grid.
  CompositeGrid(const Lattice& lattice, const ElasticModel& model, const CellSet& cells,
                Workers* workers, KnownLevels known);

  // Opens the least part that has the box (points of the finest lattice), and so many layers more
  // on each coarser level. The levels are new then, at rest and held by nothing. False: it was
  // open, and nothing changed.
  bool open(const GridBox& box, int layers);

  bool isBlock() const { return !sources_.empty(); }
  bool isCut() const { return isBlock() && !sources_.front().listed.isEmpty(); }
  bool isWhole() const { return free_.front() == whole(); }  // all of the finest level is open
  // Nodes of the finest lattice that are open, and those between its ends, which are left out.
  const GridBox& free() const { return isWhole() ? between_ : free_.front(); }
  const GridBox& between() const { return between_; }
  bool hasEnds() const { return between_ != wholeOf(lattice_.size()); }

  std::size_t levelCount() const { return levels_.size(); }
  // For the next grid; empty where this is no block.
  std::vector<LevelSource> takeSources() { return std::move(sources_); }
  std::vector<double> greatestStiffness() const;  // as GridLevel's, per level
  GridLevel<Real>& level(std::size_t index) { return levels_[index]; }
  const GridLevel<Real>& level(std::size_t index) const { return levels_[index]; }
  GridLevel<Real>& finest() { return levels_.front(); }
  const GridLevel<Real>& finest() const { return levels_.front(); }
  // Between this level and the next coarser one.
  GridTransfer<Real>& transfer(std::size_t fine) { return transfers_[fine]; }
  const GridTransfer<Real>& transfer(std::size_t fine) const { return transfers_[fine]; }
  // Puts a level's interface nodes, then those of all levels, where the coarser level has them.
  void placeInterface(std::size_t fine);
  void placeInterfaces();

  // Of a block: points of a level's whole grid that its open part has, those next to free ones too.
  const GridBox& points(std::size_t level) const { return points_[level]; }
  LevelGrid wholeGrid(std::size_t level) const { return LevelGrid(sources_[level].size); }
  // Of a block: calls visit(entry, node) with the entries of a coarse level and the tissue's node
  // at each one's place, or next to it where the block ends before.
  template <typename Visit>
  void forNodesAt(std::size_t level, Visit visit) const;

  // Of a block: what of a level is cut, with some more (ListedCells).
  const GridBox& cutBox(std::size_t level) const { return sources_[level].listed.box; }

  // Of the tissue, in the open part, and their entries in the finest level's fields.
  const std::vector<int>& nodes() const { return nodes_; }
  const std::vector<int>& entries() const { return entries_; }
  int entryOf(int node) const;             // -1: not in the open part
  int nodeAt(int i, int j, int k) const {  // at a point of the finest level's whole grid
    return lattice_.node(i + between_.low[0], j + between_.low[1], k + between_.low[2]);
  }

  const Lattice& lattice() const { return lattice_; }
  Workers* workers() const { return workers_; }
  // E0 (Pa); in a time step times InertialTerm::elastic_scale.
  double modulus() const { return loads_.scale() * modulus_; }
  double spacing() const { return spacing_; }  // h (m), of the finest lattice
  // Of nodes (E0 h^2), with what acts on them in a time step besides; empty: no gravity, no step.
  const Field<Real>& weight() const { return loads_.onFinest(); }

  // As MembraneLevels.
  bool renewMembranes() { return membranes_.renew(levels_); }
  void forgetMembranes() { membranes_.forget(levels_); }
  void coupleMembranes(bool together) { membranes_.couple(together, levels_); }

  // Solves are of a time step from now on; null: they are not. What holds the nodes is to be bound
  // anew, forces are stale.
  void takeTimeStep(const InertialTerm* inertia);

 private:
  void measureStiffness();
  void measureChanged(const KnownLevels& known);
  double stiffnessIn(std::size_t level, const GridBox& points) const;
  GridBox middle() const;
  GridBox whole() const { return from(between_, between_.low); }  // points of the finest level
  std::vector<GridBox> partsAround(const GridBox& box, int layers) const;
  void openParts(const std::vector<GridBox>& free);
  void addTransfer(GridTransfer<Real> transfer);
  GridTransfer<Real> transferTo(std::size_t level, const LevelGrid& grid) const;
  void addListed(std::size_t level, const LevelGrid& grid, Coarsening& to) const;
  void openAll(const ElasticModel& model, const CellSet& cells);
  std::vector<LevelCell> finestCells(const ElasticModel& model, const CellSet& cells) const;
  void addLevel(const LevelGrid& grid, int beside, const std::vector<LevelCell>& cells,
                const LevelPart& part, double greatest_stiffness);
  void weighNodes();
  WholeLevels<Real> wholeLevels();

  const Lattice& lattice_;
  Workers* workers_;
  double spacing_;
  double modulus_ = 1.0;
  GridBox between_;                   // points of the lattice: those of the levels' grids
  std::vector<LevelSource> sources_;  // empty where parts cannot be open
  std::vector<GridBox> free_;         // per level, in points of its whole grid
  std::vector<GridBox> points_;
  std::vector<GridLevel<Real>> levels_;
  std::vector<GridTransfer<Real>> transfers_;  // from level i to i + 1
  std::vector<int> nodes_;
  std::vector<int> entries_;
  std::vector<LightNode> light_nodes_;
  NodeLoads<Real> loads_;  // none where parts can be open
  MembraneLevels<Real> membranes_;
};

template <typename Real>
template <typename Visit>
void CompositeGrid<Real>::forNodesAt(std::size_t level, Visit visit) const {
  const GridBox& points = points_[level];
  const LevelGrid& grid = levels_[level].grid();
  const std::array<int, 3> last = whole().high;
  for (int k = points.low[2]; k <= points.high[2]; ++k) {
    for (int j = points.low[1]; j <= points.high[1]; ++j) {
      for (int i = points.low[0]; i <= points.high[0]; ++i) {
        const std::array<int, 3> there = {std::min(i << level, last[0]),
                                          std::min(j << level, last[1]),
                                          std::min(k << level, last[2])};
        visit(grid.index(i - points.low[0], j - points.low[1], k - points.low[2]),
              nodeAt(there[0], there[1], there[2]));
      }
    }
  }
}

extern template class CompositeGrid<float>;
extern template class CompositeGrid<double>;

}  // namespace robot_tissue
