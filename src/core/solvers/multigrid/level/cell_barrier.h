// What keeps corners of a block of cells from turning inside out (doc/model.md): its gradient, in
// the lanes of vectors.
#pragma once

#include "material/elastic_cell.h"
#include "material/elastic_law.h"
#include "simd/vector_clones.h"
#include "simd/vectors.h"
#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue::vectors {

// Where it rises: at the corners of the cell itself. Places are 1 at a cell's low end along an
// axis, -1 at its high end.
template <typename V>
struct WholeBox {
  using Real = typename V::Real;
  static constexpr bool kIsWhole = true;
  static constexpr Real side(int /*axis*/, int high) { return high != 0 ? Real(-1) : Real(1); }
};

// Of a cell that is filled in part: at those of a box in it (FillLaw::low, high).
template <typename V>
struct PartBox {
  using L = typename V::Lanes;
  static constexpr bool kIsWhole = false;
  L sides[2][3];  // low, high
  ROBOT_TISSUE_INLINE const L& side(int axis, int high) const { return sides[high][axis]; }
};

template <typename V, typename Box = WholeBox<V>>
struct CellBarrier {
  using Real = typename V::Real;
  using L = typename V::Lanes;

  const L (&mode)[kCorners][3];  // m_s (cell_block.h)
  const L& shear;                // 0 where there is no cell
  Real per_greatest;             // CellGrid::per_greatest
  Box box;

  // Minus the derivatives of the place along each axis, which of a whole cell are its edges: of a
  // corner at the high ends along the two axes that follow it in turn, b and c, the one with index
  // [high along b][high along c]. Along x it is m_x + y m_xy + z m_xz + y z m_xyz - e_x, with y and
  // z the corner's places.
  struct Edges {
    L along[3][2][2][3];
  };

  ROBOT_TISSUE_INLINE void findEdges(Edges& edges) const {
#pragma GCC unroll 3
    for (int a0 = 0; a0 < 3; ++a0) {
      const int along_b = (a0 + 1) % 3, along_c = (a0 + 2) % 3;
      const int b = 1 << along_b, c = 1 << along_c, own = 1 << a0;
#pragma GCC unroll 3
      for (int axis = 0; axis < 3; ++axis) {
        const L straight = mode[own][axis] - Real(axis == a0 ? 1.0 : 0.0);
#pragma GCC unroll 2
        for (int high = 0; high < 2; ++high) {
          const auto place = box.side(along_b, high);
          const L bent = straight + place * mode[own | b][axis];
          const L turn = mode[own | c][axis] + place * mode[7][axis];
          edges.along[a0][high][0][axis] = bent + box.side(along_c, 0) * turn;
          edges.along[a0][high][1][axis] = bent + box.side(along_c, 1) * turn;
        }
      }
    }
  }

