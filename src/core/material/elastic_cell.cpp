#include "material/elastic_cell.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "material/elastic_law.h"
#include "material/viscosity.h"

namespace robot_tissue {
namespace {

// Corners at the far ends of the three face diagonals and of the body diagonal from `corner`.
std::array<int, 4> acrossDiagonals(int corner) {
  return {corner ^ 3, corner ^ 5, corner ^ 6, corner ^ 7};
}

double signOf(int corner, int axis) { return (corner >> axis & 1) != 0 ? 1.0 : -1.0; }

// F is the mean of the four edges a direction, over h.
ElasticCell::Reached meanWeights(double spacing) {
  ElasticCell::Reached weights;
  for (int corner = 0; corner < kCorners; ++corner) {
    weights[at(corner)] = Vec3(signOf(corner, 0), signOf(corner, 1), signOf(corner, 2)) / 4.0;
    weights[at(corner)] /= spacing;
  }
  return weights;
}

// F is made of the three edges at one corner, over h.
ElasticCell::Reached cornerWeights(int corner, double spacing) {
  ElasticCell::Reached weights;
  weights.fill(Vec3::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    const double share = signOf(corner, axis) / spacing;
    weights[at(corner)][axis] = share;
    weights[at(corner ^ 1 << axis)][axis] = -share;
  }
  return weights;
}

// F is the derivative at a place (h from the cell's middle).
ElasticCell::Reached weightsAt(const Vec3& place, double spacing) {
  ElasticCell::Reached weights;
  weights.fill(Vec3::Zero());
  for (int corner = 0; corner < kCorners; ++corner) {
    Vec3 share;
    for (int axis = 0; axis < 3; ++axis) share[axis] = 0.5 + signOf(corner, axis) * place[axis];
    for (int axis = 0; axis < 3; ++axis) {
      const double beside = share[(axis + 1) % 3] * share[(axis + 2) % 3];
      weights[at(corner)][axis] = signOf(corner, axis) * beside / spacing;
    }
  }
  return weights;
}

// At rest, from the lowest corner (h).
Vec3 restPlace(int corner) { return Vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1); }

ElasticCell::Reached withoutReached(const ElasticCell::Corners& corners) {
  ElasticCell::Reached all;
  all.fill(Vec3::Zero());
  std::copy(corners.begin(), corners.end(), all.begin());
  return all;
}

}  // namespace

ElasticCell::ElasticCell(const Moduli& moduli, double spacing, const Corners& displacement,
                         const CellFill* fill)
    : ElasticCell(moduli, spacing, withoutReached(displacement), fill, nullptr) {}

ElasticCell::ElasticCell(const Moduli& moduli, double spacing, const Reached& displacement,
                         const CellFill* fill, const CellReach* reach)
    : moduli_(moduli),
      spacing_(spacing),
      volume_(spacing * spacing * spacing),
      count_(reach == nullptr ? kCorners : kMostReached),
      fill_(fill),
      reach_(reach) {
  for (int corner = 0; corner < kCorners; ++corner) {
    position_[at(corner)] = spacing * restPlace(corner) + displacement[at(corner)];
  }
  for (int beyond = 0; beyond < count_ - kCorners; ++beyond) {
    const int side = beyond / kFaceNodes, way = side % 2 == 0 ? -1 : 1;
    const Vec3 rest = restPlace(faceCorner(side, beyond % kFaceNodes)) + way * Vec3::Unit(side / 2);
    const std::size_t node = at(kCorners + beyond);
    position_[node] = spacing * rest + displacement[node];
  }
  if (fill == nullptr) {
    measureFull();
  } else {
    measureFill();
  }
  findLaw();
  findSqueezedCorners();
}

void ElasticCell::measureFull() {
  mean_ = determinantOf(meanWeights(spacing_));
  const double share = 1.0 / (12.0 * spacing_ * spacing_);
  invariant_ = 0.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    Vec3 pull = Vec3::Zero();
    for (const int other : acrossDiagonals(corner)) {
      const Vec3 diagonal = position_[at(corner)] - position_[at(other)];
      pull += diagonal;
      invariant_ += 0.5 * share * diagonal.squaredNorm();  // each diagonal is met at both ends
    }
    invariant_slope_[at(corner)] = share * pull;
    invariant_own_[at(corner)] = 4.0;
  }
}

