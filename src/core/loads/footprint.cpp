#include "loads/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace robot_tissue {
namespace {

// Geometric mean distance of two points of the pressure across a strip, of half its width (1):
// under a flat strip, a lying cylinder (Johnson 1985, 4.43) and an edge (5.3, as arcosh(a / x)).
constexpr double kUnderFlat = 0.5;
constexpr double kUnderCylinder = 0.3894;  // exp(-1/4) / 2
constexpr double kUnderEdge = 0.3033;
// Mean distance of an edge's pressure from an edge, of half the width (1).
constexpr double kMeanUnderEdge = 1.0 / M_PI;
// Of a square to what the formula of strips tells (1): 1 / (2 E* 1.012 sqrt(A / pi)) (King 1987).
constexpr double kMoreOfSquare = 0.047;
// Tangents of the angle off lying, or standing, up to which a cylinder is known, and not at all.
constexpr double kCylinderKnown = 0.5;
constexpr double kCylinderOnRim = 0.8;
// Sides hang on each other. More: more exact; 12: to 1e-3.
constexpr int kRounds = 12;

// One way along the face that presses.
struct Side {
  double size = 0.0;         // m
  double slope = 0.0;        // how fast the face recedes from the surface that way (1)
  double round = 0.0;        // radius of a lying cylinder (m), else 0
  double touches = 0.0;      // m
  double only_part = 0.0;    // 1: it touches at an edge alone, 0: with all of the face
  double to_edge = 0.0;      // m: how far the face touches from its edge
  double mean_height = 0.0;  // m: over the pressure

  // `load`: force for each length of the other side (N/m) over the plane modulus: m. Beyond the
  // edge is the face beside, `thickness` (m) high.
  void press(double load, double thickness) {
    double asked = 0.0;
    if (round > 0.0) {
      asked = std::min(2.0 * round, 4.0 * std::sqrt(load * round / M_PI));
      only_part = 1.0;
      mean_height = touches * touches / (32.0 * round);
    } else {
      const double reach = slope > 0.0 ? load / slope : std::numeric_limits<double>::infinity();
      only_part = std::clamp(2.0 - reach / size, 0.0, 1.0);
      to_edge = std::min(size, reach);
      asked = to_edge + std::min(thickness, load * slope);
      // Tilted, but touching with all of it: the pressure is off its middle by pi a^2 / (4 reach),
      // a half the size (Johnson 1985).
      const double even = 0.5 * (1.0 - M_PI / 8.0 * size / reach) * size;
      mean_height = slope * (only_part * to_edge * kMeanUnderEdge + (1.0 - only_part) * even);
    }
    touches = std::sqrt(touches * asked);
  }

  // Tissue at a sharp edge comes to lie at the faces beside it, and the law with it to and fro.
  double known() const { return round > 0.0 ? 1.0 : 1.0 - only_part; }

  double spread() const {
    if (round > 0.0) return kUnderCylinder;
    return kUnderFlat + only_part * (kUnderEdge - kUnderFlat);
  }
};

struct Face {
  std::array<Side, 2> sides;
  double thickness = 0.0;  // m
  double disc = 0.0;       // radius of a cylinder's end (m), else 0
  double share = 1.0;
};

Face faceOf(const BoxOrCylinder& body, const Vec3& facing) {
  const Vec3 along = facing.cwiseAbs();
  Face face;
  if (body.radius > 0.0) {
    const double across = along.head<2>().norm(), tilt = std::min(across, along.z());
    const double off = tilt / std::max(across, along.z());
    face.share = std::clamp((kCylinderOnRim - off) / (kCylinderOnRim - kCylinderKnown), 0.0, 1.0);
    if (across > along.z()) {
      face.thickness = 2.0 * body.radius;
      face.sides[0].round = face.sides[0].size = body.radius;
      face.sides[1] = {2.0 * body.half_size.z(), off, 0.0};
    } else {
      face.thickness = 2.0 * body.half_size.z();
      face.disc = body.radius;
      face.sides[0] = {std::sqrt(M_PI) * body.radius, off, 0.0};
      face.sides[1] = {std::sqrt(M_PI) * body.radius, 0.0, 0.0};
    }
    return face;
  }
  std::array<int, 3> axes = {0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return along[a] > along[b]; });
  face.thickness = 2.0 * body.half_size[axes[0]];
  for (std::size_t side = 0; side < 2; ++side) {
    const int axis = axes[side + 1];
    face.sides[side] = {2.0 * body.half_size[axis], along[axis] / along[axes[0]], 0.0};
  }
  return face;
}

// Of a tilted disc only a segment touches, which is no longer than its chord.
double chord(double radius, double height) {
  return height < radius ? 2.0 * std::sqrt(height * (2.0 * radius - height)) : 2.0 * radius;
}

// Mean, under a force that is even along a strip.
double depthUnder(double load_of_all, double width, double length, double spread) {
  const double distance = 0.5 * width * spread / length, squared = width / length * width / length;
  const double even = std::asinh(1.0 / distance) - std::sqrt(1.0 + distance * distance) + distance;
  return 2.0 * load_of_all / (M_PI * length) * even * (1.0 + kMoreOfSquare * squared);
}

}  // namespace

Footprint footprintOf(const BoxOrCylinder& body, const Vec3& facing, double force,
                      double plane_modulus) {
  Face face = faceOf(body, facing);
  auto& [across, along] = face.sides;
  const double load = force / plane_modulus;  // m^2
  across.touches = across.size;
  along.touches = along.size;
  for (int round = 0; round < kRounds; ++round) {
    across.press(load / along.touches, face.thickness);
    along.press(load / across.touches, face.thickness);
    if (face.disc > 0.0) {
      along.touches = std::min(along.touches, chord(face.disc, across.touches));
    }
  }
  const bool is_across = across.touches < along.touches;
  const Side& narrow = is_across ? across : along;
  const Side& wide = is_across ? along : across;
  Footprint footprint;
  footprint.width = narrow.touches;
  footprint.depth = depthUnder(load, narrow.touches, wide.touches, narrow.spread());
  footprint.height = across.mean_height + along.mean_height;
  footprint.share = face.share * across.known() * along.known();
  return footprint;
}

}  // namespace robot_tissue
