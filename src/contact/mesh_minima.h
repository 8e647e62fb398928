// Where on a triangle the signed distance to a mesh is least: one place for each part of the mesh
// that comes through the triangle or near it (own).
#pragma once

#include <optional>
#include <vector>

#include "collision_shape.h"
#include "mesh_seeds.h"
#include "triangle_minimum.h"

namespace robot_tissue {

// Local least distances below `limit` (m), the least first; corners in the frame of the shape,
// which is a mesh. In: the mesh's faces that are nearer than the limit and the padding, ascending;
// the distance of the first corner (m), where it is known.
std::vector<TriangleMinimum> meshMinima(MeshSeeds& seeds, const CollisionShape& shape,
                                        const Corners& corners, const std::vector<int>& faces,
                                        double accuracy, double limit,
                                        std::optional<double> at_first_corner = std::nullopt);

// Adds a place to those that were found on a triangle: of places that are one contact the deepest
// stays.
void keepApart(const TriangleMinimum& found, const Corners& corners,
               std::vector<TriangleMinimum>& minima);

}  // namespace robot_tissue