// By the means F e_a, q_ab, q_abc of fill_law.h, times h. What the corners add to each sums up to
// zero: places relative to one of them keep digits.
void ElasticCell::measureFill() {
  const FillLaw& law = fill_law_.emplace(fillLaw(*fill_, moduli_.bulk / moduli_.shear));
  const std::array<CornerSlopes, kMostReached> slopes = cornerSlopes(*fill_, reach_);
  Reached weights;
  Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, kSecond> bending = Eigen::Matrix<double, 3, kSecond>::Zero();
  Eigen::Matrix3d uneven = Eigen::Matrix3d::Zero();
  Vec3 twisting = Vec3::Zero();
  for (std::size_t node = 0; node < at(count_); ++node) {
    const Vec3 place = position_[node] - position_[0];
    weights[node] = slopes[node].strain / spacing_;
    strain += place * slopes[node].strain.transpose();
    bending += place * slopes[node].bending.transpose();
    uneven += place * slopes[node].uneven.transpose();
    twisting += law.twisting * slopes[node].twisting * place;
  }
  mean_ = determinantOf(weights, strain / spacing_);
  bending *= law.bending;
  uneven *= law.bending.diagonal().head<3>().asDiagonal();
  invariant_ = 0.0;
  for (std::size_t node = 0; node < at(count_); ++node) {
    Vec3& slope = invariant_slope_[node];
    slope = strain * slopes[node].strain + bending * slopes[node].bending +
            uneven * slopes[node].uneven + slopes[node].twisting * twisting;
    slope /= spacing_ * spacing_;
    invariant_ += slope.dot(position_[node] - position_[0]);
    invariant_own_[node] = 12.0 * invariantBetween(law, slopes[node], slopes[node]);
  }
}

ElasticCell::Pairs ElasticCell::invariantPairs() const {
  Pairs pairs = Pairs::Zero(count_, count_);
  if (!fill_law_) {
    for (int corner = 0; corner < kCorners; ++corner) {
      for (const int other : acrossDiagonals(corner)) pairs(corner, other) = -1.0;
      pairs(corner, corner) = 4.0;
    }
    return pairs;
  }
  const std::array<CornerSlopes, kMostReached> slopes = cornerSlopes(*fill_, reach_);
  for (int one = 0; one < count_; ++one) {
    for (int other = 0; other < count_; ++other) {
      pairs(one, other) = 12.0 * invariantBetween(*fill_law_, slopes[at(one)], slopes[at(other)]);
    }
  }
  return pairs;
}

ElasticCell::Determinant ElasticCell::determinantOf(const Reached& weight) const {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  for (int corner = 0; corner < kCorners; ++corner) {
    gradient += position_[at(corner)] * weight[at(corner)].transpose();
  }
  return determinantOf(weight, gradient);
}

ElasticCell::Determinant ElasticCell::determinantOf(const Reached& weight,
                                                    const Eigen::Matrix3d& gradient) const {
  Determinant determinant;
  determinant.weight = weight;
  determinant.gradient = gradient;
  Eigen::Matrix3d cofactors;
  cofactors.col(0) = gradient.col(1).cross(gradient.col(2));
  cofactors.col(1) = gradient.col(2).cross(gradient.col(0));
  cofactors.col(2) = gradient.col(0).cross(gradient.col(1));
  determinant.value = gradient.col(0).dot(cofactors.col(0));
  for (std::size_t node = 0; node < at(count_); ++node) {
    determinant.slope[node] = cofactors * weight[node];
  }
  return determinant;
}

void ElasticCell::findSqueezedCorners() {
  if (fill_law_) return findSqueezedInFill();
  for (int corner = 0; corner < kCorners; ++corner) {
    Eigen::Matrix3d edges;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 outwards = position_[at(corner)] - position_[at(corner ^ 1 << axis)];
      edges.col(axis) = signOf(corner, axis) / spacing_ * outwards;
    }
    // Written so that a shape that is no number is not squeezed.
    if (!(edges.determinant() < elastic_law::kSqueezed)) continue;
    squeezed_[at(squeezed_count_++)] = determinantOf(cornerWeights(corner, spacing_));
  }
}

// So near that no place of the cell is squeezed: derivatives there are means of the edges along
// each axis, and with all columns of F - 1 below 0.33 / 3^(1/2) no singular value of F is below
// kSqueezed^(1/3).
bool ElasticCell::areEdgesNearRest() const {
  constexpr double kNear = 0.33 * 0.33 / 3.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) continue;
      Vec3 off = position_[at(corner | 1 << axis)] - position_[at(corner)];
      off[axis] -= spacing_;
      if (off.squaredNorm() > kNear * spacing_ * spacing_) return false;
    }
  }
  return true;
}

