// Membranes on the levels of a grid that is open as a whole: when they are found anew.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "solvers/multigrid/hierarchy/grid_transfer.h"
#include "solvers/multigrid/level/grid_level.h"

namespace robot_tissue {

template <typename Real>
class MembraneLevels {
 public:
  using Levels = std::vector<GridLevel<Real>>;  // from the finest on

  // `membrane` acts on all of them, joined by these transfers, from now on.
  void add(LevelMembrane<Real> membrane, const std::vector<GridTransfer<Real>>& transfers,
           Levels& levels) const;

  // On all levels they become as stiff as the finest one's shape makes them; false: they are,
  // nearly, or there are none, and nothing changed.
  bool renew(Levels& levels);
  void couple(bool together, Levels& levels) const;  // as GridLevel::coupleMembrane
  void forget(Levels& levels);  // they are renewed, come what may, as for the first time

 private:
  bool bind(Levels& levels);
  bool areNew(const GridLevel<Real>& finest) const;

  std::vector<std::vector<std::uint8_t>> held_;  // per level, as they were bound
  Field<Real> displacement_;  // of the finest level when they were renewed; empty: they are to be
};

extern template class MembraneLevels<float>;
extern template class MembraneLevels<double>;

}  // namespace robot_tissue
