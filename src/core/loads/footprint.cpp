#include "loads/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace robot_tissue {
namespace {

// Geometric mean distance of two points of the pressure under a flat strip, of half its width (1).
constexpr double kUnderFlat = 0.5;
// Of a square to what the formula of strips tells (1): 1 / (2 E* 1.012 sqrt(A / pi)) (King 1987).
constexpr double kMoreOfSquare = 0.047;
// How much less the mean height is at a corner than along two edges (1), by the product of the
// slopes that meet: from solutions for half-spaces (test_footprint.cpp), to 3 %.
constexpr double kLowerAtCorner = 0.13;
constexpr double kLowerIfSteep = 0.25;
// Sides hang on each other. More: more exact; 12: to 1e-3.
constexpr int kRounds = 12;

// One way along the surface. What touches is `touches` wide; more of it would stand
// `growth * touches^power` over the lowest place, mean under a flat punch's pressure (m).
struct Side {
  double growth = 0.0;
  int power = 1;
  double slope = 0.0;    // of the face (1)
  double most = 0.0;     // m: all of the face
  double touches = 0.0;  // m
  double in_part = 0.0;  // 1: there is more of the face than touches
  double size = 0.0;     // of what is flat (m)

  double height() const { return growth * std::pow(touches, power); }
  // Where its height grows as fast with its logarithm as the depth falls (m).
  void widen(double falls) {
    const double asked = growth > 0.0 ? std::pow(falls / (power * growth), 1.0 / power)
                                      : std::numeric_limits<double>::infinity();
    in_part = std::min(1.0, most / asked);
    touches = std::sqrt(touches * std::min(asked, most));
  }
  // How much tissue that bulges so (1/m) may fall off within what is flat (m): where it faces that,
  // as far as is known from what touches within `reach` (m).
  double bulge(double curvature, double reach) const {
    const bool may_face = curvature * std::min(size, reach) > slope;
    return may_face ? curvature * size * size / 8.0 : 0.0;
  }
};

// A face of that size (m) that recedes with a slope, and beyond its edge, at a right angle to it,
// another one. Of all places of a strip across both it stands where its mean height is least:
// arccos of how far the edge is off its middle, of half its width, is pi slope^2 / (1 + slope^2).
Side edgeOf(double size, double slope, double thickness) {
  Side side;
  const double square = slope * slope, angle = M_PI * square / (1.0 + square);
  if (slope > 0.0) side.growth = std::sin(angle) * (1.0 + square) / (2.0 * M_PI * slope);
  side.slope = slope;
  side.size = size;
  side.most = std::min(2.0 * size / (1.0 + std::cos(angle)), size + thickness);
  side.touches = side.most;
  return side;
}

// Of that radius (m).
Side roundOf(double radius, double most) {
  Side side;
  side.growth = 1.0 / (16.0 * radius);
  side.power = 2;
  side.most = side.touches = most;
  return side;
}

struct Face {
  Side side, other;
  double disc = 0.0;  // radius of a cylinder's end (m), else 0

  // Where three faces meet, what touches is no rectangle but a triangle, and stands so much (1)
  // less high.
  double lower() const {
    const double at_corner =
        side.power == 1 && other.power == 1 ? side.in_part * other.in_part : 0.0;
    return 1.0 / (1.0 + at_corner * (kLowerAtCorner + kLowerIfSteep * side.slope * other.slope));
  }
};

// A cylinder's rim is round as seen along the way it presses, of its radius over the sine of the
// angle between that and its axis.
Face faceOfCylinder(const BoxOrCylinder& body, const Vec3& along) {
  const double across = along.head<2>().norm(), length = 2.0 * body.half_size.z();
  Face face;
  if (across > along.z()) {
    face.side = roundOf(body.radius / across, 2.0 * body.radius);
    face.other = edgeOf(length, along.z() / across, 2.0 * body.radius);
  } else {
    const double size = std::sqrt(M_PI) * body.radius;  // a square of its area
    face.disc = body.radius;
    face.side = edgeOf(size, across / along.z(), length);
    face.other = across > 0.0 ? roundOf(body.radius / across, size) : edgeOf(size, 0.0, length);
  }
  return face;
}

Face faceOf(const BoxOrCylinder& body, const Vec3& facing) {
  const Vec3 along = facing.cwiseAbs();
  if (body.radius > 0.0) return faceOfCylinder(body, along);
  std::array<int, 3> axes = {0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return along[a] > along[b]; });
  const double thickness = 2.0 * body.half_size[axes[0]];
  const auto side = [&](int axis) {
    return edgeOf(2.0 * body.half_size[axis], along[axis] / along[axes[0]], thickness);
  };
  return {side(axes[1]), side(axes[2]), 0.0};
}

// Of a tilted disc only a segment touches, which is no longer than its chord.
double chord(double radius, double height) {
  return height < radius ? 2.0 * std::sqrt(height * (2.0 * radius - height)) : 2.0 * radius;
}

// How far a half-space goes under a strip, and how that falls with the logarithm of its width and
// of its length (m).
struct Strip {
  double depth = 0.0;
  double by_width = 0.0;
  double by_length = 0.0;

  // `load`: force over plane modulus (m^2). `width` <= `length` (m).
  Strip(double load, double width, double length) {
    const double distance = 0.5 * kUnderFlat * width / length;
    const double square = width / length * width / length, more = 1.0 + kMoreOfSquare * square;
    const double far = std::sqrt(1.0 + distance * distance);
    const double even = std::asinh(1.0 / distance) - far + distance;
    const double scale = 2.0 * load / (M_PI * length);
    depth = scale * even * more;
    by_width = scale * ((far - distance) * more - 2.0 * kMoreOfSquare * square * even);
    by_length = depth - by_width;
  }
};

}  // namespace

Footprint footprintOf(const BoxOrCylinder& body, const Vec3& facing, double force,
                      double plane_modulus, const Bulge& tissue) {
  Face face = faceOf(body, facing);
  const double load = force / plane_modulus;  // m^2
  Side *narrow = &face.side, *wide = &face.other;
  for (int round = 0; round < kRounds; ++round) {
    if (narrow->touches > wide->touches) std::swap(narrow, wide);
    const Strip strip(load, narrow->touches, wide->touches);
    const double lower = face.lower();
    narrow->widen(strip.by_width / lower);
    wide->widen(strip.by_length / lower);
    if (face.disc > 0.0) {
      face.other.touches = std::min(face.other.touches, chord(face.disc, face.side.touches));
    }
  }
  if (narrow->touches > wide->touches) std::swap(narrow, wide);
  Footprint footprint;
  footprint.width = narrow->touches;
  footprint.bulge =
      narrow->bulge(tissue.curvature, tissue.reach) + wide->bulge(tissue.curvature, tissue.reach);
  footprint.depth = Strip(load, narrow->touches, wide->touches).depth +
                    face.lower() * (narrow->height() + wide->height());
  return footprint;
}

}  // namespace robot_tissue
