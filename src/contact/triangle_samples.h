// Points of a triangle that are tested against a tool: its vertices, a regular grid on it, and the
// feet of the tool shapes' centers on it, so that what presses between the vertices is found.
// Edges of a closed surface are shared by two triangles: the one that runs through an edge from
// the lower to the higher vertex number samples it.
#pragma once

#include <array>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

constexpr int kMaxSubdivisions = 8;  // of an edge

// Weights of the triangle's point that is nearest to p; sum to 1.
Vec3 nearestInTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

// How densely triangles are sampled.
struct SampleGrid {
  double spacing = 0.0;        // greatest distance along an edge (m), as far as the maximum allows
  int least_subdivisions = 1;  // of an edge
};

// Barycentric coordinates of the sample points of a triangle, its vertices left out.
void sampleTriangle(const std::array<int, 3>& triangle, const std::vector<Vec3>& vertices,
                    const SampleGrid& grid, const std::vector<Vec3>& centers,
                    std::vector<Vec3>& samples);

}  // namespace robot_tissue
