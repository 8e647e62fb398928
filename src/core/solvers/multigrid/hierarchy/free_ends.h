// The ends of a long block that nothing holds or loads (own). As no force or moment goes through
// them, what balances in itself dies away there (Saint-Venant), and the rest of an end moves as one
// rigid piece, however long it is. So the levels are made without the ends, and the ends go with
// the points where they begin. Where coarse levels tell of bending, parts that are open do the same
// (CompositeGrid); of long blocks they do not, and cycles would be the more the longer the end.
#pragma once

#include <memory>
#include <vector>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/grid_box.h"
#include "robot_tissue/core/lattice.h"
#include "solvers/multigrid/hierarchy/listed_cells.h"

namespace robot_tissue {

class FreeEnds {
 public:
  // Tolerance: what dies away is less there.
  FreeEnds(const Lattice& lattice, double tolerance);

  // Given where the next solve has its loads. True: there is more between the ends than before, and
  // the levels are to be made anew. What is cut has no such ends.
  bool renew(const GridBox& loaded, const std::shared_ptr<const CellSet>& cells);
  // Points of the lattice between the ends, those at which they begin included; all of them where
  // leaving the ends out saves little.
  const GridBox& between() const { return between_; }
  void forget();
  bool mayBeLeftOut() const { return is_long_; }

 private:
  GridBox leastAround(const GridBox& loaded) const;
  GridBox widened(const GridBox& box, int points) const;

  const Lattice& lattice_;
  std::size_t axis_ = 0;  // along which it is long
  int decay_ = 0;         // points beyond what loads and holds it
  bool is_long_ = false;
  GridBox held_ = kNowhere;               // around the fixed nodes
  GridBox between_;                       // empty: not asked for yet
  std::shared_ptr<const CellSet> cells_;  // that were given last
  bool is_cut_ = false;
};

// The points beyond the box move as the outermost ones in it do, as rigid pieces.
void moveEnds(const Lattice& lattice, const GridBox& between, std::vector<Vec3>& displacement);

}  // namespace robot_tissue
