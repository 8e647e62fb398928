#include "robot_tissue/core/cell_modes.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace robot_tissue {
namespace {

constexpr double kFlattest = 0.1;  // as in ElasticCell
constexpr double kSqueezed = 0.3;  // likewise
// |G - 1|^2 of a corner's edges G below which det G > 0.3, as then no singular value is below
// 0.3^(1/3); half of it, as |G - 1|^2 is bounded by twice the sum of the squares of two parts.
constexpr double kSlight = 0.5 * 0.33 * 0.33;

// x^(-1/3), x > 0: a guess within 4 % from the exponent, then Newton's method.
inline double inverseCubeRoot(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits = 0x553f0a3d70a3d70aU - bits / 3;
  double root;
  std::memcpy(&root, &bits, sizeof root);
  const double third = x / 3.0;
  for (int i = 0; i < 4; ++i) root *= 4.0 / 3.0 - third * root * root * root;
  return root;
}

}  // namespace

void CellModes::add(const Moduli& moduli, const std::array<int, kCorners>& nodes, int corner,
                    const std::vector<Vec3>& displacement) {
  const int cell = count_++;
  for (int k = 0; k < kCorners; ++k) {
    const Vec3& moved = displacement[at(nodes[at(corner ^ k)])];
    for (int axis = 0; axis < 3; ++axis) mode_[k][axis][cell] = moved[axis];
  }
  shear_[cell] = moduli.shear;
  bulk_[cell] = moduli.bulk;
  for (int axis = 0; axis < 3; ++axis) side_[axis][cell] = (corner >> axis & 1) != 0 ? 1.0 : -1.0;
}

// Sums and differences along one axis after another; then over 4h, from displacements to places.
void CellModes::transform() {
  for (int bit = 1; bit < kCorners; bit <<= 1) {
    for (int k = 0; k < kCorners; ++k) {
      if ((k & bit) != 0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        double* low = mode_[k][axis];
        double* high = mode_[k | bit][axis];
        for (int cell = 0; cell < kCells; ++cell) {
          const double sum = low[cell] + high[cell];
          high[cell] = low[cell] - high[cell];
          low[cell] = sum;
        }
      }
    }
  }
  const double scale = 0.25 / spacing_;
  for (int s = 1; s < kCorners; ++s) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int cell = 0; cell < kCells; ++cell) mode_[s][axis][cell] *= scale;
    }
  }
}

