// The shape as data: the surface with its pieces, the nodes as points.
#pragma once

#include <robot_tissue/Surface.h>
#include <sensor_msgs/PointCloud2.h>

#include <vector>

#include "robot_tissue/core/tissue.h"

namespace robot_tissue {

// The part of a message that changes with the topology alone: triangles and their pieces.
void setTriangles(const Tissue& tissue, const std::vector<int>& piece_of_node, Surface& message);
void setVertices(const Tissue& tissue, Surface& message);

// Points x, y, z of the deformed lattice (m), each with its displacement from rest ux, uy, uz (m)
// and its piece; in the order of the lattice's nodes. Header without stamp and frame.
sensor_msgs::PointCloud2 nodeCloud(const Tissue& tissue, const std::vector<int>& piece_of_node);

}  // namespace robot_tissue
