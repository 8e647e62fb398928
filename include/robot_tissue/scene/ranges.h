// The ranges of a scene's numbers, in one place. Wide enough for whatever a user may mean; what
// is beyond means nothing, and there no method comes to an end. Lengths go by the tissue's own.
#pragma once

#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/suture_ranges.h"
#include "robot_tissue/scene/entry.h"

namespace robot_tissue {
namespace ranges {

// Boxes that only pick nodes or cells may reach as far as they like.
inline Range pickedPlace() { return {-1e15, 1e15, "m"}; }
inline Range spacing() { return {1e-6, 1e3, "m"}; }
inline Range scale() { return {1e-9, 1e9, ""}; }
inline Range angle() { return {-1e4, 1e4, "rad"}; }
inline Range direction() { return {-1e6, 1e6, ""}; }

inline Range youngModulus() { return {1e-3, 1e13, "Pa"}; }
inline Range springStiffness() { return {1e-6, 1e12, "N/m"}; }
inline Range poissonRatio() { return {0.25, 0.49, ""}; }
inline Range membraneThickness() { return {1e-9, 1e3, "m"}; }
inline Range membranePoissonRatio() { return {0.0, 0.5, ""}; }
inline Range pressure() { return {-1e9, 1e9, "Pa"}; }
inline Range stiffening() { return {0.0, 1e3, ""}; }  // 0: neo-Hookean
inline Range density() { return {1e-3, 1e6, "kg/m^3"}; }
inline Range gravity() { return {-1e4, 1e4, "m/s^2"}; }
inline Range friction() { return {0.0, 1e3, ""}; }
inline Range force() { return {-1e9, 1e9, "N"}; }
inline Range forceLimit() { return {0.0, 1e9, "N"}; }  // 0: none

inline Range sutureStiffness() { return {kSoftestSuture, kStiffestSuture, "N/m"}; }
inline Range sutureStrength() { return {0.0, kStrongestSuture, "N"}; }  // 0: never breaks

inline Range dampingTime() { return {0.0, 1e3, "s"}; }
inline Range duration() { return {1e-6, 3600.0, "s"}; }  // of a step

constexpr std::size_t kMostCutCorners = 1000;  // of a polygon that cuts

inline Range resistance() { return {0.0, 1e9, "J/m^2"}; }
inline Range tearStretch() { return {0.0, 1e3, ""}; }  // 0: never

inline Range tolerance() { return {1e-9, 0.5, ""}; }
inline Range budget() { return {0.0, 1e9, "ms"}; }  // 0: none
constexpr int kMostIterations = 1000000;            // of a load step; from 0: any number

constexpr double kLeastTearStretch = 1.001;  // of one that is not 0

constexpr double kLeastForce = 1e-9;           // N, of one that is not zero
constexpr double kLeastGravity = 1e-6;         // m/s^2, likewise
constexpr double kLeastDirection = 1e-6;       // of a vector that has a direction
constexpr double kMostContrast = 1e6;          // of a region's stiffness and the tissue's
constexpr double kMostMembraneContrast = 1e7;  // of E t and the tissue's E h
// Pa: of a membrane of this thickness, on a tissue of this modulus and spacing.
inline double mostMembraneModulus(double young_modulus, double spacing, double thickness) {
  return kMostMembraneContrast * young_modulus * spacing / thickness;
}
constexpr double kFarthestCell = 1e6;  // spacings from the origin to the tissue's far end

}  // namespace ranges

// Of one tissue (m). A tool thinner than a thousandth of the spacing would be followed in steps
// that never end; one of ten thousand times the tissue's size is a plane to it.
struct LengthRanges {
  Range length;        // of what must have some
  Range gap;           // of what may be zero
  Range thread;        // of a suture, which may be zero
  Range place;         // a coordinate
  Range displacement;  // of a patch

  LengthRanges(const Box& tissue, double spacing);
};

LengthRanges lengthsOf(const TissueConfig& tissue);

// Zero, or as large as `least` at least.
Vec3 readVector(const Entry& entry, const Range& range, double least);
// Not zero: as large as `least` at least.
Vec3 readNonZero(const Entry& entry, const Range& range, double least);

}  // namespace robot_tissue