void CellModes::solve() {
  transform();
  double slight[kCells], invariant[kCells];
  for (int cell = 0; cell < kCells; ++cell) slight[cell] = invariant[cell] = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int cell = 0; cell < kCells; ++cell) {
      const double bent = mode_[3][axis][cell] * mode_[3][axis][cell] +
                          mode_[5][axis][cell] * mode_[5][axis][cell] +
                          mode_[6][axis][cell] * mode_[6][axis][cell];
      const double twisted = mode_[7][axis][cell] * mode_[7][axis][cell];
      const double strained = mode_[1][axis][cell] * mode_[1][axis][cell] +
                              mode_[2][axis][cell] * mode_[2][axis][cell] +
                              mode_[4][axis][cell] * mode_[4][axis][cell];
      slight[cell] += strained + 3.0 * (2.0 * bent + 3.0 * twisted);
      mode_[1 << axis][axis][cell] += side_[axis][cell];
      invariant[cell] += (2.0 * bent + twisted) / 3.0;
    }
  }
  for (int s = 1; s < kCorners; s <<= 1) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int cell = 0; cell < kCells; ++cell) {
        invariant[cell] += mode_[s][axis][cell] * mode_[s][axis][cell];
      }
    }
  }
  // l and c: (1/2) dI1 and dJ over dx, times 4h.
  double l[3][kCells], c[3][kCells], volume[kCells];
  for (int cell = 0; cell < kCells; ++cell) volume[cell] = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    for (int cell = 0; cell < kCells; ++cell) {
      const double a1 = mode_[1][next][cell], a2 = mode_[1][last][cell];
      const double b1 = mode_[2][next][cell], b2 = mode_[2][last][cell];
      const double d1 = mode_[4][next][cell], d2 = mode_[4][last][cell];
      const double from_x = b1 * d2 - b2 * d1;
      c[axis][cell] = from_x + (d1 * a2 - d2 * a1) + (a1 * b2 - a2 * b1);
      volume[cell] += mode_[1][axis][cell] * from_x;
      l[axis][cell] =
          mode_[1][axis][cell] + mode_[2][axis][cell] + mode_[4][axis][cell] +
          2.0 / 3.0 * (mode_[3][axis][cell] + mode_[5][axis][cell] + mode_[6][axis][cell]) +
          1.0 / 3.0 * mode_[7][axis][cell];
    }
  }
  double hand[kCells], a[kCells], a1[kCells], p[kCells], q[kCells];
  for (int cell = 0; cell < kCells; ++cell) {
    hand[cell] = side_[0][cell] * side_[1][cell] * side_[2][cell];
    volume[cell] *= hand[cell];
  }
  for (int cell = 0; cell < count_; ++cell) {
    lean_[cell] = volume[cell] >= kFlattest && (slight[cell] < kSlight || !hasSqueezedCorner(cell));
    if (!lean_[cell]) {
      shear_[cell] = bulk_[cell] = 0.0;
      volume[cell] = 1.0;
    }
  }
  for (int cell = count_; cell < kCells; ++cell) volume[cell] = 1.0;
  for (int cell = 0; cell < kCells; ++cell) {
    const double root = inverseCubeRoot(volume[cell]);
    a[cell] = shear_[cell] * root * root;
    const double inverse = root * root * root;
    a1[cell] = -2.0 / 3.0 * a[cell] * inverse;
    p[cell] = hand[cell] *
              (0.5 * a1[cell] * invariant[cell] + bulk_[cell] * (volume[cell] - 1.0));
    q[cell] = -5.0 / 6.0 * a1[cell] * inverse * invariant[cell] + bulk_[cell];
    a1[cell] *= hand[cell];
  }
  double g[3] = {0, 0, 0}, b[6] = {0, 0, 0, 0, 0, 0}, diagonal = 0.0;
  for (int cell = 0; cell < kCells; ++cell) {
    const double lx = l[0][cell], ly = l[1][cell], lz = l[2][cell];
    const double cx = c[0][cell], cy = c[1][cell], cz = c[2][cell];
    const double s = a1[cell], k = q[cell];
    g[0] += a[cell] * lx + p[cell] * cx;
    g[1] += a[cell] * ly + p[cell] * cy;
    g[2] += a[cell] * lz + p[cell] * cz;
    const double wx = s * lx + 0.5 * k * cx, wy = s * ly + 0.5 * k * cy, wz = s * lz + 0.5 * k * cz;
    b[0] += 2.0 * wx * cx;
    b[1] += wx * cy + wy * cx;
    b[2] += wx * cz + wz * cx;
    b[3] += 2.0 * wy * cy;
    b[4] += wy * cz + wz * cy;
    b[5] += 2.0 * wz * cz;
    diagonal += a[cell];
  }
  const double area = 0.25 * spacing_ * spacing_;
  gradient_ = area * Vec3(g[0], g[1], g[2]);
  block_ << b[0], b[1], b[2], b[1], b[3], b[4], b[2], b[4], b[5];
  block_ *= spacing_ / 16.0;
  block_.diagonal().array() += spacing_ / 3.0 * diagonal;
}

// The edge at a corner along an axis is F e_a plus the modes that change sign along it.
bool CellModes::hasSqueezedCorner(int cell) const {
  const auto mode = [&](int s) {
    return Vec3(mode_[s][0][cell], mode_[s][1][cell], mode_[s][2][cell]);
  };
  const double hand = side_[0][cell] * side_[1][cell] * side_[2][cell];
  for (int corner = 0; corner < kCorners; ++corner) {
    const double x = (corner & 1) != 0 ? -1.0 : 1.0, y = (corner & 2) != 0 ? -1.0 : 1.0,
                 z = (corner & 4) != 0 ? -1.0 : 1.0;
    const Vec3 along_x = mode(1) + y * mode(3) + z * mode(5) + y * z * mode(7);
    const Vec3 along_y = mode(2) + x * mode(3) + z * mode(6) + x * z * mode(7);
    const Vec3 along_z = mode(4) + x * mode(5) + y * mode(6) + x * y * mode(7);
    if (!(hand * along_x.dot(along_y.cross(along_z)) > kSqueezed)) return true;
  }
  return false;
}

}  // namespace robot_tissue
