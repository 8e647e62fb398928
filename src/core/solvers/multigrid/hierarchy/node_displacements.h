// The displacement of the tissue's nodes (m) from and to the levels of a composite grid, which have
// it in their own spacings, 2^level times that of the finest.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solvers/multigrid/hierarchy/composite_grid.h"

namespace robot_tissue {

template <typename Real>
class NodeDisplacements {
 public:
  explicit NodeDisplacements(CompositeGrid<Real>& grid) : grid_(grid) {}

  // Where nodes of which nothing is held (`held`: bits of axes, per node) are elsewhere than the
  // finest level has them, all levels start from there. True: any node of that level was elsewhere.
  bool take(const std::vector<Vec3>& displacement, const std::vector<std::uint8_t>& held);
  // Of a block: puts the coarse levels' nodes where the nodes at their places are.
  void takeCoarse(const std::vector<Vec3>& displacement);

  Vec3 of(int node) const;  // m
  // Components that are not held.
  void writeTo(std::vector<Vec3>& displacement, const std::vector<std::uint8_t>& held) const;

 private:
  template <typename Visit>
  void forNodes(Visit visit) const;
  Vec3 valueAt(std::size_t level, const std::array<int, 3>& place) const;
  void writeInterpolated(std::vector<Vec3>& displacement) const;
  void putOpenPart(std::size_t level, const LevelGrid& grid, Field<Real>& all) const;
  void writePlanes(const GridTransfer<Real>& transfer, const Field<Real>& coarse,
                   std::vector<Vec3>& displacement) const;
  void writePlanes(const GridTransfer<Real>& transfer, const Field<Real>& coarse, int first,
                   int end, std::vector<Vec3>& displacement) const;

  CompositeGrid<Real>& grid_;
};

extern template class NodeDisplacements<float>;
extern template class NodeDisplacements<double>;

}  // namespace robot_tissue
