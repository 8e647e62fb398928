#include "robot_tissue/ros/shape_messages.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>

namespace robot_tissue {
namespace {

float singleOf(double value) { return static_cast<float>(value); }

}  // namespace

// A vertex of a piece hangs on nodes of that piece alone.
void setTriangles(const Tissue& tissue, const std::vector<int>& piece_of_node, Surface& message) {
  const TissueSurface& surface = tissue.surface();
  message.triangles.clear();
  message.piece.clear();
  message.triangles.reserve(surface.triangles.size());
  message.piece.reserve(surface.triangles.size());
  for (const MeshTriangle& corners : surface.triangles) {
    shape_msgs::MeshTriangle triangle;
    std::transform(corners.begin(), corners.end(), triangle.vertex_indices.begin(),
                   [](int vertex) { return static_cast<std::uint32_t>(vertex); });
    message.triangles.push_back(triangle);
    const int node = surface.carriers[at(corners.front())].front().node;
    message.piece.push_back(static_cast<std::uint32_t>(piece_of_node[at(node)]));
  }
}

void setVertices(const Tissue& tissue, Surface& message) {
  message.vertices.resize(tissue.vertices().size());
  std::transform(tissue.vertices().begin(), tissue.vertices().end(), message.vertices.begin(),
                 [](const Vec3& place) {
                   geometry_msgs::Point32 vertex;
                   vertex.x = singleOf(place.x());
                   vertex.y = singleOf(place.y());
                   vertex.z = singleOf(place.z());
                   return vertex;
                 });
}

sensor_msgs::PointCloud2 nodeCloud(const Tissue& tissue, const std::vector<int>& piece_of_node) {
  using sensor_msgs::PointField;
  sensor_msgs::PointCloud2 cloud;
  cloud.height = 1;
  cloud.is_dense = 1;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(7, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                PointField::FLOAT32, "ux", 1, PointField::FLOAT32, "uy", 1,
                                PointField::FLOAT32, "uz", 1, PointField::FLOAT32, "piece", 1,
                                PointField::UINT32);
  const Lattice& lattice = tissue.lattice();
  std::vector<int> nodes;  // without those that were removed
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    if (piece_of_node[at(node)] >= 0) nodes.push_back(node);
  }
  modifier.resize(nodes.size());
  sensor_msgs::PointCloud2Iterator<float> number(cloud, "x");
  sensor_msgs::PointCloud2Iterator<std::uint32_t> piece(cloud, "piece");
  const std::vector<Vec3> shown = tissue.shownDisplacement();
  for (std::size_t i = 0; i < nodes.size(); ++i, ++number, ++piece) {
    const Vec3& moved = shown[at(nodes[i])];
    const Vec3 place = lattice.restPosition(nodes[i]) + moved;
    for (int axis = 0; axis < 3; ++axis) {
      number[axis] = singleOf(place[axis]);
      number[3 + axis] = singleOf(moved[axis]);
    }
    *piece = static_cast<std::uint32_t>(piece_of_node[at(nodes[i])]);
  }
  return cloud;
}

}  // namespace robot_tissue
