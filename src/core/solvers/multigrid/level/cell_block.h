// Energy gradients of a block of cells in the lanes of vectors: the arithmetic of cell_kernel.h.
#pragma once

#include "material/elastic_cell.h"
#include "material/elastic_law.h"
#include "simd/vector_clones.h"
#include "simd/vectors.h"
#include "solvers/multigrid/level/cell_barrier.h"

namespace robot_tissue::vectors {

// A block of cells. `mode` holds the displacements of the corners, then m_s = M_s / 4 of these,
// then the energy's gradients in the corners. Near rest F, I1 and J are stored less their values
// there, so that no digits cancel: F = 1 + H, H e_a = -m_a.
template <typename V>
struct Block {
  using Real = typename V::Real;
  using L = typename V::Lanes;

  L mode[kCorners][3];
  L shear, bulk;
  L exponent;              // of the law `fung`, where it is solved for
  L cofactor[3][3];        // of F, less 1, by axes
  L invariant, volume;     // I1 - 3, J - 1
  L slight;                // half a bound of |G - 1|^2 over the corners' edges G (see `solve`)
  L a, pressure;           // a(J); a(J) and the energy's derivative by J, 0 at rest
  L of_volume, of_strain;  // of the stiffness of a corner (see `stiffnessOf`)
  L corner_stiffness[kCorners][6];  // what the barrier adds to it where one is squeezed
  bool is_squeezed = false;
  Real per_greatest{};  // CellGrid::per_greatest
  // In a time step with damping, else not set (material/viscosity.h).
  bool has_viscosity = false;
  L viscous_shear, viscous_lame;  // mu and lambda of the strain that the step adds
  L rest_slopes[3][3];            // of F where the rate is taken from
  // Of a coarse cell that has relief (cell_relief.h): it is added to m_1, m_2, m_4. Else not set.
  bool has_relief = false;
  L relief[3][3];
  L parts{};  // bulk where the volumes of a cell's parts are held
  bool has_parts = false;
  // From corners to modes, M_s = sum over k of (-1)^(bits in k and s) x_k, by sums and differences
  // along one axis after another (Walsh-Hadamard). Twice gives eight times what was: it also goes
  // back.
  ROBOT_TISSUE_INLINE void transform() {
#pragma GCC unroll 3
    for (int bit = 1; bit < kCorners; bit <<= 1) {
#pragma GCC unroll 8
      for (int k = 0; k < kCorners; ++k) {
        if ((k & bit) != 0) continue;
#pragma GCC unroll 3
        for (int axis = 0; axis < 3; ++axis) {
          const L low = mode[k][axis], high = mode[k | bit][axis];
          mode[k][axis] = low + high;
          mode[k | bit][axis] = low - high;
        }
      }
    }
  }

  ROBOT_TISSUE_INLINE void measure() {
    slight = invariant = L{};
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
#pragma GCC unroll 7
      for (int s = 1; s < kCorners; ++s) mode[s][axis] *= Real(0.25);
      if (has_relief) addRelief(axis);
      const L bent = mode[3][axis] * mode[3][axis] + mode[5][axis] * mode[5][axis] +
                     mode[6][axis] * mode[6][axis];
      const L twisted = mode[7][axis] * mode[7][axis];
      const L strained = mode[1][axis] * mode[1][axis] + mode[2][axis] * mode[2][axis] +
                         mode[4][axis] * mode[4][axis];
      slight += strained + Real(6.0) * bent + Real(9.0) * twisted;
      invariant += strained + (bent + bent + twisted) * Real(1.0 / 3.0);
    }
    measureMeans();
  }

  ROBOT_TISSUE_INLINE void addRelief(int axis) {
#pragma GCC unroll 3
    for (int a0 = 0; a0 < 3; ++a0) mode[1 << a0][axis] += relief[a0][axis];
  }

