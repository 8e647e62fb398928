#include "solvers/baselines/kernels/colored_layout.h"

namespace robot_tissue {
namespace {

int inBlocks(int slots) { return (slots + kLanes - 1) / kLanes * kLanes; }

}  // namespace

ColoredLayout::ColoredLayout(const Lattice& lattice) {
  for (std::size_t axis = 0; axis < 3; ++axis) half_[axis] = (lattice.size()[axis] + 1) / 2;
  ++half_[0];
  ++half_[1];
  guard_ = inBlocks(1 + half_[0] * (1 + half_[1]));
  stride_ = guard_ + inBlocks(half_[0] * half_[1] * half_[2]) + guard_;
  for (int color = 0; color < kColors; ++color) {
    for (int cell = 0; cell < kCorners; ++cell) {
      Around& around = around_[at(color)][at(cell)];
      std::array<int, 3> lowest{};
      for (int axis = 0; axis < 3; ++axis) {
        const bool above = (cell >> axis & 1) != 0;  // the cell is, so the point at its lower end
        lowest[at(axis)] = above ? 0 : -1;
        around.side[axis] = above ? -1.0F : 1.0F;
      }
      around.cell = shift(color, lowest);
      for (int corner = 0; corner < kCorners; ++corner) {
        std::array<int, 3> step{};
        for (int axis = 0; axis < 3; ++axis) {
          if ((corner >> axis & 1) != 0) step[at(axis)] = (cell >> axis & 1) != 0 ? 1 : -1;
        }
        around.corner[corner] = shift(color, step);
      }
    }
  }
}

int ColoredLayout::slotCount(int ghosts) const { return ghostSlot(ghosts) + guard_ + kLanes; }

int ColoredLayout::slotAt(const std::array<int, 3>& index) const {
  const int color = (index[0] & 1) + 2 * (index[1] & 1) + 4 * (index[2] & 1);
  return firstBlock(color) + index[0] / 2 + half_[0] * (index[1] / 2 + half_[1] * (index[2] / 2));
}

int ColoredLayout::shift(int color, const std::array<int, 3>& step) const {
  int to_color = 0, points = 0, row = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int parity = color >> axis & 1;
    const int to_parity = (parity + step[at(axis)]) & 1;
    to_color += to_parity << axis;
    points += row * (parity + step[at(axis)] - to_parity) / 2;
    row *= half_[at(axis)];
  }
  return (to_color - color) * stride_ + points;
}

}  // namespace robot_tissue
