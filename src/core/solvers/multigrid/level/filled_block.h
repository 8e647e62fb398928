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
    L centroid[3], pairs[3], between_parts[3];
    L bending[kSecond * (kSecond + 1) / 2];  // FillLaw::bending, the lower triangle by rows
    L twisting;
    // Per side of CellReach, 0 of none: what it adds to where F is taken, to q_aa, to d_a.
    L in_strain[kSides], in_mean[kSides], in_uneven[kSides];
    PartBox<V> box;
  };

  // Per side: of the nodes beyond it their displacements less those of the corners before them;
  // then, as `mode`, the energy's gradients in them.
  L beyond[kSides][kFaceNodes][3];
  L shifts[3][3];       // of dx/dx_a from the middle to the centroid, over c_a
  L squares[3][3];      // q_aa
  L uneven[3][3];       // d_a; then, as `bends`, half the derivative of I1 by it
  L bends[kSecond][3];  // half the derivative of I1 by q_ab, in the order of SecondSlopes

  using Block<V>::mode;
  using Block<V>::a;
  using Block<V>::cofactor;
  using Block<V>::has_parts;
  using Block<V>::has_relief;
  using Block<V>::has_viscosity;
  using Block<V>::invariant;
  using Block<V>::pressure;
  using Block<V>::relief;
  using Block<V>::shear;
  using Block<V>::slight;
  using Block<V>::of_strain;

  static constexpr int pairMode(int left_out) { return 7 ^ 1 << left_out; }

  // From modes about the cell's middle to those whose means are over the fill:
  //   m_a - 2 (m_ab c_b + m_ac c_c) + 4 m_abc p_bc,   m_ab - 2 m_abc c_c,   m_abc
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
        mode[1 << a0][axis] -= kTwo * bent - Real(2) * kTwo * fill.pairs[a0] * twist;
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
        mode[pairMode(c)][axis] -= Real(2) * (fill.centroid[b] * mode[1 << a0][axis] +
                                              fill.centroid[a0] * mode[1 << b][axis]);
      }
      mode[7][axis] = twist;
    }
  }

  // Mean over the fill of the shape functions of a face's corners, that face across the axis.
  ROBOT_TISSUE_INLINE static void findShares(const Fill& fill, int a0, L (&share)[kFaceNodes]) {
    const int b = (a0 + 1) % 3, c = (a0 + 2) % 3;
    for (int r = 0; r < kFaceNodes; ++r) {
      const Real s_b = Real((r & 1) != 0 ? 1 : -1), s_c = Real((r & 2) != 0 ? 1 : -1);
      share[r] = Real(0.5) * (s_b * fill.centroid[b] + s_c * fill.centroid[c]) +
                 s_b * s_c * fill.pairs[a0] + Real(0.25);
    }
  }

  static constexpr int way(int side) { return side % 2 == 0 ? -1 : 1; }

  // From m_a over the fill to where its centroid is along a, F e_a + c_a q_aa, with a neighbor's
  //   q_aa = sum of the differences beyond the face times their shares, + way m_a
  ROBOT_TISSUE_INLINE void reachOut(const Fill& fill) {
    for (int a0 = 0; a0 < 3; ++a0) {
      L share[kFaceNodes];
      findShares(fill, a0, share);
      for (int axis = 0; axis < 3; ++axis) {
        L mean{}, half{}, shift{};
        for (const int side : {2 * a0, 2 * a0 + 1}) {
          L q = Real(way(side)) * mode[1 << a0][axis];
          for (int r = 0; r < kFaceNodes; ++r) q += share[r] * beyond[side][r][axis];
          mean += fill.in_mean[side] * q;
          half += fill.in_uneven[side] * q;
          shift += fill.in_strain[side] * q;
        }
        squares[a0][axis] = mean;
        uneven[a0][axis] = half;
        shifts[a0][axis] = shift;
        mode[1 << a0][axis] -= fill.centroid[a0] * shift;
      }
    }
  }

  ROBOT_TISSUE_INLINE void reachBack(const Fill& fill) {
    for (int a0 = 0; a0 < 3; ++a0) {
      for (int axis = 0; axis < 3; ++axis) {
        mode[1 << a0][axis] += fill.centroid[a0] * shifts[a0][axis];
      }
    }
  }

  // The transpose of reachOut, for a quarter of the gradients in m_a; those in the nodes beyond.
  ROBOT_TISSUE_INLINE void spreadGradients(const Fill& fill) {
    const L rough = this->bent();
    for (int a0 = 0; a0 < 3; ++a0) {
      L share[kFaceNodes];
      findShares(fill, a0, share);
      for (int axis = 0; axis < 3; ++axis) {
        const L in_mean = Real(0.25) * rough * bends[a0][axis];
        const L in_uneven = Real(0.25) * rough * uneven[a0][axis];
        const L in_shift = fill.centroid[a0] * mode[1 << a0][axis];
        for (const int side : {2 * a0, 2 * a0 + 1}) {
          const L push = fill.in_mean[side] * in_mean + fill.in_uneven[side] * in_uneven -
                         fill.in_strain[side] * in_shift;
          mode[1 << a0][axis] += Real(way(side)) * push;
          for (int r = 0; r < kFaceNodes; ++r) {
            beyond[side][r][axis] = Real(4) * share[r] * push;
          }
        }
      }
    }
  }

  // Of FillLaw::bending in the lower triangle.
  static constexpr int place(int row, int column) {
    return row < column ? place(column, row) : row * (row + 1) / 2 + column;
  }

  ROBOT_TISSUE_INLINE static L weighed(const Fill& fill, const L (&second)[kSecond], int row) {
    L sum = fill.bending[place(row, 0)] * second[0];
    for (int column = 1; column < kSecond; ++column) {
      sum += fill.bending[place(row, column)] * second[column];
    }
    return sum;
  }

  // Of one component of the places: finds `bends` and what `uneven` becomes, returns its part of
  // I1.
  ROBOT_TISSUE_INLINE L bend(const Fill& fill, int axis) {
    L q[kSecond], sum{};
    for (int a0 = 0; a0 < 3; ++a0) {
      q[a0] = squares[a0][axis];
      q[3 + a0] = Real(2) * mode[pairMode(a0)][axis];
    }
    for (int row = 0; row < kSecond; ++row) {
      bends[row][axis] = weighed(fill, q, row);
      sum += bends[row][axis] * q[row];
    }
    for (int a0 = 0; a0 < 3; ++a0) {
      const L half = uneven[a0][axis];
      uneven[a0][axis] = fill.bending[place(a0, a0)] * half;
      sum += uneven[a0][axis] * half;
    }
    return sum;
  }

  ROBOT_TISSUE_INLINE void measureFill(const Fill& fill) {
    slight = invariant = L{};
    for (int axis = 0; axis < 3; ++axis) {
      L strained{}, bent{};
      for (int a0 = 0; a0 < 3; ++a0) {
        const L along = has_relief ? mode[1 << a0][axis] + relief[a0][axis] : mode[1 << a0][axis];
        strained += along * along;
        bent += mode[pairMode(a0)][axis] * mode[pairMode(a0)][axis];
      }
      slight += strained + Real(6.0) * bent + Real(9.0) * mode[7][axis] * mode[7][axis];
    }
    shiftModes<1>(fill);
    reachOut(fill);
    for (int axis = 0; axis < 3; ++axis) {
      if (has_relief) this->addRelief(axis);
      for (int a0 = 0; a0 < 3; ++a0) {
        invariant += mode[1 << a0][axis] * mode[1 << a0][axis];
      }
      invariant += bend(fill, axis);
      invariant += Real(16) * fill.twisting * mode[7][axis] * mode[7][axis];
    }
    this->measureMeans();
  }

  // Energy gradients in the modes, as `scale`.
  ROBOT_TISSUE_INLINE void scaleFill(const Fill& fill) {
    const L one = a * Real(0.25), push = Real(0.25) * pressure, pull = one - push;
    const L rough = this->bent();
    for (int axis = 0; axis < 3; ++axis) {
      mode[0][axis] = L{};
      for (int a0 = 0; a0 < 3; ++a0) {
        mode[1 << a0][axis] = one * mode[1 << a0][axis] + pull * cofactor[a0][axis];
        mode[pairMode(a0)][axis] = Real(0.5) * rough * bends[3 + a0][axis];
      }
      mode[1 << axis][axis] -= push;
      mode[7][axis] *= Real(4) * rough * fill.twisting;
    }
  }

  // As `solve`, of cells that are filled in part. `of_nodes`: bounds of the stiffness of each
  // corner and node reached (SymmetricField); null: not asked for.
  template <bool kStiffens>
  ROBOT_TISSUE_INLINE void solveFill(const Fill& fill, L (*of_nodes)[6]) {
    this->transform();
    for (int s = 1; s < kCorners; ++s) {
      for (L& component : mode[s]) component *= Real(0.25);
    }
    measureFill(fill);
    this->template stiffen<true>();
    if constexpr (kStiffens) this->template stiffenByStrain<true>();
    constexpr Real kSlight = Real(0.5 * 0.33 * 0.33);
    const bool squeezed = anyAbove0(slight > kSlight ? shear : L{});
    if (of_nodes != nullptr) {
      stiffenCorners(fill, of_nodes);
      stiffenReached(fill, of_nodes);
    }
    L push[kCorners][3];
    for (auto& corner : push) corner[0] = corner[1] = corner[2] = L{};
    L over_fill[kCorners][3];
    if (squeezed) {
      std::memcpy(over_fill, mode, sizeof mode);
      reachBack(fill);
      shiftModes<-1>(fill);
      CellBarrier<V, PartBox<V>>{mode, shear, this->per_greatest, fill.box}.add(push, of_nodes);
      std::memcpy(mode, over_fill, sizeof mode);
    }
    if (has_parts) {
      for (auto& corner : over_fill) corner[0] = corner[1] = corner[2] = L{};
      this->addParts(fill.between_parts, over_fill);
    }
    L viscous[3][3];
    if (has_viscosity) this->findViscous(viscous);
    scaleFill(fill);
    if (has_viscosity) this->addViscous(viscous);
    for (int s = 1; has_parts && s < kCorners; ++s) {
      for (int axis = 0; axis < 3; ++axis) mode[s][axis] += over_fill[s][axis];
    }
    spreadGradients(fill);
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
      L shape = fill.twisting, widest{}, slopes[3], second[kSecond];
      Real side[3];
      for (int axis = 0; axis < 3; ++axis) side[axis] = Real((corner >> axis & 1) != 0 ? 1 : -1);
      for (int a0 = 0; a0 < 3; ++a0) {
        const int b = (a0 + 1) % 3, c = (a0 + 2) % 3;
        const L beside = side[b] * fill.centroid[b] + side[c] * fill.centroid[c];
        const L share = Real(0.5) * beside + side[b] * side[c] * fill.pairs[a0] + Real(0.25);
        second[3 + a0] = side[b] * side[c] * (side[a0] * fill.centroid[a0] + Real(0.5));
        L strained{}, bent{}, half{};
        for (const int end : {2 * a0, 2 * a0 + 1}) {
          // 1 on the far side of the cell, -2 on the neighbor's.
          const L square = share * (Real(-0.5) - Real(1.5) * side[a0] * Real(way(end)));
          strained += fill.in_strain[end] * square;
          bent += fill.in_mean[end] * square;
          half += fill.in_uneven[end] * square;
        }
        slopes[a0] = side[a0] * share + fill.centroid[a0] * strained;
        second[a0] = bent;
        shape += slopes[a0] * slopes[a0] + fill.bending[place(a0, a0)] * half * half;
        widest = greater(widest, slopes[a0] * slopes[a0]);
      }
      for (int row = 0; row < kSecond; ++row) shape += weighed(fill, second, row) * second[row];
      stiffenNode(shape, widest, slopes, of_corners[corner]);
    }
  }

  ROBOT_TISSUE_INLINE void stiffenReached(const Fill& fill, L (*of_nodes)[6]) const {
    for (int side = 0; side < kSides; ++side) {
      const int a0 = side / 2;
      L share[kFaceNodes];
      findShares(fill, a0, share);
      const L bent = fill.bending[place(a0, a0)] * (fill.in_mean[side] * fill.in_mean[side] +
                                                    fill.in_uneven[side] * fill.in_uneven[side]);
      for (int r = 0; r < kFaceNodes; ++r) {
        L slopes[3] = {L{}, L{}, L{}};
        slopes[a0] = fill.centroid[a0] * fill.in_strain[side] * share[r];
        const L widest = slopes[a0] * slopes[a0];
        stiffenNode(widest + bent * share[r] * share[r], widest, slopes,
                    of_nodes[kCorners + kFaceNodes * side + r]);
      }
    }
  }

  ROBOT_TISSUE_INLINE void stiffenNode(const L& shape, const L& widest, const L (&slopes)[3],
                                       L (&here)[6]) const {
    L diagonal = a * shape + Real(16) * of_strain * widest;
    if (has_viscosity) {
      const L strained = slopes[0] * slopes[0] + slopes[1] * slopes[1] + slopes[2] * slopes[2];
      diagonal += this->viscous_shear * (shape - strained);
    }
    this->findStiffness(diagonal, slopes, here);
    const L around = (here[0] + here[1] + here[2]) * Real(level_tuning::kAround);
    for (int axis = 0; axis < 3; ++axis) here[axis] += around;
  }
};

}  // namespace robot_tissue::vectors