  // Of the mean deformation gradient.
  ROBOT_TISSUE_INLINE void measureMeans() {
    invariant -= Real(2.0) * (mode[1][0] + mode[2][1] + mode[4][2]);
#pragma GCC unroll 3
    for (int a0 = 0; a0 < 3; ++a0) {
      const int b = (a0 + 1) % 3, c = (a0 + 2) % 3;
      const L(&mb)[3] = mode[1 << b];
      const L(&mc)[3] = mode[1 << c];
      cofactor[a0][a0] = mb[b] * mc[c] - mb[c] * mc[b] - mb[b] - mc[c];
      cofactor[a0][b] = mb[c] * mc[a0] - mb[a0] * mc[c] + mb[a0];
      cofactor[a0][c] = mb[a0] * mc[b] - mb[b] * mc[a0] + mc[a0];
    }
    volume = cofactor[0][0] - mode[1][0] - mode[1][0] * cofactor[0][0] -
             mode[1][1] * cofactor[0][1] - mode[1][2] * cofactor[0][2];
  }

  // a(J) = mu J^(-2/3); below J = kFlattest its Taylor polynomial of second order there, so that it
  // stays finite (elastic_law.h).
  template <bool kWithStiffness>
  ROBOT_TISSUE_INLINE void stiffen() {
    const L all_of_it = volume + Real(1.0);
    const L from = greater(all_of_it, all<V>(Real(elastic_law::kFlattest)));
    const L beyond = all_of_it - from;
    const L root = inverseCubeRoot<V>(from);
    const L inverse = root * root * root;
    const L value = shear * root * root;
    const L slope = Real(-2.0 / 3.0) * value * inverse;
    const L curvature = Real(-5.0 / 3.0) * slope * inverse;
    a = value + beyond * (slope + Real(0.5) * beyond * curvature);
    const L near_rest = value * inverse * (volume - invariant * Real(1.0 / 3.0));
    const L flat = a + Real(0.5) * (slope + beyond * curvature) * (invariant + Real(3.0));
    pressure = (beyond < Real(0.0) ? flat : near_rest) + bulk * volume;
    if constexpr (kWithStiffness) {
      of_volume = Real(0.5) * curvature * (invariant + Real(3.0)) + bulk;
      of_strain = L{};
    }
  }

  // From the neo-Hookean law, which `stiffen` leaves, to `fung` (elastic_law.h): a and the shape's
  // part of the pressure and of the stiffness take the factor g'. What g'' adds to the cell's
  // second derivative is mu/2 g'' n n^T, n the slope of x in its corners; half its only eigenvalue
  // mu/2 g'' |n|^2 is added to the stiffness of each corner.
  template <bool kWithStiffness>
  ROBOT_TISSUE_INLINE void stiffenByStrain() {
    const L j = volume + Real(1.0);
    const L from = greater(j, all<V>(Real(elastic_law::kFlattest)));
    const L beyond = j - from;
    const L root = inverseCubeRoot<V>(from);
    const L inverse = root * root * root;
    const L lean_w = root * root, lean_slope = Real(-2.0 / 3.0) * lean_w * inverse;
    const L curvature = Real(-5.0 / 3.0) * lean_slope * inverse;
    const L w = lean_w + beyond * (lean_slope + Real(0.5) * beyond * curvature);
    // x = w I1 - 3, of differences from rest: w (I1 - 3) - 3 w (J^(2/3) - 1).
    const L r = from * root;
    const L near_rest =
        lean_w * (invariant - Real(3.0) * volume * (Real(2.0) + volume) / (r * r + r + Real(1.0)));
    const L x = beyond < Real(0.0) ? w * (invariant + Real(3.0)) - Real(3.0) : near_rest;
    const L whole = exponent * greater(x, L{});
    const L most = all<V>(Real(elastic_law::kMostExponent));
    const L within = whole < most ? whole : most;
    const L growth = exponential<V>(within);
    const L slope = growth * (Real(1.0) + (whole - within));
    const L press = bulk * volume;
    if constexpr (kWithStiffness) {
      const L curved = x > Real(0.0) ? exponent * growth : L{};
      of_volume = slope * (of_volume - bulk) + bulk;
      of_strain =
          shear * curved * Real(1.0 / 8.0) * slopeSquared(w, lean_slope + beyond * curvature);
    }
    a *= slope;
    pressure = slope * (pressure - press) + press;
  }

