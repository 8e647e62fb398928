// Where the triangles of the tissue's surface were deepest in a mesh, to be followed as they move a
// little, as from round to round of a load step, and from load step to load step: looked for anew,
// each takes dozens of distances.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "collision_shape.h"
#include "triangle_minimum.h"

namespace robot_tissue {

class KnownMinima {
 public:
  // From now on all of them are looked for anew.
  void forget() { of_triangles_.clear(); }
  // What neither this search nor the one before it asked for is forgotten.
  void beginSearch();

  // As meshMinima, from the places that are known of the triangle, corners in the mesh's frame.
  // Nothing: none are known below this limit, or the triangle went too far since.
  std::optional<std::vector<TriangleMinimum>> follow(int triangle, const CollisionShape& shape,
                                                     const Corners& corners, double accuracy,
                                                     double limit);
  void note(int triangle, const Corners& corners, double limit,
            const std::vector<TriangleMinimum>& minima);

 private:
  struct Known {
    Corners corners;     // then (m)
    double limit = 0.0;  // m
    std::vector<TriangleMinimum> minima;
    std::uint64_t asked_in = 0;  // the last search that asked for it
  };

  std::unordered_map<int, Known> of_triangles_;
  std::uint64_t searches_ = 0;
};

}  // namespace robot_tissue
