// The vertices of a mesh in a grid of half spacings, and the points where its planes cut edges
// (own).
//
// Planes half way between nodes may be bent (bent_grid.h). So a point has a place, and straight
// coordinates, which the place would have if the planes were straight: which side of a plane it is
// on hangs on the latter. What is cut out of an edge hangs on the edge alone, whichever triangle
// asks: edges are cut by the planes of nodes first, along x, y, z, then by those between nodes.
#pragma once

#include <array>
#include <cstddef>
#include <unordered_map>
#include <vector>

#include "geometry/bent_grid.h"
#include "geometry/index_hash.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class MeshPoints {
 public:
  // Spacings (1): so near a plane a point is on it. More: what is thinner vanishes; less: edges of
  // no length, which have no direction. Chosen.
  static constexpr double kOnPlane = 1e-6;
  // Rounds of turns. More: finer ones are found; less: tips of a wound stand out of the skin.
  // Chosen.
  static constexpr int kMostTurns = 2;

  // `vertices` in spacings from the grid's lowest corner; `octants` of the grid along x, y, z. The
  // grid must outlive this.
  MeshPoints(std::vector<Vec3> vertices, const HalfIndex& octants, const BentGrid& grid);

  const Vec3& straight(int point) const { return straight_[at(point)]; }
  const Vec3& place(int point) const { return places_[at(point)]; }
  HalfIndex octantOf(const Vec3& straight) const;
  // Whether the point is above the plane; on it counts as above.
  bool isAbove(int point, int axis, int plane) const {
    return straight(point)[axis] >= 0.5 * plane;
  }

  int add(const Vec3& straight, const Vec3& place);
  int addMiddle(const std::vector<int>& points);
  // Where the edge, with one end above, meets the plane.
  int crossing(int from, int to, int axis, int plane);
  // Points between those where bent planes come and go along the edge, in order: of planes along
  // the axis `cut` and the next ones; it has been cut along those before.
  std::vector<int> turns(int from, int to, int cut);
  // All points that are cut out of an edge, in order, with its ends.
  std::vector<int> subdivided(int from, int to);

 private:
  double alongEdge(int from, int to, int axis, int plane) const;
  std::vector<int> crossingsBetween(int from, int to, int axis, bool at_nodes);
  std::vector<int> findTurns(int low, int high, int cut);
  Vec3 straightBetween(int low, int high, int cut, double share) const;
  bool isBeside(int from, int to) const;

  const BentGrid& grid_;
  HalfIndex octants_{};
  std::vector<Vec3> places_, straight_;
  template <std::size_t N, class Value>
  using Table = std::unordered_map<std::array<int, N>, Value, IndexHash>;
  Table<4, int> crossings_;           // edge's ends, axis, plane
  Table<3, std::vector<int>> turns_;  // edge's ends, axes cut
};

}  // namespace robot_tissue
