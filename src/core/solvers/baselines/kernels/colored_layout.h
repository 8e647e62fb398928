// The lattice laid out for vector instructions (own). Grid points of one color, which is the parity
// of their three indices, stand next to each other; so nodes of one color share no cell, nor do
// cells of one color share a node, and what stands at a given place beside a run of them is again a
// run. A slot is a point's place in the arrays. Ghosts have slots of their own behind the grid's.
#pragma once

#include <array>
#include <vector>

#include "robot_tissue/core/lattice.h"
#include "simd/lanes.h"

namespace robot_tissue {

constexpr int kColors = 8;

class ColoredLayout {
 public:
  // Slots from the points of a color to those beside them, by cell around them and its corner.
  struct Around {
    int cell = 0;               // to the cell's lowest corner
    int corner[kCorners] = {};  // to its corners; seen from the point: bits are axes, itself 0
    float side[3] = {};         // per axis: the point is at the cell's lower end -1, upper 1
  };

  explicit ColoredLayout(const Lattice& lattice);

  // Slots, with those of so many ghosts; one more block of lanes may be read behind them.
  int slotCount(int ghosts) const;
  int slotAt(const std::array<int, 3>& index) const;
  int ghostSlot(int ghost) const { return kColors * stride_ + ghost; }
  int colorOf(int slot) const { return slot / stride_; }
  const std::array<Around, kCorners>& around(int color) const { return around_[at(color)]; }
  // Blocks of kLanes slots.
  int firstBlock(int color) const { return color * stride_ + guard_; }
  int lastBlock(int color) const { return (color + 1) * stride_ - guard_; }

 private:
  int shift(int color, const std::array<int, 3>& step) const;

  std::array<int, 3> half_{};  // points of a color along each axis; one more keeps rows apart
  int guard_ = 0;              // empty slots before and behind a color's
  int stride_ = 0;             // from color to color
  std::array<std::array<Around, kCorners>, kColors> around_;
};

}  // namespace robot_tissue
