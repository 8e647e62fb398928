#include "membrane/hinge.h"

#include <Eigen/Geometry>
#include <cmath>

namespace robot_tissue {
namespace {

constexpr double kPi = 3.14159265358979323846;

// The angle's gradient is, at corner i, the sum over both triangles k of s_ik N_k / |N_k|^2, where
// N_k = x_a x x_b + x_b x x_c + x_c x x_a, and s_ik is -|e| at the corner opposite to the edge e,
// and at the edge's ends what balances that: (x_1 - x_k) . e / |e| and (x_k - x_0) . e / |e|.
struct HingeSide {
  std::array<int, 3> corners;  // a, b, c: turned as the triangle; c is opposite to the edge
  Vec3 normal, scaled;         // N, N / |N|^2
  Eigen::Matrix3d of_normal;   // derivative of `scaled` by N
};

HingeSide sideOf(const Hinge::Corners& places, const std::array<int, 3>& corners) {
  HingeSide side;
  side.corners = corners;
  const Vec3 &a = places[at(corners[0])], &b = places[at(corners[1])], &c = places[at(corners[2])];
  side.normal = (b - a).cross(c - a);
  const double squared = side.normal.squaredNorm();
  side.scaled = side.normal / squared;
  side.of_normal =
      Eigen::Matrix3d::Identity() / squared - 2.0 * side.scaled * side.scaled.transpose();
  return side;
}

std::array<HingeSide, 2> sidesOf(const Hinge::Corners& places) {
  return {sideOf(places, {0, 1, 2}), sideOf(places, {1, 0, 3})};
}

// Of N by the corner: dN = dx_a x (x_b - x_c) + ...
Eigen::Matrix3d normalDerivative(const Hinge::Corners& places, const HingeSide& side, int corner) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (side.corners[i] != corner) continue;
    const Vec3& next = places[at(side.corners[(i + 1) % 3])];
    return crossMatrix(places[at(side.corners[(i + 2) % 3])] - next);
  }
  return Eigen::Matrix3d::Zero();
}

// s_ik, and its derivatives by the four corners.
struct Share {
  double value = 0.0;
  std::array<Vec3, 4> slope = {{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}};
};

// (x_to - x_from) . e / |e|
Share along(const Hinge::Corners& places, int from, int to) {
  const Vec3 edge = places[1] - places[0];
  const double length = edge.norm();
  const Vec3 direction = edge / length, way = places[at(to)] - places[at(from)];
  Share share;
  share.value = way.dot(direction);
  const Vec3 turned = (way - share.value * direction) / length;
  share.slope[at(to)] += direction;
  share.slope[at(from)] -= direction;
  share.slope[1] += turned;
  share.slope[0] -= turned;
  return share;
}

std::array<Share, 4> sharesOf(const Hinge::Corners& places, const HingeSide& side) {
  const int opposite = side.corners[2];
  std::array<Share, 4> shares;
  shares[0] = along(places, opposite, 1);
  shares[1] = along(places, 0, opposite);
  shares[at(opposite)] = along(places, 1, 0);  // -|e|
  return shares;
}

Hinge::Hessian angleHessian(const Hinge::Corners& places) {
  Hinge::Hessian hessian = Hinge::Hessian::Zero();
  for (const HingeSide& side : sidesOf(places)) {
    const std::array<Share, 4> shares = sharesOf(places, side);
    for (int j = 0; j < 4; ++j) {
      const Eigen::Matrix3d scaled = side.of_normal * normalDerivative(places, side, j);
      for (int i = 0; i < 4; ++i) {
        hessian.block<3, 3>(3 * i, 3 * j) +=
            side.scaled * shares[at(i)].slope[at(j)].transpose() + shares[at(i)].value * scaled;
      }
    }
  }
  return hessian;
}

// The angle and its gradient, as above, without what their derivatives need.
struct Turn {
  double angle;
  Hinge::Corners gradient;
};

Turn turnOf(const Hinge::Corners& places) {
  const Vec3 edge = places[1] - places[0];
  const Vec3 one = places[2] - places[0], other = places[3] - places[0];
  const Vec3 normal = edge.cross(one), other_normal = other.cross(edge);
  const double length = edge.norm();
  const Vec3 direction = edge / length;
  const Vec3 scaled = normal / normal.squaredNorm();
  const Vec3 other_scaled = other_normal / other_normal.squaredNorm();
  const double along = one.dot(direction), other_along = other.dot(direction);
  const double sine = normal.cross(other_normal).dot(direction);
  return {std::atan2(sine, normal.dot(other_normal)),
          {(length - along) * scaled + (length - other_along) * other_scaled,
           along * scaled + other_along * other_scaled, -length * scaled, -length * other_scaled}};
}

}  // namespace

Hinge::Hinge(double bending, const Corners& rest) : rest_angle_(angle(rest)) {
  const double area = 0.5 * ((rest[1] - rest[0]).cross(rest[2] - rest[0]).norm() +
                             (rest[1] - rest[0]).cross(rest[3] - rest[0]).norm());
  stiffness_ = bending * (rest[1] - rest[0]).squaredNorm() / area;
}

double Hinge::angle(const Corners& places) { return turnOf(places).angle; }

double Hinge::fromRest(double angle) const {
  const double bent = angle - rest_angle_;
  if (bent > kPi) return bent - 2.0 * kPi;
  return bent < -kPi ? bent + 2.0 * kPi : bent;
}

double Hinge::energy(const Corners& places) const {
  const double bent = fromRest(angle(places));
  return 0.5 * stiffness_ * bent * bent;
}

Hinge::Corners Hinge::gradient(const Corners& places) const {
  Turn turn = turnOf(places);
  const double moment = stiffness_ * fromRest(turn.angle);
  for (Vec3& vector : turn.gradient) vector *= moment;
  return turn.gradient;
}

Hinge::Hessian Hinge::hessian(const Corners& places, Curvature curvature) const {
  const Turn turn = turnOf(places);
  Eigen::Matrix<double, 12, 1> slope;
  for (int i = 0; i < 4; ++i) slope.segment<3>(3 * i) = turn.gradient[at(i)];
  Hessian hessian = stiffness_ * slope * slope.transpose();
  if (curvature == Curvature::kExact) {
    hessian += stiffness_ * fromRest(turn.angle) * angleHessian(places);
  }
  return hessian;
}

}  // namespace robot_tissue
