#include "solvers/multigrid/hierarchy/listed_cells.h"

#include <algorithm>

namespace robot_tissue {

GridBox evenAround(const GridBox& box, int layers, const GridBox& whole) {
  GridBox even;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    even.low[axis] = std::max(0, box.low[axis] - layers) / 2 * 2;
    even.high[axis] = std::min(whole.high[axis], (box.high[axis] + layers + 1) / 2 * 2);
  }
  return even;
}

}  // namespace robot_tissue
