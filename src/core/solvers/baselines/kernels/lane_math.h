// What the kernels of lane_kernels.h share: one cell of model `elastic` in one lane. Written so
// that loops over lanes become vector instructions.
#pragma once

#include <cstdint>
#include <cstring>

#include "material/elastic_law.h"
#include "simd/vector_clones.h"
#include "solvers/baselines/kernels/colored_layout.h"

namespace robot_tissue {

constexpr float kFlattest = static_cast<float>(elastic_law::kFlattest);
constexpr float kThird = 1.0F / 3.0F;
constexpr float kSqueezed = static_cast<float>(elastic_law::kSqueezed);
constexpr float kBarrier = static_cast<float>(elastic_law::kBarrier / kCorners);
using Lane = float[kLanes];

// Sums and differences of a cell's corners, but for the sum of all.
struct Modes {
  float x, y, z, xy, xz, yz, xyz;
};

ROBOT_TISSUE_INLINE Modes modesOf(float c0, float c1, float c2, float c3, float c4, float c5,
                                  float c6, float c7) {
  const float s01 = c0 + c1, d01 = c0 - c1, s23 = c2 + c3, d23 = c2 - c3;
  const float s45 = c4 + c5, d45 = c4 - c5, s67 = c6 + c7, d67 = c6 - c7;
  const float ss0 = s01 + s23, sd0 = s01 - s23, ds0 = d01 + d23, dd0 = d01 - d23;
  const float ss1 = s45 + s67, sd1 = s45 - s67, ds1 = d45 + d67, dd1 = d45 - d67;
  return {ds0 + ds1, sd0 + sd1, ss0 - ss1, dd0 + dd1, ds0 - ds1, sd0 - sd1, dd0 - dd1};
}

ROBOT_TISSUE_INLINE Modes cellModes(const float* x, const int* k, int i) {
  return modesOf(x[i], x[k[1] + i], x[k[2] + i], x[k[3] + i], x[k[4] + i], x[k[5] + i], x[k[6] + i],
                 x[k[7] + i]);
}

// 1 / 3 and 1 / 9 of what bends and twists, beside the squares of what strains.
ROBOT_TISSUE_INLINE float bendingOf(const Modes& m) {
  return (2.0F * (m.xy * m.xy + m.xz * m.xz + m.yz * m.yz) + m.xyz * m.xyz) * kThird;
}

// x^(-1/3), x > 0: a guess within 4 % from the exponent, then Newton's method.
ROBOT_TISSUE_INLINE float inverseCubeRoot(float x) {
  std::int32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits = static_cast<std::int32_t>(1.41996e9F - kThird * static_cast<float>(bits));
  float root;
  std::memcpy(&root, &bits, sizeof root);
  const float third = kThird * x;
  root *= 4.0F / 3.0F - third * root * root * root;
  root *= 4.0F / 3.0F - third * root * root * root;
  root *= 4.0F / 3.0F - third * root * root * root;
  return root;
}

// a(J), a' and a'' / a', with the Taylor form below kFlattest.
struct Stiffening {
  float a, slope, curvature;
};

ROBOT_TISSUE_INLINE Stiffening stiffeningOf(float shear, float volume) {
  const float from = volume > kFlattest ? volume : kFlattest;
  const float root = inverseCubeRoot(from);
  const float inverse = root * root * root;
  const float a = shear * root * root;
  const float slope = -2.0F / 3.0F * a * inverse;
  const float curvature = -5.0F / 3.0F * slope * inverse;
  const float beyond = volume - from;
  return {a + beyond * (slope + 0.5F * beyond * curvature), slope + beyond * curvature, curvature};
}

// exp(x) - 1, 0 <= x <= 80: with n the whole number next to x / ln 2 and r = x - n ln 2, from
// Taylor's polynomial in r. Adding 1.5 * 2^23 rounds to n and leaves it in the lowest bits.
ROBOT_TISSUE_INLINE float growthOf(float x) {
  constexpr float kRounder = 12582912.0F;
  const float rounded = x * 1.442695041F + kRounder;
  const float n = rounded - kRounder;
  const float r = (x - n * 0.693145751953125F) - n * 1.42860677e-6F;
  float rest = 1.0F / 7.0F;
  rest = (1.0F + r * rest) / 6.0F;
  rest = (1.0F + r * rest) / 5.0F;
  rest = (1.0F + r * rest) / 4.0F;
  rest = (1.0F + r * rest) / 3.0F;
  rest = (1.0F + r * rest) / 2.0F;
  rest = r * (1.0F + r * rest);
  std::int32_t bits;
  std::memcpy(&bits, &rounded, sizeof bits);
  bits = static_cast<std::int32_t>((static_cast<std::uint32_t>(bits) << 23U) + 0x3f800000U);
  float power;
  std::memcpy(&power, &bits, sizeof power);
  return power * rest + (power - 1.0F);
}

// The law `fung` (elastic_law.h): x, and g, g' and g'' there.
struct StrainStiffening {
  float value, slope, curvature;
};

ROBOT_TISSUE_INLINE StrainStiffening strainStiffeningOf(float b, float x) {
  constexpr float kMost = static_cast<float>(elastic_law::kMostExponent);
  const float whole = x > 0.0F ? b * x : 0.0F;
  const float exponent = whole < kMost ? whole : kMost;
  const float beyond = whole - exponent;
  const float growth = growthOf(exponent), slope = 1.0F + growth;
  const float value = (growth + slope * beyond * (1.0F + 0.5F * beyond)) / (b > 0.0F ? b : 1.0F);
  const bool straight = !(x > 0.0F && b > 0.0F);
  return {straight ? x : value, slope * (1.0F + beyond), straight ? 0.0F : b * slope};
}

ROBOT_TISSUE_INLINE float invariantOf(const Modes& x, const Modes& y, const Modes& z) {
  return x.x * x.x + x.y * x.y + x.z * x.z + y.x * y.x + y.y * y.y + y.z * y.z + z.x * z.x +
         z.y * z.y + z.z * z.z + bendingOf(x) + bendingOf(y) + bendingOf(z);
}

// J - 1 and I1 - 3 from the displacement's modes, so that small ones are not rounded off; `side`
// as in ColoredLayout::Around.
struct Strain {
  float growth, excess;
};

// `side` of a cell that is seen from its lowest corner.
constexpr float kFromLowest[3] = {-1.0F, -1.0F, -1.0F};

ROBOT_TISSUE_INLINE Strain strainOf(const Modes& mx, const Modes& my, const Modes& mz,
                                    const float side[3]) {
  const float xx = side[0] * mx.x, yx = side[0] * my.x, zx = side[0] * mz.x;
  const float xy = side[1] * mx.y, yy = side[1] * my.y, zy = side[1] * mz.y;
  const float xz = side[2] * mx.z, yz = side[2] * my.z, zz = side[2] * mz.z;
  const float trace = xx + yy + zz;
  const float minors = xx * yy - xy * yx + yy * zz - yz * zy + xx * zz - xz * zx;
  const float cube = xx * (yy * zz - yz * zy) + xy * (yz * zx - yx * zz) + xz * (yx * zy - yy * zx);
  return {trace + minors + cube, 2.0F * trace + invariantOf(mx, my, mz)};
}

// x of elastic_law.h, w I1 - 3 with w = J^(-2/3): w (I1 - 3 - 3 (J^(2/3) - 1)).
ROBOT_TISSUE_INLINE float shapeStrainOf(const Strain& strain, float w) {
  const float volume = 1.0F + strain.growth;
  const float from = volume > kFlattest ? volume : kFlattest;
  const float root = inverseCubeRoot(from);
  const float r = from * root;
  const float lean =
      root * root * (strain.excess - 3.0F * strain.growth * (1.0F + volume) / (r * r + r + 1.0F));
  return volume > kFlattest ? lean : w * (3.0F + strain.excess) - 3.0F;
}

struct Vector {
  float x, y, z;
};

// Derivatives of -J, as seen from the lowest corner, by the modes of one axis of the places: by
// those along x, y and z.
struct Cofactors {
  Vector of_x, of_y, of_z;
};

ROBOT_TISSUE_INLINE Cofactors cofactorsOf(const Modes& mx, const Modes& my, const Modes& mz) {
  return {{my.y * mz.z - mz.y * my.z, my.z * mz.x - mz.z * my.x, my.x * mz.y - mz.x * my.y},
          {mz.y * mx.z - mx.y * mz.z, mz.z * mx.x - mx.z * mz.x, mz.x * mx.y - mx.x * mz.y},
          {mx.y * my.z - my.y * mx.z, mx.z * my.x - my.z * mx.x, mx.x * my.y - my.x * mx.y}};
}

ROBOT_TISSUE_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

ROBOT_TISSUE_INLINE float dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Derivatives of the barrier's density by the determinant of a corner's edges.
struct Barrier {
  float slope, curvature;
};

ROBOT_TISSUE_INLINE Barrier barrierOf(float shear, float spanned) {
  const float depth = spanned < kSqueezed ? (kSqueezed - spanned) / kSqueezed : 0.0F;
  const float height = kBarrier * shear;
  return {-3.0F * height / kSqueezed * depth * depth,
          6.0F * height / (kSqueezed * kSqueezed) * depth};
}

// Edge of a cell along an axis, over its length at rest: between corners that are seen as `near`
// and `far`.
ROBOT_TISSUE_INLINE Vector edgeOf(const float* const at[3], int near, int far, float side,
                                  const Vector& rest, int i) {
  const float by = 4.0F * side;
  return {by * (at[0][near + i] - at[0][far + i]) + rest.x,
          by * (at[1][near + i] - at[1][far + i]) + rest.y,
          by * (at[2][near + i] - at[2][far + i]) + rest.z};
}

}  // namespace robot_tissue
