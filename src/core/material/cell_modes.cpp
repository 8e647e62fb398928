#include "material/cell_modes.h"

#include <cstdint>
#include <cstring>

#include "material/elastic_law.h"

namespace robot_tissue {
namespace {

// G: the three edges at a corner over their lengths at rest. With |G - 1|^2 below 0.33^2 no
// singular value of G is below 1 - 0.33 = 0.3^(1/3), so det G > 0.3: the barrier does not rise.
// Half of that: what solve() compares is the sum of squares of the two parts of G - 1 (mean edges;
// what bends and twists), and |a + b|^2 <= 2 (|a|^2 + |b|^2).
constexpr double kSlight = 0.5 * 0.33 * 0.33;

// w_s of the header: by the number of axes in s.
constexpr double kWeight[kCorners] = {0.0, 1.0,       1.0,       2.0 / 3.0,
                                      1.0, 2.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0};

// x^(-1/3), x > 0: a guess within 4 % by dividing the exponent's bits, then Newton's method,
// r += r (1 - x r^3) / 3. With std::cbrt it would be a third of the time of solve().
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

inline double sumOf(const double* x) {
  return ((x[0] + x[4]) + (x[1] + x[5])) + ((x[2] + x[6]) + (x[3] + x[7]));
}

}  // namespace

void CellModes::add(const Moduli& moduli, const std::array<int, kCorners>& nodes, int corner,
                    const std::vector<Vec3>& displacement, bool is_full) {
  const int cell = count_++;
  full_[cell] = is_full;
  for (int k = 0; k < kCorners; ++k) {
    const Vec3& moved = displacement[at(nodes[at(corner ^ k)])];
    for (int axis = 0; axis < 3; ++axis) mode_[k][axis][cell] = moved[axis];
  }
  shear_[cell] = moduli.shear;
  bulk_[cell] = moduli.bulk;
  exponent_[cell] = moduli.stiffening;
  stiffens_ = stiffens_ || moduli.stiffening > 0.0;
  for (int axis = 0; axis < 3; ++axis) side_[axis][cell] = (corner >> axis & 1) != 0 ? 1.0 : -1.0;
}

void CellModes::solve() {
  for (int cell = count_; cell < kMost; ++cell) {
    for (auto& mode : mode_) {
      for (int axis = 0; axis < 3; ++axis) mode[axis][cell] = 0.0;
    }
    for (int axis = 0; axis < 3; ++axis) side_[axis][cell] = 1.0;
    full_[cell] = true;
    shear_[cell] = bulk_[cell] = exponent_[cell] = 0.0;
  }
  transform();
  const double scale = 0.25 / spacing_;
  for (auto& mode : mode_) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int cell = 0; cell < kMost; ++cell) mode[axis][cell] *= scale;
    }
  }
  measure();
  for (int cell = 0; cell < kMost; ++cell) {
    lean_[cell] = full_[cell] && volume_[cell] >= elastic_law::kFlattest &&
                  (slight_[cell] < kSlight || !hasSqueezedCorner(cell));
    if (lean_[cell]) continue;
    shear_[cell] = bulk_[cell] = 0.0;
    volume_[cell] = 1.0;
  }
  stiffen();
  if (stiffens_) stiffenByStrain();
  look();
}

// From corners to modes: sums and differences along one axis after another (a Walsh-Hadamard
// transform). Applied twice it gives back eight times the corners' values.
void CellModes::transform() {
  for (int bit = 1; bit < kCorners; bit <<= 1) {
    for (int k = 0; k < kCorners; ++k) {
      if ((k & bit) != 0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        double* low = mode_[k][axis];
        double* high = mode_[k | bit][axis];
        for (int cell = 0; cell < kMost; ++cell) {
          const double sum = low[cell] + high[cell];
          high[cell] = low[cell] - high[cell];
          low[cell] = sum;
        }
      }
    }
  }
}