// Where the material is: corners of the cell that hold none may go where they like. Were they held
// apart, an edge that folded over could not find back, though next to nothing is bent by it.
void ElasticCell::findSqueezedInFill() {
  if (areEdgesNearRest()) return;
  for (int corner = 0; corner < kCorners; ++corner) {
    Vec3 place;
    for (int axis = 0; axis < 3; ++axis) {
      place[axis] = (corner >> axis & 1) != 0 ? fill_law_->high[axis] : fill_law_->low[axis];
    }
    const Determinant there = determinantOf(weightsAt(place, spacing_));
    if (there.value < elastic_law::kSqueezed) squeezed_[at(squeezed_count_++)] = there;
  }
}

// mu J^(-2/3).
ElasticCell::Curve ElasticCell::neoHookean() const {
  const double from = std::max(mean_.value, elastic_law::kFlattest);
  Curve curve;
  curve.value = moduli_.shear * std::pow(from, -2.0 / 3.0);
  curve.slope = -2.0 / 3.0 * curve.value / from;
  curve.curvature = -5.0 / 3.0 * curve.slope / from;
  const double beyond = mean_.value - from;
  curve.value += beyond * (curve.slope + 0.5 * beyond * curve.curvature);
  curve.slope += beyond * curve.curvature;
  return curve;
}

double ElasticCell::shapeStrain() const {
  return neoHookean().value / moduli_.shear * invariant_ - 3.0;
}

// With n(J) the neo-Hookean a and x = n I1 / mu - 3: a = g' n; derivatives by J are g' times those
// of n, and g'' times products of x's slopes.
void ElasticCell::findLaw() {
  const Curve n = neoHookean();
  const double change = mean_.value - 1.0;
  a_ = n.value;
  cross_slope_ = n.slope;
  volume_term_.value =
      0.5 * (n.value * invariant_ - 3.0 * moduli_.shear + moduli_.bulk * change * change);
  volume_term_.slope = 0.5 * n.slope * invariant_ + moduli_.bulk * change;
  volume_term_.curvature = 0.5 * n.curvature * invariant_ + moduli_.bulk;
  if (!(moduli_.stiffening > 0.0)) return;
  const double x = n.value / moduli_.shear * invariant_ - 3.0;
  const elastic_law::Stiffening g = elastic_law::stiffeningAt(moduli_.stiffening, x);
  const double by_volume = n.slope * invariant_;
  a_ = g.slope * n.value;
  cross_slope_ = g.slope * n.slope + g.curvature / moduli_.shear * n.value * by_volume;
  steepness_ = 2.0 * g.curvature / moduli_.shear * n.value * n.value;
  volume_term_.value = 0.5 * (moduli_.shear * g.value + moduli_.bulk * change * change);
  volume_term_.slope = 0.5 * g.slope * by_volume + moduli_.bulk * change;
  volume_term_.curvature = 0.5 * (g.slope * n.curvature * invariant_ +
                                  g.curvature / moduli_.shear * by_volume * by_volume) +
                           moduli_.bulk;
}

ElasticCell::Curve ElasticCell::barrier(const Determinant& edges) const {
  const double depth = (elastic_law::kSqueezed - edges.value) /
                       elastic_law::kSqueezed;  // 1 where the corner is flat
  const double height = elastic_law::kBarrier * moduli_.shear / kCorners;
  Curve curve;
  curve.value = height * depth * depth * depth;
  curve.slope = -3.0 * height * depth * depth / elastic_law::kSqueezed;
  curve.curvature = 6.0 * height * depth / (elastic_law::kSqueezed * elastic_law::kSqueezed);
  return curve;
}

// Half the derivative of I1 - |F|^2, which bends and twists.
Vec3 ElasticCell::roughSlope(std::size_t node) const {
  return invariant_slope_[node] - mean_.gradient * mean_.weight[node];
}

void ElasticCell::damp(const Moduli& viscous, const ElasticCell& from) {
  Damping& damping = damping_.emplace(Damping());  // Clang knows of no default one here
  damping.shear = viscous.shear;
  damping.lame = viscous.bulk - 2.0 / 3.0 * viscous.shear;
  const Eigen::Matrix3d inverse = viscosity::inverseOf(from.mean_.gradient);
  const Eigen::Matrix3d added = (mean_.gradient - from.mean_.gradient) * inverse;
  const Eigen::Matrix3d strain = 0.5 * (added + added.transpose());
  damping.stress = 2.0 * viscous.shear * strain;
  damping.stress.diagonal().array() += damping.lame * strain.trace();
  damping.energy = 0.5 * damping.stress.cwiseProduct(strain).sum();
  for (std::size_t node = 0; node < at(count_); ++node) {
    damping.weight[node] = inverse.transpose() * mean_.weight[node];
    damping.rough[node] = roughSlope(node) - from.roughSlope(node);
    damping.energy +=
        0.5 * viscous.shear * damping.rough[node].dot(position_[node] - from.position_[node]);
  }
}

