// A surface of triangles that cuts: what a blade's edge swept, or a polygon that is not flat.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// Where a spring crosses the surface.
struct Crossing {
  int spring = 0;
  double along = 0.5;         // from the spring's lower end, of its length
  Vec3 point = Vec3::Zero();  // of the deformed spring (m)
  double cosine = 0.0;        // between the deformed spring and the surface's normal, >= 0
};

class BladeSurface {
 public:
  using Corners = std::array<Vec3, 3>;  // m, tissue frame

  // Triangles without area cut nothing. The spacing (m) is the lattice's: what is nearer to the
  // outline than a thousandth of it is inside. Edges of two triangles, of the same corners to the
  // last bit, are no outline, and nothing slips through there.
  BladeSurface(const std::vector<Corners>& triangles, double spacing);

  // A simple closed polygon as triangles: round its centroid where all of it is seen from there,
  // along the mean normal, else by cutting off ears (Meisters 1975), as seen along it, too. One
  // that crosses itself as seen so: round its centroid.
  static BladeSurface of(const std::vector<Vec3>& corners, double spacing);

  const Box& bounds() const { return bounds_; }
  bool isEmpty() const { return triangles_.empty(); }
  // Of a segment from one point to the other (m); the first triangle that it crosses counts. The
  // surface counts as shifted by a thousandth of the spacing, always to the same side: a node on it
  // is on one side of it, whichever triangle looks, so that no spring is missed or cut twice. Where
  // the crossing is told without that shift, and may be beyond an end by it.
  std::optional<Crossing> crossing(const Vec3& from, const Vec3& to) const;
  struct Nearest {
    Vec3 point, normal;  // of the surface (m; unit)
  };
  // Without the shift; of a surface that has any area.
  Nearest nearestTo(const Vec3& point) const;
  // Of all springs that are not severed yet, in the deformed shape, in ascending order.
  std::vector<Crossing> crossings(const Lattice& lattice, const LatticeState& state) const;

 private:
  struct Triangle {
    Corners corners;
    std::array<double, 3> slack{};  // of its edges, each from the corner of its number on (m)
    Vec3 normal = Vec3::Zero();     // unit
    double shift = 0.0;             // along the normal (m)
    Box box;
  };

  double slack_;  // m
  std::vector<Triangle> triangles_;
  Box bounds_;
};

// New surface (m^2) where the blade crosses these springs: of each, its share of a cut across it,
// the spacing's square times the filled part of the four cells round it, times the cosine. So a
// plane through a block has the area of its section, however it is tilted.
double newSurface(const Lattice& lattice, const std::vector<Crossing>& crossings);

}  // namespace robot_tissue
