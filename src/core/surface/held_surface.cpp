#include "surface/held_surface.h"

#include <algorithm>
#include <array>
#include <map>

#include "robot_tissue/core/disjoint_sets.h"
#include "robot_tissue/core/triangle_point.h"
#include "surface/nearest_point.h"

namespace robot_tissue {
namespace {

// Of the radius (1): triangles are looked at in parts whose sides are no longer. More: weights that
// hang on the triangles; less: time, with its square. Chosen.
constexpr double kPart = 0.25;
// Times that a triangle's sides are halved for that, at most: a radius that asks for more is none,
// and before long sides are of rounding. More: smaller radii count. Chosen.
constexpr int kMostHalvings = 16;

// A part of a triangle: corners at rest, and where they are in the triangle.
struct Part {
  std::array<Vec3, 3> places;
  std::array<Vec3, 3> barycentric;

  double longestSide() const {
    return std::max({(places[1] - places[0]).norm(), (places[2] - places[1]).norm(),
                     (places[0] - places[2]).norm()});
  }
};

std::array<Part, 4> quarters(const Part& part) {
  const auto middles = [](const std::array<Vec3, 3>& corners) -> std::array<Vec3, 3> {
    return {0.5 * (corners[0] + corners[1]), 0.5 * (corners[1] + corners[2]),
            0.5 * (corners[2] + corners[0])};
  };
  const std::array<Vec3, 3> of_places = middles(part.places);
  const std::array<Vec3, 3> of_weights = middles(part.barycentric);
  std::array<Part, 4> all;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const std::size_t before = (corner + 2) % 3;
    all[corner] = {{part.places[corner], of_places[corner], of_places[before]},
                   {part.barycentric[corner], of_weights[corner], of_weights[before]}};
  }
  all[3] = {of_places, of_weights};
  return all;
}

class Holding {
 public:
  Holding(const TissueSurface& surface, const Vec3& center, double radius)
      : surface_(surface), center_(center), radius_(radius) {}

  void add(int triangle) {
    const MeshTriangle& corners = surface_.triangles[at(triangle)];
    Part whole{{}, {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}};
    for (std::size_t i = 0; i < 3; ++i) whole.places[i] = surface_.rest[at(corners[i])];
    add(corners, whole, kMostHalvings);
  }

  HeldSurface held() const {
    HeldSurface held;
    if (!(whole_ > 0.0)) return held;
    held.middle = center_ + moment_ / whole_;
    for (const auto& [node, weight] : weights_) {
      if (weight != 0.0) held.carriers.push_back({node, weight / whole_});
    }
    return held;
  }

 private:
  void add(const MeshTriangle& corners, const Part& part, int halvings) {
    const Vec3 middle = (part.places[0] + part.places[1] + part.places[2]) / 3.0;
    const double side = part.longestSide(), distance = (middle - center_).norm();
    if (side > kPart * radius_ && halvings > 0) {
      if (distance > radius_ + side) return;
      for (const Part& quarter : quarters(part)) add(corners, quarter, halvings - 1);
      return;
    }
    const double share = distance / radius_;
    if (share >= 1.0) return;
    const double weight = (1.0 - share * share) * doubleArea(part.places).norm();
    whole_ += weight;
    moment_ += weight * (middle - center_);
    for (std::size_t i = 0; i < 3; ++i) {
      const double of_corner = weight / 3.0 *
                               (part.barycentric[0] + part.barycentric[1] +
                                part.barycentric[2])[static_cast<Eigen::Index>(i)];
      for (const NodeWeight& carrier : surface_.carriers[at(corners[i])]) {
        weights_[carrier.node] += of_corner * carrier.weight;
      }
    }
  }

  const TissueSurface& surface_;
  Vec3 center_;
  double radius_;
  double whole_ = 0.0;
  Vec3 moment_ = Vec3::Zero();
  std::map<int, double> weights_;  // per node
};

}  // namespace

HeldSurface heldAround(const TissueSurface& surface, const SurfacePoint& point, double radius) {
  const Vec3 center = restOf(surface, point);
  std::vector<int> near;
  DisjointSets joined(static_cast<int>(surface.rest.size()));
  for (int triangle = 0; triangle < static_cast<int>(surface.triangles.size()); ++triangle) {
    if (!(nearestIn(surface, surface.rest, triangle, center).distance < radius)) continue;
    near.push_back(triangle);
    const MeshTriangle& corners = surface.triangles[at(triangle)];
    joined.join(corners[0], corners[1]);
    joined.join(corners[1], corners[2]);
  }
  const auto group = [&](int triangle) {
    return joined.lowest(surface.triangles[at(triangle)][0]);
  };
  Holding holding(surface, center, radius);
  for (const int triangle : near) {
    if (group(triangle) == group(point.triangle)) holding.add(triangle);
  }
  return holding.held();
}

}  // namespace robot_tissue