  // Of x in the modes: twice |n|^2, as dx/dx_k is a quarter of the sum of +- dx/dm_s.
  ROBOT_TISSUE_INLINE L slopeSquared(const L& w, const L& w_slope) const {
    const L by_volume = w_slope * (invariant + Real(3.0)), twice = Real(2.0) * w;
    L sum = L{};
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
#pragma GCC unroll 3
      for (int along = 0; along < 3; ++along) {
        const Real rest = Real(along == axis ? 1.0 : 0.0);
        const L slope =
            twice * (rest - mode[1 << along][axis]) + by_volume * (cofactor[along][axis] + rest);
        sum += slope * slope;
      }
      const L bent = mode[3][axis] * mode[3][axis] + mode[5][axis] * mode[5][axis] +
                     mode[6][axis] * mode[6][axis];
      sum += twice * twice *
             (bent * Real(4.0 / 9.0) + mode[7][axis] * mode[7][axis] * Real(1.0 / 9.0));
    }
    return sum;
  }

  ROBOT_TISSUE_INLINE L square(int along) const {
    const L whole = cofactor[along][along] + Real(1.0);
    const int b = (along + 1) % 3, c = (along + 2) % 3;
    return whole * whole + cofactor[along][b] * cofactor[along][b] +
           cofactor[along][c] * cofactor[along][c];
  }

  // Shares of the moduli there are, as of CellGrid.
  ROBOT_TISSUE_INLINE void divideModuli(Real elastic, Real viscous) {
    has_viscosity = true;
    viscous_shear = viscous * shear;
    viscous_lame = viscous * (bulk - Real(2.0 / 3.0) * shear);
    shear *= elastic;
    bulk *= elastic;
  }

  // With the strain D, the symmetric part of H F_0^-1, H e_a = -m_a: the stress S = 2 mu D +
  // lambda tr D; a quarter of the gradients in the m_a, -S F_0^-T e_a.
  ROBOT_TISSUE_INLINE void findViscous(L (&push)[3][3]) const {
    L rate[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        rate[i][j] = mode[1][i] * rest_slopes[0][j] + mode[2][i] * rest_slopes[1][j] +
                     mode[4][i] * rest_slopes[2][j];
      }
    }
    const L even = viscous_lame * (rate[0][0] + rate[1][1] + rate[2][2]);
    L stress[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) stress[i][j] = viscous_shear * (rate[i][j] + rate[j][i]);
      stress[i][i] += even;
    }
    for (int a0 = 0; a0 < 3; ++a0) {
      for (int i = 0; i < 3; ++i) {
        push[a0][i] =
            Real(0.25) * (stress[i][0] * rest_slopes[a0][0] + stress[i][1] * rest_slopes[a0][1] +
                          stress[i][2] * rest_slopes[a0][2]);
      }
    }
  }

  ROBOT_TISSUE_INLINE void addViscous(const L (&push)[3][3]) {
    for (int a0 = 0; a0 < 3; ++a0) {
      for (int axis = 0; axis < 3; ++axis) mode[1 << a0][axis] += push[a0][axis];
    }
  }

  // a of the modes that bend and twist, whose rate is damped as they are.
  ROBOT_TISSUE_INLINE L bent() const { return has_viscosity ? a + viscous_shear : a; }

  ROBOT_TISSUE_INLINE void scale() {
    const L rough = bent();
    const L one = a * Real(0.25), two = rough * Real(0.5 / 3.0), three = rough * Real(0.25 / 3.0);
    const L push = Real(0.25) * pressure, pull = one - push;
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
      mode[0][axis] = L{};
      mode[1][axis] = one * mode[1][axis] + pull * cofactor[0][axis];
      mode[2][axis] = one * mode[2][axis] + pull * cofactor[1][axis];
      mode[4][axis] = one * mode[4][axis] + pull * cofactor[2][axis];
      mode[1 << axis][axis] -= push;
      mode[3][axis] *= two;
      mode[5][axis] *= two;
      mode[6][axis] *= two;
      mode[7][axis] *= three;
    }
  }

  // Coarse cells: K/2 sum over the eight parts p of (J_p - J)^2 / 8, where J_p is the volume ratio
  // of part p, to first order in the modes of two and three axes (doc/model.md, "Volume on coarse
  // lattices").
  ROBOT_TISSUE_INLINE void addParts(L (&push)[kCorners][3]) {
    const L sixteenth = all<V>(Real(1.0 / 16.0));
    const L even[3] = {sixteenth, sixteenth, sixteenth};
    addParts(even, push);
  }

  // With the variance of the parts' centroids along each axis, 1/16 of eight equal ones.
  ROBOT_TISSUE_INLINE void addParts(const L (&spread)[3], L (&push)[kCorners][3]) {
    const auto product = [](const L(&x)[3], const L(&y)[3]) __attribute__((always_inline)) {
      return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    };
    L whole[3][3];
    for (int along = 0; along < 3; ++along) {
      for (int axis = 0; axis < 3; ++axis) {
        whole[along][axis] = cofactor[along][axis] + Real(along == axis ? 1.0 : 0.0);
      }
    }
    const L firmer = Real(4) * parts;
    const L x = parts * spread[0] * (product(whole[1], mode[3]) + product(whole[2], mode[5]));
    const L y = parts * spread[1] * (product(whole[0], mode[3]) + product(whole[2], mode[6]));
    const L z = parts * spread[2] * (product(whole[0], mode[5]) + product(whole[1], mode[6]));
    const L xy = firmer * spread[0] * spread[1] * product(whole[2], mode[7]);
    const L xz = firmer * spread[0] * spread[2] * product(whole[1], mode[7]);
    const L yz = firmer * spread[1] * spread[2] * product(whole[0], mode[7]);
    for (int axis = 0; axis < 3; ++axis) {
      push[3][axis] += x * whole[1][axis] + y * whole[0][axis];
      push[5][axis] += x * whole[2][axis] + z * whole[0][axis];
      push[6][axis] += y * whole[2][axis] + z * whole[1][axis];
      push[7][axis] += yz * whole[0][axis] + xz * whole[1][axis] + xy * whole[2][axis];
    }
  }

  // Where `slight` does not tell: whether a corner may be squeezed, without its determinant. With
  // the mean deformation gradient F, J = det F and a corner's edges G = F + B,
  //   det G = J + cof F : B + F : cof B + det B >= J - |cof F| |B| - |F| |B|^2 / 3^(1/2)
  //                                                 - |B|^3 / 27^(1/2),
  // |F| / 3^(1/2) <= (|F|^2 / 3 + 1) / 2, |F|^2 <= I1, |B| <= |B|^2 + 1/4.
  ROBOT_TISSUE_INLINE bool maySqueeze() const {
    constexpr Real kSqueezed = Real(1.01 * elastic_law::kSqueezed);  // by rounding
    L bent_square = L{};                                             // of |B|, at most
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
      const L bent = mode[3][axis] * mode[3][axis] + mode[5][axis] * mode[5][axis] +
                     mode[6][axis] * mode[6][axis];
      bent_square += Real(6.0) * bent + Real(9.0) * mode[7][axis] * mode[7][axis];
    }
    const L by_products =
        (invariant + Real(6.0)) * Real(1.0 / 6.0) + (bent_square + Real(0.25)) * Real(0.19245009);
    const L left = volume + (Real(1.0) - kSqueezed) - bent_square * by_products;
    const L most = bent_square * (square(0) + square(1) + square(2));
    const L squared = left > Real(0.0) ? left * left : L{};
    return anyAbove0(squared > most ? L{} : shear);
  }

  // A corner's stiffness is at most, but for one indefinite term,
  //   (a / 3 + of_strain) 1 + of_volume s s^T,   s = J's slope there, the sum of the +- c_a / 4,
  // c_a = cof F e_a; opposite corners have opposite ones.
  ROBOT_TISSUE_INLINE void findStiffness(L (&stiffness)[kCorners / 2][6]) const {
    const L share = all<V>(Real(0.25));
    for (int corner = 0; corner < kCorners / 2; ++corner) {
      const L shares[3] = {share * WholeBox<V>::side(0, corner & 1),
                           share * WholeBox<V>::side(1, corner >> 1 & 1),
                           share * WholeBox<V>::side(2, corner >> 2 & 1)};
      L diagonal = a * Real(1.0 / 3.0) + of_strain;
      if (has_viscosity) diagonal += viscous_shear * Real(1.0 / 3.0 - 3.0 / 16.0);
      findStiffness(diagonal, shares, stiffness[corner]);
    }
  }

  // diagonal 1 + of_volume s s^T, s the sum of these shares of the c_a.
  ROBOT_TISSUE_INLINE void findStiffness(const L& diagonal, const L (&shares)[3],
                                         L (&stiffness)[6]) const {
    L s[3];
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
      s[axis] = shares[axis];
#pragma GCC unroll 3
      for (int along = 0; along < 3; ++along) s[axis] += shares[along] * cofactor[along][axis];
    }
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      stiffness[axis] = diagonal + of_volume * s[axis] * s[axis];
      stiffness[3 + axis] = of_volume * s[b] * s[c];
    }
    if (has_viscosity) stiffenViscous(shares, stiffness);
  }

  // The bound of `findStiffness` at rest, in the shape where the rate is taken from: with g the sum
  // of the shares of the rows of F_0^-1, mu |g|^2 1 + (lambda + 7/3 mu) g g^T.
  ROBOT_TISSUE_INLINE void stiffenViscous(const L (&shares)[3], L (&stiffness)[6]) const {
    L g[3];
    for (int axis = 0; axis < 3; ++axis) {
      g[axis] = shares[0] * rest_slopes[0][axis] + shares[1] * rest_slopes[1][axis] +
                shares[2] * rest_slopes[2][axis];
    }
    const L around = viscous_shear * (g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    const L along = viscous_lame + Real(7.0 / 3.0) * viscous_shear;
    for (int axis = 0; axis < 3; ++axis) {
      stiffness[axis] += around + along * g[axis] * g[axis];
      stiffness[3 + axis] += along * g[(axis + 1) % 3] * g[(axis + 2) % 3];
    }
  }

  // From the corners' displacements to the energy's gradients in them.
  template <bool kWithStiffness, bool kStiffens>
  ROBOT_TISSUE_INLINE void solve() {
    transform();
    measure();
    stiffen<kWithStiffness>();
    if constexpr (kStiffens) stiffenByStrain<kWithStiffness>();
    // |G - 1|^2 of a corner's edges G below which det G > kSqueezed, as then no singular value is
    // below kSqueezed^(1/3); half of it, as |G - 1|^2 is at most twice the sum of the squares of
    // its two parts.
    constexpr Real kSlight = Real(0.5 * 0.33 * 0.33);
    is_squeezed = anyAbove0(slight > kSlight ? shear : L{}) && maySqueeze();
    L push[kCorners][3];
    const bool more = is_squeezed || has_parts;
    if (more) {
      for (auto& corner : push) corner[0] = corner[1] = corner[2] = L{};
      if (is_squeezed) {
        if constexpr (kWithStiffness) {
          for (auto& corner : corner_stiffness) {
            for (L& number : corner) number = L{};
          }
        }
        CellBarrier<V>{mode, shear, per_greatest, {}}.add(
            push, kWithStiffness ? corner_stiffness : nullptr);
      }
      if (has_parts) addParts(push);
    }
    L viscous[3][3];
    if (has_viscosity) findViscous(viscous);
    scale();
    if (has_viscosity) addViscous(viscous);
    if (more) {
      for (int s = 1; s < kCorners; ++s) {
        for (int axis = 0; axis < 3; ++axis) mode[s][axis] += push[s][axis];
      }
    }
    transform();
  }
};

}  // namespace robot_tissue::vectors
