// What holds the nodes of every level: the Dirichlet mask, patches by force, springs, gravity.
//
// What holds a fine node holds the coarse node at its place. Where no coarse node stands there,
// ties do: springs from the fine node's place to the coarse nodes around it, as stiff as the fine
// node is. A fine level's springs join the coarse nodes that carry their nodes, with the weights of
// P. In each level's units: arms (spacings) and stiffness (E0 h) are half the finer level's number.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "loads/dof_constraints.h"
#include "solvers/multigrid/hierarchy/composite_grid.h"

namespace robot_tissue {

// Whether the same components of the same nodes are given as before; springs may be others.
enum class Holds { kAsBefore, kOthers };

template <typename Real>
class LevelConstraints {
 public:
  explicit LevelConstraints(CompositeGrid<Real>& grid);

  // To be called when the grid's levels are new: held by nothing.
  void reset();
  // Takes over what holds the nodes, and gravity.
  Holds bind(const ConstrainedState& shape, const DofConstraints& hold);
  // Places patches by force, and takes their motion so far as done.
  void renewGroups(const ConstrainedState& shape, const DofConstraints& hold);
  // Per spring of a coarse level that stands for one of the next finer level: that one. Ties come
  // after these.
  const std::vector<int>& fineSpringsOf(std::size_t coarse) const {
    return from_fine_[coarse - 1].springs;
  }

 private:
  // Which components are given and where springs are, as numbers that are compared; empty: not
  // known.
  struct Pattern {
    std::vector<double> dirichlet, springs;
  };
  // What a coarse level has from the next finer one.
  struct FromFine {
    std::vector<LevelSpring> ties;
    std::vector<int> springs;
  };

  static Pattern patternOf(const ConstrainedState& shape, const DofConstraints& hold);
  void holdFinest(const ConstrainedState& shape, const DofConstraints& hold);
  void addSpringsToFinest(const ConstrainedState& shape, const DofConstraints& hold);
  void renewSprings(const ConstrainedState& shape, const DofConstraints& hold);
  void holdCoarse(std::size_t coarse);
  void addSpringsToCoarse(std::size_t coarse);
  // What freeCarriers keeps from spring to spring.
  struct FreeShares {
    std::vector<std::optional<NodeShares>> of_constrained;  // per node with springs; asked for
    std::vector<int> place_of;  // per coarse node: among a spring's carriers, from 1 on; 0: none
    std::vector<LevelSpring::Carrier> carriers;  // of the spring that was looked at last
  };
  std::vector<LevelSpring::Carrier> freeCarriers(std::size_t coarse,
                                                 const std::vector<LevelSpring::Carrier>& fine,
                                                 FreeShares& known) const;
  NodeShares freeShares(std::size_t coarse, int fine_node) const;
  void addTies(std::size_t coarse);
  void addTie(std::size_t coarse, int fine_node, unsigned axes, int group, const Vec3& arm);

  CompositeGrid<Real>& grid_;
  Pattern pattern_;                       // as bound
  std::vector<ContactSprings> contacts_;  // per patch; the levels' springs point to them
  std::vector<FromFine> from_fine_;
};

extern template class LevelConstraints<float>;
extern template class LevelConstraints<double>;

}  // namespace robot_tissue
