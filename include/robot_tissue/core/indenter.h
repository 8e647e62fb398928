// A tool's shape as what it presses on sees it (own; doc/model.md, "Narrow contacts").
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/types.h"
#include "robot_tissue/core/vertex_triangles.h"

namespace robot_tissue {

// What of a shape is no higher over its lowest place than some level, as seen along the way it
// presses, does as a flat punch. It is as wide as the ellipse of its second moments, nearly.
struct PunchLevel {
  double give = 0.0;               // how far a half-space of E* = 1 Pa goes under 1 N on it (1/m)
  double height = 0.0;             // its mean one over the lowest place, under its pressure (m)
  Vec3 middle = Vec3::Zero();      // frame of the shape, as low as its lowest place (m)
  Vec3 long_axis = Vec3::Zero();   // half of it, likewise (m)
  Vec3 short_axis = Vec3::Zero();  // likewise
};

// How far a half-space of E* = 1 Pa goes under 1 N on a rigid ellipse of these half-axes (m), which
// stays level: K(e) / (pi a) (1/m; Johnson 1985, 4.2).
double giveOfEllipse(double longer, double shorter);

// What a shape faces the tissue with around one place.
struct IndenterPart {
  Vec3 lowest = Vec3::Zero();      // frame of the shape (m)
  std::vector<PunchLevel> levels;  // from low to high; none: it has no extent
  std::vector<int> triangles;      // of the shape
  Box bounds;                      // of these
};

class Indenter {
 public:
  Indenter() = default;
  // Closed triangles that face outwards, frame of the shape (m).
  explicit Indenter(TriangleMesh mesh);
  static Indenter ball(double radius);  // m; around the origin

  // Of the triangles that face this way (unit, frame of the shape) the one that is nearest to the
  // point (m); -1: none faces it. Of a ball 0.
  int nearestFacing(const Vec3& facing, const Vec3& point) const;
  // Those that hang together with that triangle, up to `up_to` (m) over it, and what they do
  // as flat punches up to that over the lowest of them.
  IndenterPart partAround(int triangle, const Vec3& facing, double up_to) const;
  // The place of the part that is nearest to a point, frame of the shape (m).
  Vec3 nearestOn(const IndenterPart& part, const Vec3& point) const;

 private:
  struct Nearest {
    int triangle = -1;
    Vec3 place = Vec3::Zero();  // m
    double square = kInfinity;  // of its distance (m^2)
  };

  void takeIfNearer(int triangle, const Vec3& point, Nearest& nearest) const;
  bool faces(int triangle, const Vec3& facing) const;
  std::array<Vec3, 3> cornersOf(int triangle) const;
  IndenterPart partOfBall(const Vec3& facing, double up_to) const;
  std::vector<int> hangingTogether(int triangle, const Vec3& facing, double up_to) const;

  double radius_ = 0.0;  // of a ball (m); 0: triangles
  TriangleMesh mesh_;
  std::vector<Vec3> areas_;  // per triangle: double, along its normal (m^2)
  VertexTriangles triangles_;
};

// A link's shape.
struct ToolIndenter {
  int shape = 0;  // number in its link
  Pose link_T_shape = Pose::Identity();
  std::shared_ptr<const Indenter> indenter;
};

}  // namespace robot_tissue
