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

// Barycentric coordinates of the sample points of a triangle, its vertices left out. `spacing`: the
// greatest distance along an edge between two samples (m), as far as kMaxSubdivisions allows.
void sampleTriangle(const std::array<int, 3>& triangle, const std::vector<Vec3>& vertices,
                    double spacing, const std::vector<Vec3>& centers, std::vector<Vec3>& samples);

}  // namespace robot_tissue