  static ROBOT_TISSUE_INLINE void cross(const L (&b)[3], const L (&c)[3], L (&across)[3]) {
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
      const int v = (axis + 1) % 3, w = (axis + 2) % 3;
      across[axis] = b[w] * c[v] - b[v] * c[w];
    }
  }

  // Those that meet in a corner, as above.
  struct Corner {
    ROBOT_TISSUE_INLINE Corner(const Edges& edges, int corner)
        : x(edges.along[0][corner >> 1 & 1][corner >> 2 & 1]),
          y(edges.along[1][corner >> 2 & 1][corner & 1]),
          z(edges.along[2][corner & 1][corner >> 1 & 1]) {}

    const L (&x)[3];
    const L (&y)[3];
    const L (&z)[3];
  };

  static ROBOT_TISSUE_INLINE L determinantOf(const Corner& corner, L (&across_x)[3]) {
    cross(corner.y, corner.z, across_x);
    return corner.x[0] * across_x[0] + corner.x[1] * across_x[1] + corner.x[2] * across_x[2];
  }

  // Adds the barrier's gradient in the modes to `push` and, unless null, what it adds to the bound
  // of each corner's stiffness (SymmetricField); corner by corner where any cell is squeezed there,
  // as few are anywhere.
  ROBOT_TISSUE_INLINE void add(L (&push)[kCorners][3], L (*corner_stiffness)[6]) const {
    constexpr Real kSqueezed = Real(elastic_law::kSqueezed);
    Edges edges;
    findEdges(edges);
    L across[3][3];
    L least = all<V>(kSqueezed);
#pragma GCC unroll 8
    for (int corner = 0; corner < kCorners; ++corner) {
      least = lesser(determinantOf(Corner(edges, corner), across[0]), least);
    }
    if (!anyAbove0(least < kSqueezed ? shear : L{})) return;
    for (int index = 0; index < kCorners; ++index) {
      const Corner corner(edges, index);
      const L determinant = determinantOf(corner, across[0]);
      if (!anyAbove0(determinant < kSqueezed ? shear : L{})) continue;
      cross(corner.z, corner.x, across[1]);
      cross(corner.x, corner.y, across[2]);
      const L depth = greater((kSqueezed - determinant) * (Real(1) / kSqueezed), L{});
      pushCorner(index, depth, across, push);
      if (corner_stiffness != nullptr) {
        if constexpr (Box::kIsWhole) {
          stiffenCorner(index, corner, depth, across, corner_stiffness);
        } else {
          stiffenAll(index, corner, depth, across, corner_stiffness);
        }
      }
    }
  }

  // Of the barrier per corner, height depth^3.
  ROBOT_TISSUE_INLINE L height() const { return shear * Real(elastic_law::kBarrier / kCorners); }

  static ROBOT_TISSUE_INLINE L squared(const L (&x)[3]) {
    return x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
  }

  ROBOT_TISSUE_INLINE auto side(int corner, int axis) const {
    return box.side(axis, corner >> axis & 1);
  }

  ROBOT_TISSUE_INLINE void pushCorner(int corner, const L& depth, const L (&across)[3][3],
                                      L (&push)[kCorners][3]) const {
    const auto x = side(corner, 0), y = side(corner, 1), z = side(corner, 2);
    const L slope = height() * depth * depth * Real(-3.0 * 0.25 / elastic_law::kSqueezed);
    for (int axis = 0; axis < 3; ++axis) {
      const L along_x = slope * across[0][axis], along_y = slope * across[1][axis],
              along_z = slope * across[2][axis];
      push[1][axis] += along_x;
      push[2][axis] += along_y;
      push[4][axis] += along_z;
      push[3][axis] += y * along_x + x * along_y;
      push[5][axis] += z * along_x + x * along_z;
      push[6][axis] += z * along_y + y * along_z;
      push[7][axis] += y * z * along_x + x * z * along_y + x * y * along_z;
    }
  }

  // What the barrier's second derivative at a corner is made of, with what is squeezed on
  // meanwhile: E'' times so many as `terms`, |E'|, and the squares of the edges.
  struct Bend {
    ROBOT_TISSUE_INLINE Bend(const CellBarrier& of, const Corner& corner, const L& depth,
                             Real terms) {
      constexpr Real kPerDepth = Real(1.0 / elastic_law::kSqueezed);
      const Real share = Real(level_tuning::kSqueezedOn) * kPerDepth * of.per_greatest;
      curvature = of.height() * depth * (terms * Real(6) * kPerDepth * share);
      slope = of.height() * depth * depth * (Real(3) * share);
      edges[0] = squared(corner.x);
      edges[1] = squared(corner.y);
      edges[2] = squared(corner.z);
      all_edges = edges[0] + edges[1] + edges[2];
    }

    L curvature, slope, edges[3], all_edges;
  };

  // A corner's determinant J hangs on four nodes, itself and the other ends of its edges. With
  // c_i = dJ/dx_i a motion u of these has the barrier's second derivative
  //   E'' (sum c_i . u_i)^2 + E' sum of u_i . (d2J/dx_i dx_j) u_j,
  // at most 4 E'' c_i c_i^T + |E'| (the row's sum of the lengths of edges, 2 (|e_b| + |e_c|)) of
  // each node, with |e| <= (1 + |e|^2) / 2. The stiffness of a node is to bound that but for the
  // factor by which motions are stiffer than their nodes alone; and what is squeezed on meanwhile.
  ROBOT_TISSUE_INLINE void stiffenCorner(int index, const Corner& corner, const L& depth,
                                         const L (&across)[3][3], L (*corner_stiffness)[6]) const {
    const Bend bend(*this, corner, depth, Real(4));
    L own[3];
    for (int axis = 0; axis < 3; ++axis) {
      own[axis] = side(index, 0) * across[0][axis] + side(index, 1) * across[1][axis] +
                  side(index, 2) * across[2][axis];
    }
    addSquare(bend.curvature, own, bend.slope * (Real(3) + bend.all_edges),
              corner_stiffness[index]);
    for (int along = 0; along < 3; ++along) {
      addSquare(bend.curvature, across[along],
                bend.slope * (Real(2) + bend.all_edges - bend.edges[along]),
                corner_stiffness[index ^ 1 << along]);
    }
  }

  // Adds curvature c c^T + diagonal 1.
  static ROBOT_TISSUE_INLINE void addSquare(const L& curvature, const L (&c)[3], const L& diagonal,
                                            L (&stiffness)[6]) {
    for (int axis = 0; axis < 3; ++axis) {
      stiffness[axis] += curvature * c[axis] * c[axis] + diagonal;
      stiffness[3 + axis] += curvature * c[(axis + 1) % 3] * c[(axis + 2) % 3];
    }
  }

  // In a cell's inside the derivative along axis a hangs on all its nodes, on node i by w_ia, 2 in
  // sum over the nodes: with A_a the determinant's slope by that derivative, and e_a the latter,
  //   E'' 6 sum over a of w_ia A_a A_a^T + |E'| sum over a of w_ia (2 + |e_b|^2 + |e_c|^2)
  // bounds what the second derivative has of node i, by Cauchy and Schwarz.
  ROBOT_TISSUE_INLINE void stiffenAll(int index, const Corner& corner, const L& depth,
                                      const L (&across)[3][3], L (*corner_stiffness)[6]) const {
    const Bend bend(*this, corner, depth, Real(6));
    for (int along = 0; along < 3; ++along) {
      const int b = (along + 1) % 3, c = (along + 2) % 3;
      const L turns = bend.slope * (Real(2) + bend.all_edges - bend.edges[along]);
      for (int node = 0; node < kCorners; ++node) {
        const Real one = (node >> b & 1) != 0 ? Real(-0.5) : Real(0.5);
        const Real other = (node >> c & 1) != 0 ? Real(-0.5) : Real(0.5);
        const L weight = (Real(0.5) + one * side(index, b)) * (Real(0.5) + other * side(index, c));
        addSquare(weight * bend.curvature, across[along], weight * turns, corner_stiffness[node]);
      }
    }
  }
};

}  // namespace robot_tissue::vectors