// Adds the rest shape to the modes of the displacements, then finds I1, J and the cofactors of F.
void CellModes::measure() {
  for (int cell = 0; cell < kMost; ++cell) slight_[cell] = invariant_[cell] = volume_[cell] = 0.0;
  const auto square = [](double x) { return x * x; };
  for (int axis = 0; axis < 3; ++axis) {
    for (int cell = 0; cell < kMost; ++cell) {
      const double bent = square(mode_[3][axis][cell]) + square(mode_[5][axis][cell]) +
                          square(mode_[6][axis][cell]);
      const double twisted = square(mode_[7][axis][cell]);
      const double strained = square(mode_[1][axis][cell]) + square(mode_[2][axis][cell]) +
                              square(mode_[4][axis][cell]);
      slight_[cell] += strained + 3.0 * (2.0 * bent + 3.0 * twisted);
      invariant_[cell] += (2.0 * bent + twisted) / 3.0;
      mode_[1 << axis][axis][cell] += side_[axis][cell];
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int y = (axis + 1) % 3, z = (axis + 2) % 3;
    for (int cell = 0; cell < kMost; ++cell) {
      const double ay = mode_[1][y][cell], az = mode_[1][z][cell];
      const double by = mode_[2][y][cell], bz = mode_[2][z][cell];
      const double cy = mode_[4][y][cell], cz = mode_[4][z][cell];
      cofactor_[0][axis][cell] = by * cz - bz * cy;
      cofactor_[1][axis][cell] = cy * az - cz * ay;
      cofactor_[2][axis][cell] = ay * bz - az * by;
      volume_[cell] += mode_[1][axis][cell] * cofactor_[0][axis][cell];
      invariant_[cell] += square(mode_[1][axis][cell]) + square(mode_[2][axis][cell]) +
                          square(mode_[4][axis][cell]);
    }
  }
  for (int cell = 0; cell < kMost; ++cell) {
    hand_[cell] = side_[0][cell] * side_[1][cell] * side_[2][cell];
    volume_[cell] *= hand_[cell];
  }
}

void CellModes::stiffen() {
  for (int cell = 0; cell < kMost; ++cell) {
    const double root = inverseCubeRoot(volume_[cell]);
    const double inverse = root * root * root;
    a_[cell] = shear_[cell] * root * root;
    slope_[cell] = -2.0 / 3.0 * a_[cell] * inverse;
    pressure_[cell] = 0.5 * slope_[cell] * invariant_[cell] + bulk_[cell] * (volume_[cell] - 1.0);
    curvature_[cell] = -5.0 / 6.0 * slope_[cell] * inverse * invariant_[cell] + bulk_[cell];
  }
}

// As ElasticCell::findLaw, with w(J) = n / mu.
void CellModes::stiffenByStrain() {
  for (int cell = 0; cell < kMost; ++cell) {
    const double root = inverseCubeRoot(volume_[cell]);
    const double w = root * root, inverse = root * root * root;
    const double by_volume = -2.0 / 3.0 * w * inverse * invariant_[cell];
    const elastic_law::Stiffening g =
        elastic_law::stiffeningAt(exponent_[cell], w * invariant_[cell] - 3.0);
    const double steep = shear_[cell] * g.curvature, press = bulk_[cell] * (volume_[cell] - 1.0);
    a_[cell] *= g.slope;
    slope_[cell] = g.slope * slope_[cell] + steep * w * by_volume;
    pressure_[cell] = g.slope * (pressure_[cell] - press) + press;
    curvature_[cell] = g.slope * (curvature_[cell] - bulk_[cell]) +
                       0.5 * steep * by_volume * by_volume + bulk_[cell];
    steepness_[cell] = 2.0 * steep * w * w;
  }
}

// The edge at a corner along an axis is the mean edge plus the modes that change sign along it.
bool CellModes::hasSqueezedCorner(int cell) const {
  const auto mode = [&](int s) -> Vec3 {
    return {mode_[s][0][cell], mode_[s][1][cell], mode_[s][2][cell]};
  };
  for (int corner = 0; corner < kCorners; ++corner) {
    const double x = (corner & 1) != 0 ? -1.0 : 1.0;
    const double y = (corner & 2) != 0 ? -1.0 : 1.0;
    const double z = (corner & 4) != 0 ? -1.0 : 1.0;
    const Vec3 along_x = mode(1) + y * mode(3) + z * mode(5) + y * z * mode(7);
    const Vec3 along_y = mode(2) + x * mode(3) + z * mode(6) + x * z * mode(7);
    const Vec3 along_z = mode(4) + x * mode(5) + y * mode(6) + x * y * mode(7);
    if (!(hand_[cell] * along_x.dot(along_y.cross(along_z)) > elastic_law::kSqueezed)) return true;
  }
  return false;
}

// In the corner that the cell is seen from, times 4h: l = (1/2) dI1/dx = sum of w_s M_s / 4h, and
// c = dJ/dx = sum of the cofactors' columns.
void CellModes::look() {
  for (int axis = 0; axis < 3; ++axis) {
    for (int cell = 0; cell < kMost; ++cell) {
      l_[axis][cell] =
          mode_[1][axis][cell] + mode_[2][axis][cell] + mode_[4][axis][cell] +
          2.0 / 3.0 * (mode_[3][axis][cell] + mode_[5][axis][cell] + mode_[6][axis][cell]) +
          1.0 / 3.0 * mode_[7][axis][cell];
      c_[axis][cell] = hand_[cell] * (cofactor_[0][axis][cell] + cofactor_[1][axis][cell] +
                                      cofactor_[2][axis][cell]);
    }
  }
}

// dE/dx = h^2/4 [a l + p c], with the pressure p = dE/dJ / h^3.
Vec3 CellModes::gradient() const {
  Vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    Lanes part;
    for (int cell = 0; cell < kMost; ++cell) {
      part[cell] = a_[cell] * l_[axis][cell] + pressure_[cell] * c_[axis][cell];
    }
    gradient[axis] = 0.25 * spacing_ * spacing_ * sumOf(part);
  }
  return gradient;
}

