// How walls that are thin against the spacing bend, wherever they stand in the grid: the table of
// doc/accuracy.md. A strip clamped at one end hangs under a small weight; its deflection beyond a
// section is compared with Bernoulli's and Timoshenko's beam from that section on.
//   thin_walls METHOD [PLACES]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "../core/mesh_fixtures.h"
#include "robot_tissue/core/tissue.h"

using namespace robot_tissue;

namespace {

constexpr double kSpacing = 0.005, kYoung = 1e4, kNu = 0.3, kDensity = 1000.0;
constexpr double kWide = 3.3;         // h
constexpr double kBehind = 2.0;       // h, of the strip that is clamped
constexpr double kSection = 3.0;      // h, half of the piece that tells the section's turn
constexpr double kDeflection = 0.01;  // of the length, by the theory

struct Strip {
  double thickness, length;  // h
  double degrees;            // turned about y
};

// Along x from -kBehind on, in the middle of y and z, then turned.
Pose placeOf(const Strip& strip) {
  Pose place = Pose::Identity();
  place.linear() =
      Eigen::AngleAxisd(strip.degrees * M_PI / 180.0, Vec3::UnitY()).toRotationMatrix();
  return place;
}

TriangleMesh meshOf(const Strip& strip) {
  const Vec3 half(0.0, 0.5 * kWide, 0.5 * strip.thickness);
  return moved(boxMesh(kSpacing * (Vec3(-kBehind, 0, 0) - half),
                       kSpacing * (Vec3(strip.length, 0, 0) + half)),
               placeOf(strip));
}

// Deflection at s of a cantilever of length L under a load q a length, over q: bending and shear.
double deflection(double s, double length, double bending, double shear) {
  return (s * s * s * s - 4.0 * length * s * s * s + 6.0 * length * length * s * s) /
             (24.0 * bending) +
         (length * s - 0.5 * s * s) / shear;
}

// How far the end is from the line through two places before it.
template <typename Deflection>
double beyondSection(const Strip& strip, Deflection of) {
  const double low = kSpacing * kSection, high = 3.0 * low, end = kSpacing * (strip.length - 1.0);
  const double low_moved = of(low), high_moved = of(high);
  return of(end) - (low_moved + (high_moved - low_moved) * (end - low) / (high - low));
}

// Trilinear, in the cell at the point (m).
Vec3 displacementAt(const Tissue& tissue, const Vec3& point) {
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
void clamp(const Strip& strip, TissueConfig& config) {
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

struct Answer {
  double ratio;  // of the deflection to the theory's
  int cycles;
  bool ok;
};

Answer bend(const Strip& strip, const std::string& method, const Vec3& offset) {
  const double thick = kSpacing * strip.thickness, wide = kSpacing * kWide;
  const double length = kSpacing * strip.length;
  const double bending = kYoung * wide * thick * thick * thick / 12.0;
  const double shear = 5.0 / 6.0 * kYoung / (2.0 * (1.0 + kNu)) * wide * thick;
  const auto theory = [&](double s) { return deflection(s, length, bending, shear); };
  TissueConfig config;
  config.spacing = kSpacing;
  config.material.young_modulus = kYoung;
  config.material.poisson_ratio = kNu;
  config.material.density = kDensity;
  const double q = kDeflection * length / theory(length);
  const Vec3 down = placeOf(strip).linear() * Vec3(0.0, 0.0, -1.0);
  config.gravity = q / (kDensity * wide * thick) * down;
  // The grid is centered on the bounding box, which the far box moves.
  const TriangleMesh bar = meshOf(strip);
  const Box bounds = boundsOf(bar.vertices);
  const Vec3 far(bounds.min().x(), 20.3 * kSpacing, bounds.min().z());
  const Vec3 size = kSpacing * (Vec3::Constant(1.5) + offset);
  config.mesh = std::make_shared<const TriangleMesh>(
      joined(bar, moved(boxMesh(Vec3::Zero(), size),
                        Pose(Eigen::Translation3d(far - kSpacing * (Vec3(1, 0, 1) + offset))))));
  clamp(strip, config);
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = 1e-4;
  Tissue tissue(config, solver);
  const SolveReport report = tissue.settle();
  const Pose place = placeOf(strip);
  const double moved_by = beyondSection(
      strip, [&](double s) { return displacementAt(tissue, place * Vec3(s, 0.0, 0.0)).dot(down); });
  return {moved_by / (q * beyondSection(strip, theory)), report.iterations,
          report.status == SolveStatus::kOk};
}

}  // namespace

int main(int argc, char** argv) {
  const std::string method = argc > 1 ? argv[1] : "newton";
  const int places = argc > 2 ? std::atoi(argv[2]) : 12;
  std::printf(
      "thickness_h,degrees,method,least,median,greatest,cycles_median,cycles_most,not_ok\n");
  for (const double degrees : {0.0, 22.0, 45.0}) {
    for (const double thickness : {0.5, 1.0, 2.5, 4.0}) {
      const Strip strip = {thickness, std::max(24.0, 10.0 * thickness), degrees};
      Random random;
      std::vector<double> ratios;
      std::vector<int> cycles;
      int not_ok = 0;
      for (int place = 0; place < places; ++place) {
        const Answer answer = bend(strip, method, random.offset(1.0));
        ratios.push_back(answer.ratio);
        cycles.push_back(answer.cycles);
        if (!answer.ok) ++not_ok;
      }
      std::sort(ratios.begin(), ratios.end());
      std::sort(cycles.begin(), cycles.end());
      std::printf("%g,%g,%s,%.3f,%.3f,%.3f,%d,%d,%d\n", thickness, degrees, method.c_str(),
                  ratios.front(), ratios[ratios.size() / 2], ratios.back(),
                  cycles[cycles.size() / 2], cycles.back(), not_ok);
      std::fflush(stdout);
    }
  }
}
