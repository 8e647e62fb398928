// As cell_block.h, of cells that are filled in part.
#pragma once

#include <cstring>

#include "solvers/multigrid/level/cell_block.h"

namespace robot_tissue::vectors {

template <typename V>
struct FilledBlock : Block<V> {
  using Real = typename V::Real;
  using L = typename V::Lanes;

  // As FilledCell.
  struct Fill {
    L centroid[3], places[3], pairs[3], bending[3], between_parts[3];
    L twisting;
    PartBox<V> box;
  };

  using Block<V>::mode;
  using Block<V>::a;
  using Block<V>::cofactor;
  using Block<V>::has_parts;
  using Block<V>::invariant;
  using Block<V>::pressure;
  using Block<V>::shear;
  using Block<V>::slight;
  using Block<V>::of_strain;

  static constexpr int pairMode(int left_out) { return 7 ^ 1 << left_out; }

  // From modes about the cell's middle to those whose means are over the fill:
  //   m_a - 2 (m_ab c_b + m_ac c_c) + 4 m_abc p_bc,   m_ab - 2 m_abc c_c,   m_abc
  // with c and p in m_a times the fill's `places`
  // (sign 1), or back (sign -1).
  template <int kSign>
  ROBOT_TISSUE_INLINE void shiftModes(const Fill& fill) {
    constexpr Real kTwo = Real(2 * kSign);
    for (int axis = 0; axis < 3; ++axis) {
      const L twist = mode[7][axis];
      if (kSign < 0) shiftPairs(fill, kTwo, axis);
      for (int a0 = 0; a0 < 3; ++a0) {
        const int b = (a0 + 1) % 3, c = (a0 + 2) % 3;
        const L bent =
            mode[pairMode(c)][axis] * fill.centroid[b] + mode[pairMode(b)][axis] * fill.centroid[c];
        mode[1 << a0][axis] -=
            kTwo * fill.places[a0] * bent - Real(2) * kTwo * fill.pairs[a0] * twist;
      }
      if (kSign > 0) shiftPairs(fill, kTwo, axis);
    }
  }

  ROBOT_TISSUE_INLINE void shiftPairs(const Fill& fill, Real two, int axis) {
    for (int c = 0; c < 3; ++c) {
      mode[pairMode(c)][axis] -= two * fill.centroid[c] * mode[7][axis];
    }
  }

  // Gradients in the modes over the fill become those in the modes about the middle (the transpose
  // of shiftModes<1>).
  ROBOT_TISSUE_INLINE void shiftGradients(const Fill& fill) {
    for (int axis = 0; axis < 3; ++axis) {
      L twist = mode[7][axis];
      for (int c = 0; c < 3; ++c) {
        const int a0 = (c + 1) % 3, b = (c + 2) % 3;
        twist += Real(4) * fill.pairs[c] * mode[1 << c][axis] -
                 Real(2) * fill.centroid[c] * mode[pairMode(c)][axis];
        mode[pairMode(c)][axis] -=
            Real(2) * (fill.centroid[b] * fill.places[a0] * mode[1 << a0][axis] +
                       fill.centroid[a0] * fill.places[b] * mode[1 << b][axis]);
      }
      mode[7][axis] = twist;
    }
  }

  ROBOT_TISSUE_INLINE void measureFill(const Fill& fill) {
    slight = invariant = L{};
    for (int axis = 0; axis < 3; ++axis) {
      L strained{}, bent{};
      for (int a0 = 0; a0 < 3; ++a0) {
        strained += mode[1 << a0][axis] * mode[1 << a0][axis];
        bent += mode[pairMode(a0)][axis] * mode[pairMode(a0)][axis];
      }
      slight += strained + Real(6.0) * bent + Real(9.0) * mode[7][axis] * mode[7][axis];
    }
    shiftModes<1>(fill);
    for (int axis = 0; axis < 3; ++axis) {
      for (int a0 = 0; a0 < 3; ++a0) {
        const L &along = mode[1 << a0][axis], &pair = mode[pairMode(a0)][axis];
        invariant += along * along + Real(4) * fill.bending[a0] * pair * pair;
      }
      invariant += Real(16) * fill.twisting * mode[7][axis] * mode[7][axis];
    }
    this->measureMeans();
  }

