// A strip clamped at one end that hangs under a small weight, wherever it stands in the grid: its
// deflection beyond a section, over that of Bernoulli's and Timoshenko's beam from there on.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "mesh_fixtures.h"
#include "robot_tissue/core/tissue.h"

namespace robot_tissue::bent_strip {

inline constexpr double kSpacing = 0.005, kYoung = 1e4, kNu = 0.3, kDensity = 1000.0;
inline constexpr double kWide = 3.3;         // h
inline constexpr double kBehind = 2.0;       // h, of the strip that is clamped
inline constexpr double kSection = 3.0;      // h, half of the piece that tells the section's turn
inline constexpr double kDeflection = 0.01;  // of the length, by the theory

struct Strip {
  double thickness, length;  // h
  double degrees;            // turned about y
  double rolled = 0.0;       // degrees, before that about its length
};

// Along x from -kBehind on, in the middle of y and z, then turned.
inline Pose placeOf(const Strip& strip) {
  Pose place = Pose::Identity();
  const auto turn = [](double degrees, const Vec3& axis) {
    return Eigen::AngleAxisd(degrees * M_PI / 180.0, axis);
  };
  place.linear() =
      (turn(strip.degrees, Vec3::UnitY()) * turn(strip.rolled, Vec3::UnitX())).toRotationMatrix();
  return place;
}

inline TriangleMesh meshOf(const Strip& strip) {
  const Vec3 half(0.0, 0.5 * kWide, 0.5 * strip.thickness);
  return moved(boxMesh(kSpacing * (Vec3(-kBehind, 0, 0) - half),
                       kSpacing * (Vec3(strip.length, 0, 0) + half)),
               placeOf(strip));
}

// Deflection at s of a cantilever of length L under a load q a length, over q: bending and shear.
inline double deflection(double s, double length, double bending, double shear) {
  return (s * s * s * s - 4.0 * length * s * s * s + 6.0 * length * length * s * s) /
             (24.0 * bending) +
         (length * s - 0.5 * s * s) / shear;
}

// How far the end is from the line through two places before it.
template <typename Deflection>
inline double beyondSection(const Strip& strip, Deflection of) {
  const double low = kSpacing * kSection, high = 3.0 * low, end = kSpacing * (strip.length - 1.0);
  const double low_moved = of(low), high_moved = of(high);
  return of(end) - (low_moved + (high_moved - low_moved) * (end - low) / (high - low));
}

// Trilinear, in the cell at the point (m).
inline Vec3 displacementAt(const Tissue& tissue, const Vec3& point) {
  const Lattice& lattice = tissue.lattice();
  const Vec3 from = (point - lattice.bounds().min()) / kSpacing;
  std::array<int, 3> low{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = static_cast<int>(std::floor(from[static_cast<int>(axis)]));
  }
  Vec3 sum = Vec3::Zero();
  double weights = 0.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    double weight = 1.0;
    std::array<int, 3> place = low;
    for (int axis = 0; axis < 3; ++axis) {
      const double along = from[axis] - low[at(axis)];
      const bool high = (corner >> axis & 1) != 0;
      weight *= high ? along : 1.0 - along;
      if (high) ++place[at(axis)];
    }
    const int node = lattice.node(place[0], place[1], place[2]);
    if (node < 0) continue;
    sum += weight * tissue.state().displacement[at(node)];
    weights += weight;
  }
  return sum / weights;
}

// Nodes behind the strip's clamped end are fixed one by one.
inline void clamp(const Strip& strip, TissueConfig& config) {
  const Pose to_strip = placeOf(strip).inverse();
  const Lattice free(config);
  const Vec3 slack = Vec3::Constant(1e-3 * kSpacing);
  for (int node = 0; node < free.nodeCount(); ++node) {
    const Vec3 rest = free.restPosition(node);
    const bool is_far = rest.y() > 10.0 * kSpacing;  // of the box that shifts the grid
    if (!is_far && (to_strip * rest).x() > 1e-6) continue;
    config.fixed.push_back({rest - slack, rest + slack});
  }
}

// The strip under a weight of q a length, along `pull` of its own axes.
inline TissueConfig hung(const Strip& strip, double q, const Vec3& pull, const Vec3& offset) {
  TissueConfig config;
  config.spacing = kSpacing;
  config.material.young_modulus = kYoung;
  config.material.poisson_ratio = kNu;
  config.material.density = kDensity;
  config.gravity =
      q / (kDensity * kSpacing * kSpacing * kWide * strip.thickness) * (placeOf(strip) * pull);
  // The grid is centered on the bounding box, which the far box moves.
  const TriangleMesh bar = meshOf(strip);
  const Box bounds = boundsOf(bar.vertices);
  const Vec3 far(bounds.min().x(), 20.3 * kSpacing, bounds.min().z());
  const Vec3 size = kSpacing * (Vec3::Constant(1.5) + offset);
  config.mesh = std::make_shared<const TriangleMesh>(
      joined(bar, moved(boxMesh(Vec3::Zero(), size),
                        Pose(Eigen::Translation3d(far - kSpacing * (Vec3(1, 0, 1) + offset))))));
  clamp(strip, config);
  return config;
}

struct Answer {
  double ratio;  // of the deflection to the theory's
  int cycles;
  bool ok;
};

inline SolverConfig solverOf(const std::string& method) {
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = 1e-4;
  return solver;
}

inline Answer bend(const Strip& strip, const std::string& method, const Vec3& offset) {
  const double thick = kSpacing * strip.thickness, wide = kSpacing * kWide;
  const double length = kSpacing * strip.length;
  const double bending = kYoung * wide * thick * thick * thick / 12.0;
  const double shear = 5.0 / 6.0 * kYoung / (2.0 * (1.0 + kNu)) * wide * thick;
  const auto theory = [&](double s) { return deflection(s, length, bending, shear); };
  const double q = kDeflection * length / theory(length);
  const Pose place = placeOf(strip);
  const Vec3 down = -place.linear().col(2);
  Tissue tissue(hung(strip, q, -Vec3::UnitZ(), offset), solverOf(method));
  const SolveReport report = tissue.settle();
  const double moved_by = beyondSection(
      strip, [&](double s) { return displacementAt(tissue, place * Vec3(s, 0.0, 0.0)).dot(down); });
  return {moved_by / (q * beyondSection(strip, theory)), report.iterations,
          report.status == SolveStatus::kOk};
}

// Hung along itself: how much longer its middle gets, over the theory's.
inline Answer stretch(const Strip& strip, const std::string& method, const Vec3& offset) {
  const double length = kSpacing * strip.length, low = 0.25 * length, high = 0.75 * length;
  const double firmness = kYoung * kSpacing * kSpacing * kWide * strip.thickness;  // E A
  const double q = 0.02 * kDeflection * firmness / length;
  const Pose place = placeOf(strip);
  Tissue tissue(hung(strip, q, Vec3::UnitX(), offset), solverOf(method));
  const SolveReport report = tissue.settle();
  const auto along = [&](double s) {  // over a piece, as cells there are not alike
    double sum = 0.0;
    for (int i = -4; i <= 4; ++i) {
      const Vec3 point = place * Vec3(s + 0.25 * i * kSpacing, 0.0, 0.0);
      sum += displacementAt(tissue, point).dot(place.linear().col(0)) / 9.0;
    }
    return sum;
  };
  const double expected = q / firmness * (length * (high - low) - 0.5 * (high * high - low * low));
  return {(along(high) - along(low)) / expected, report.iterations,
          report.status == SolveStatus::kOk};
}

}  // namespace robot_tissue::bent_strip