void ElasticCell::addDamping(CellHessian& density) const {
  const Pairs pairs = invariantPairs();
  const double share = 1.0 / (12.0 * spacing_ * spacing_);
  for (int one = 0; one < count_; ++one) {
    const Vec3& g = damping_->weight[at(one)];
    for (int other = 0; other < count_; ++other) {
      const Vec3& of_other = damping_->weight[at(other)];
      const double rough =
          share * pairs(one, other) - mean_.weight[at(one)].dot(mean_.weight[at(other)]);
      auto block = density.block<3, 3>(3 * one, 3 * other);
      block +=
          damping_->shear * of_other * g.transpose() + damping_->lame * g * of_other.transpose();
      block.diagonal().array() += damping_->shear * (g.dot(of_other) + rough);
    }
  }
}

double ElasticCell::energy() const {
  double density = volume_term_.value;
  if (damping_) density += damping_->energy;
  for (int i = 0; i < squeezed_count_; ++i) density += barrier(squeezed_[at(i)]).value;
  return volume_ * density;
}

Vec3 ElasticCell::gradient(int corner) const {
  const std::size_t c = at(corner);
  Vec3 density = a_ * invariant_slope_[c] + volume_term_.slope * mean_.slope[c];
  if (damping_)
    density += damping_->stress * damping_->weight[c] + damping_->shear * damping_->rough[c];
  for (int i = 0; i < squeezed_count_; ++i) {
    density += barrier(squeezed_[at(i)]).slope * squeezed_[at(i)].slope[c];
  }
  return volume_ * density;
}

Eigen::Matrix3d ElasticCell::block(int corner) const {
  const std::size_t c = at(corner);
  const Vec3& l = invariant_slope_[c];
  const Vec3& j = mean_.slope[c];
  Eigen::Matrix3d density = cross_slope_ * (l * j.transpose() + j * l.transpose());
  density += volume_term_.curvature * j * j.transpose();
  density.diagonal().array() += a_ / (12.0 * spacing_ * spacing_) * invariant_own_[c];
  if (steepness_ > 0.0) density += steepness_ * l * l.transpose();
  if (damping_) {
    const Vec3& g = damping_->weight[c];
    const double rough =
        invariant_own_[c] / (12.0 * spacing_ * spacing_) - mean_.weight[c].squaredNorm();
    density += (damping_->shear + damping_->lame) * g * g.transpose();
    density.diagonal().array() += damping_->shear * (g.squaredNorm() + rough);
  }
  for (int i = 0; i < squeezed_count_; ++i) {
    const Vec3& slope = squeezed_[at(i)].slope[c];
    density += barrier(squeezed_[at(i)]).curvature * slope * slope.transpose();
  }
  return volume_ * density;
}

CellHessian ElasticCell::hessian() const {
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1>;
  const int rows = 3 * count_;
  CellHessian density = CellHessian::Zero(rows, rows);
  // A determinant D of F = sum of x_i w_i^T: d2D/dx_i dx_j = -[F (w_i x w_j)]x.
  const auto add = [&](const Curve& curve, const Determinant& determinant) {
    const Eigen::Map<const Column> slope(determinant.slope.front().data(), rows);
    density += curve.curvature * slope * slope.transpose();
    for (int i = 0; i < count_; ++i) {
      for (int j = 0; j < count_; ++j) {
        const Vec3 normal = determinant.weight[at(i)].cross(determinant.weight[at(j)]);
        density.block<3, 3>(3 * i, 3 * j) -=
            curve.slope * crossMatrix(determinant.gradient * normal);
      }
    }
  };
  add(volume_term_, mean_);
  const Eigen::Map<const Column> l(invariant_slope_.front().data(), rows);
  const Eigen::Map<const Column> j(mean_.slope.front().data(), rows);
  density += cross_slope_ * (l * j.transpose() + j * l.transpose());
  if (steepness_ > 0.0) density += steepness_ * l * l.transpose();
  const double share = a_ / (12.0 * spacing_ * spacing_);
  const Pairs pairs = invariantPairs();
  for (int one = 0; one < count_; ++one) {
    for (int other = 0; other < count_; ++other) {
      density.block<3, 3>(3 * one, 3 * other).diagonal().array() += share * pairs(one, other);
    }
  }
  for (int i = 0; i < squeezed_count_; ++i) add(barrier(squeezed_[at(i)]), squeezed_[at(i)]);
  if (damping_) addDamping(density);
  return volume_ * density;
}

}  // namespace robot_tissue