  // Energy gradients in the modes, as `scale`.
  ROBOT_TISSUE_INLINE void scaleFill(const Fill& fill) {
    const L one = a * Real(0.25), push = Real(0.25) * pressure, pull = one - push;
    for (int axis = 0; axis < 3; ++axis) {
      mode[0][axis] = L{};
      for (int a0 = 0; a0 < 3; ++a0) {
        mode[1 << a0][axis] = one * mode[1 << a0][axis] + pull * cofactor[a0][axis];
        mode[pairMode(a0)][axis] *= a * fill.bending[a0];
      }
      mode[1 << axis][axis] -= push;
      mode[7][axis] *= Real(4) * a * fill.twisting;
    }
  }

  // As `solve`, of cells that are filled in part. `of_corners`: bounds of the stiffness of
  // each corner (SymmetricField); null: not asked for.
  template <bool kStiffens>
  ROBOT_TISSUE_INLINE void solveFill(const Fill& fill, L (*of_corners)[6]) {
    this->transform();
    for (int s = 1; s < kCorners; ++s) {
      for (L& component : mode[s]) component *= Real(0.25);
    }
    measureFill(fill);
    this->template stiffen<true>();
    if constexpr (kStiffens) this->template stiffenByStrain<true>();
    constexpr Real kSlight = Real(0.5 * 0.33 * 0.33);
    const bool squeezed = anyAbove0(slight > kSlight ? shear : L{});
    if (of_corners != nullptr) stiffenCorners(fill, of_corners);
    L push[kCorners][3];
    for (auto& corner : push) corner[0] = corner[1] = corner[2] = L{};
    L over_fill[kCorners][3];
    if (squeezed) {
      std::memcpy(over_fill, mode, sizeof mode);
      shiftModes<-1>(fill);
      CellBarrier<V, PartBox<V>>{mode, shear, this->per_greatest, fill.box}.add(push, of_corners);
      std::memcpy(mode, over_fill, sizeof mode);
    }
    if (has_parts) {
      for (auto& corner : over_fill) corner[0] = corner[1] = corner[2] = L{};
      this->addParts(fill.between_parts, over_fill);
    }
    scaleFill(fill);
    for (int s = 1; has_parts && s < kCorners; ++s) {
      for (int axis = 0; axis < 3; ++axis) mode[s][axis] += over_fill[s][axis];
    }
    shiftGradients(fill);
    for (int s = 1; squeezed && s < kCorners; ++s) {
      for (int axis = 0; axis < 3; ++axis) mode[s][axis] += push[s][axis];
    }
    this->transform();
  }

  // As `findStiffness`, where the shape functions' slopes are a quarter; and a part of it in all
  // directions.
  ROBOT_TISSUE_INLINE void stiffenCorners(const Fill& fill, L (*of_corners)[6]) const {
    for (int corner = 0; corner < kCorners; ++corner) {
      L shape = fill.twisting, widest{}, slopes[3];
      Real side[3];
      for (int axis = 0; axis < 3; ++axis) side[axis] = Real((corner >> axis & 1) != 0 ? 1 : -1);
      for (int a0 = 0; a0 < 3; ++a0) {
        const int b = (a0 + 1) % 3, c = (a0 + 2) % 3;
        const L beside = side[b] * fill.centroid[b] + side[c] * fill.centroid[c];
        const L strain =
            Real(0.5) * fill.places[a0] * beside + side[b] * side[c] * fill.pairs[a0] + Real(0.25);
        const L bend = side[a0] * fill.centroid[a0] + Real(0.5);
        slopes[a0] = side[a0] * strain;
        shape += strain * strain + fill.bending[a0] * bend * bend;
        widest = greater(widest, strain * strain);
      }
      this->findStiffness(a * shape + Real(16) * of_strain * widest, slopes, of_corners[corner]);
      L(&here)[6] = of_corners[corner];
      const L around = (here[0] + here[1] + here[2]) * Real(level_tuning::kAround);
      for (int axis = 0; axis < 3; ++axis) here[axis] += around;
    }
  }
};

}  // namespace robot_tissue::vectors
