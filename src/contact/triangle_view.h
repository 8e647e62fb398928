// A mesh as seen from a triangle: how high its vertices are over the triangle's plane, and how far
// beyond its edges.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "robot_tissue/core/triangle_point.h"
#include "tool_mesh.h"
#include "triangle_minimum.h"
#include "tuning.h"

namespace robot_tissue {

// The triangle's plane: height over it, and weights of points in it.
class TrianglePlane {
 public:
  explicit TrianglePlane(const Corners& corners) : origin_(corners[0]) {
    const Vec3 ab = corners[1] - corners[0];
    const Vec3 ac = corners[2] - corners[0];
    const Vec3 area = ab.cross(ac);
    normal_ = area.normalized();
    to_b_ = ac.cross(area) / area.squaredNorm();
    to_c_ = area.cross(ab) / area.squaredNorm();
    for (std::size_t k = 0; k < 3; ++k) {
      start_[k] = corners[k];
      const Vec3 edge = corners[(k + 1) % 3] - corners[k];
      outwards_[k] = edge.cross(normal_).stableNormalized();
      along_[k] = edge / edge.squaredNorm();
      slack_[k] = tuning::kSquare * longestEdge(corners) * edge.norm() / area.norm();
    }
  }
  double height(const Vec3& point) const { return normal_.dot(point - origin_); }
  Vec3 weights(const Vec3& point) const {
    const double b = to_b_.dot(point - origin_);
    const double c = to_c_.dot(point - origin_);
    return {1.0 - b - c, b, c};
  }
  // How far a point is beyond the line of the edge from corner k to the next (m); < 0: on the
  // triangle's side.
  double beyond(std::size_t k, const Vec3& point) const {
    return outwards_[k].dot(point - start_[k]);
  }
  // Where along that edge a point is: 0 at its first corner, 1 at its second.
  double along(std::size_t k, const Vec3& point) const { return along_[k].dot(point - start_[k]); }
  // A point that is farther on the triangle's side than this of its distance to the edge is nearer
  // to the triangle than to the edge (leadsAway).
  double slack(std::size_t k) const { return slack_[k]; }

 private:
  Vec3 origin_, normal_, to_b_, to_c_;
  std::array<Vec3, 3> start_, outwards_, along_;
  std::array<double, 3> slack_{};
};

// Where a point is, as seen from the triangle.
struct SeenFrom {
  double height = 0.0;  // m
  unsigned sides = 0;   // those of Side that it is on
};

// To which sides a point lies off the part of space that is looked at: all points of a segment or a
// face lie there if all its ends do.
enum Side : unsigned {
  kAbove = 1U,
  kBelow = 2U,
  kBeyondFirst = 4U,
  kInsideFirst = 32U,
  kBeforeFirst = 256U,
  kAfterFirst = 2048U
};
constexpr unsigned kBeyondAny = 7U * kBeyondFirst;
// Beyond the edge from corner k, and inside of it so far that no nearest point is on it.
constexpr unsigned beyondEdge(std::size_t k) { return kBeyondFirst << k; }
constexpr unsigned insideEdge(std::size_t k) { return kInsideFirst << k; }
// Before the edge's first corner, and after its second: surely, as they are nowhere on it.
constexpr unsigned beforeEdge(std::size_t k) { return kBeforeFirst << k; }
constexpr unsigned afterEdge(std::size_t k) { return kAfterFirst << k; }

// The mesh's vertices as seen from one triangle: each is looked at once, however many faces and
// edges have it.
class SeenVertices {
 public:
  // What is looked at reaches so far (m) from the triangle.
  void begin(const ToolMesh& mesh, const TrianglePlane& plane, double reach) {
    mesh_ = &mesh;
    plane_ = &plane;
    reach_ = reach;
    for (std::size_t k = 0; k < 3; ++k) {
      inside_[k] = -std::min(reach, 2.0 * plane.slack(k) * reach + tuning::kRounding);
    }
    seen_.resize(std::max(seen_.size(), mesh.vertices().size()));
    ++round_;
  }
  const SeenFrom& operator[](int vertex) {
    Seen& seen = seen_[at(vertex)];
    if (std::exchange(seen.round, round_) == round_) return seen.from;
    return seen.from = look(mesh_->vertices()[at(vertex)]);
  }

 private:
  SeenFrom look(const Vec3& point) const {
    SeenFrom from;
    from.height = plane_->height(point);
    from.sides = (from.height > reach_ ? kAbove : 0U) | (from.height < -reach_ ? kBelow : 0U);
    for (std::size_t k = 0; k < 3; ++k) {
      const double beyond = plane_->beyond(k, point);
      from.sides |= (beyond > reach_ ? beyondEdge(k) : 0U);
      from.sides |= (beyond < inside_[k] ? insideEdge(k) : 0U);
      const double along = plane_->along(k, point);
      from.sides |= (along < -tuning::kSurelyOffEdge ? beforeEdge(k) : 0U);
      from.sides |= (along > 1.0 + tuning::kSurelyOffEdge ? afterEdge(k) : 0U);
    }
    return from;
  }

  struct Seen {
    std::uint64_t round = 0;
    SeenFrom from;
  };

  const ToolMesh* mesh_ = nullptr;
  const TrianglePlane* plane_ = nullptr;
  double reach_ = 0.0;
  std::array<double, 3> inside_{};  // m: as TrianglePlane::beyond
  std::vector<Seen> seen_;
  std::uint64_t round_ = 0;
};

// Numbers in the order in which they are first named; emptied by begin() without a pass over its
// array.
class Firsts {
 public:
  void begin(std::size_t count) {
    if (named_in_.size() < count) named_in_.resize(count, 0);
    ++round_;
    all_.clear();
  }
  void add(int number) {
    if (std::exchange(named_in_[at(number)], round_) != round_) all_.push_back(number);
  }
  const std::vector<int>& all() const { return all_; }

 private:
  std::vector<std::uint64_t> named_in_;
  std::uint64_t round_ = 0;
  std::vector<int> all_;
};

}  // namespace robot_tissue
