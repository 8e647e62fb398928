// A tree of boxes over the triangles of a closed surface: nearest point and inside or outside.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

using Corners = std::array<Vec3, 3>;

// Weights of the triangle's point that is nearest to p; sum to 1.
Vec3 nearestInTriangle(const Vec3& p, const Corners& corners);

class AabbTree {
 public:
  struct Nearest {
    int triangle = -1;
    Vec3 weights = Vec3::Zero();  // of its corners; 0 for those of the other edge or vertex
    Vec3 point = Vec3::Zero();
    double distance = 0.0;
  };

  // All vertices finite.
  AabbTree(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles);

  // The same triangles with their vertices elsewhere. Those with a corner that is not finite are
  // left out.
  void moveTo(const std::vector<Vec3>& vertices);

  // Nearest point of the surface, among those nearer than `reach`. As soon as one is found that is
  // not farther than `enough`, that one.
  std::optional<Nearest> nearest(const Vec3& point, double reach, double enough = 0.0) const;

  // Whether the surface goes around the point more often outwards than inwards: right also where it
  // crosses or touches itself. Counts the triangles that a ray meets; neighbors take the same side
  // of their edge (after Woop, Benthin, Wald 2013), so that none slips between them.
  bool isInside(const Vec3& point) const;

  // Triangles whose boxes are not farther than `margin` from the box around the corners.
  void collectNear(const Corners& corners, double margin, std::vector<int>& triangles) const;

  const Box& bounds() const { return nodes_.front().box; }  // empty (min > max) without triangles

 private:
  struct Entry {
    Corners corners;
    std::array<int, 3> vertices;
    int triangle;
  };
  struct Node {
    Box box;
    int first = 0;  // of a leaf: its first entry; else its second child, the first one follows
    int count = 0;  // entries of a leaf; 0: no leaf
  };

  struct Unsorted {
    Vec3 center;
    std::size_t triangle;
  };

  void build(std::size_t first, std::size_t end, const std::vector<MeshTriangle>& triangles,
             std::vector<Unsorted>& unsorted);

  std::vector<Entry> entries_;
  std::vector<Node> nodes_;  // the root first
};

}  // namespace robot_tissue