// d2E/dx2 = h/16 [16/3 a + a' (l c^T + c l^T) + p' c c^T + s l l^T]; ' is the derivative by J, s
// the steepness.
Eigen::Matrix3d CellModes::block() const {
  Lanes half[3];
  for (int axis = 0; axis < 3; ++axis) {
    for (int cell = 0; cell < kMost; ++cell) {
      half[axis][cell] = slope_[cell] * l_[axis][cell] + 0.5 * curvature_[cell] * c_[axis][cell];
    }
  }
  Eigen::Matrix3d block;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      Lanes part;
      for (int cell = 0; cell < kMost; ++cell) {
        part[cell] = half[i][cell] * c_[j][cell] + c_[i][cell] * half[j][cell];
      }
      for (int cell = 0; stiffens_ && cell < kMost; ++cell) {
        part[cell] += steepness_[cell] * l_[i][cell] * l_[j][cell];
      }
      block(i, j) = block(j, i) = spacing_ / 16.0 * sumOf(part);
    }
  }
  block.diagonal().array() += spacing_ / 3.0 * sumOf(a_);
  return block;
}

void CellModes::findGradients() {
  const double area = 0.25 * spacing_ * spacing_;
  for (int s = 0; s < kCorners; ++s) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int cell = 0; cell < kMost; ++cell) {
        mode_[s][axis][cell] *= area * kWeight[s] * a_[cell];
      }
    }
  }
  for (int along = 0; along < 3; ++along) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int cell = 0; cell < kMost; ++cell) {
        mode_[1 << along][axis][cell] +=
            area * hand_[cell] * pressure_[cell] * cofactor_[along][axis][cell];
      }
    }
  }
  transform();
}

}  // namespace robot_tissue
