// What carries the vertices of a surface: x = X + W u, a row of weights per vertex (own). A
// stiffness K of vertices is one of what carries them, W^T K W, that need not be written out.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "membrane/node_blocks.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class VertexCarriers {
 public:
  using Share = NodeWeight;
  using Shares = std::vector<Share>;

  VertexCarriers() = default;
  VertexCarriers(int carriers, const std::vector<Shares>& of_vertices);
  // Where the carriers are carried themselves: W P, with the rows of P; no vertex moves with those
  // whose row is empty.
  VertexCarriers(const VertexCarriers& before, int carriers, const std::vector<Shares>& rows);

  int vertices() const { return static_cast<int>(first_.size()) - 1; }
  int carriers() const { return carriers_; }
  const Share* begin(int vertex) const { return shares_.data() + first_[at(vertex)]; }
  const Share* end(int vertex) const { return shares_.data() + first_[at(vertex) + 1]; }

  double weight(int vertex, int carrier) const;
  std::vector<Vec3> toVertices(const std::vector<Vec3>& of_carriers) const;  // W u
  std::vector<Vec3> toCarriers(const std::vector<Vec3>& on_vertices) const;  // W^T f
  // W^T K W, and its blocks on the diagonal.
  NodeBlocks stiffness(const NodeBlocks& of_vertices) const;
  std::vector<Eigen::Matrix3d> diagonal(const NodeBlocks& of_vertices) const;

 private:
  void add(Shares shares);
  void transpose();

  int carriers_ = 0;
  std::vector<int> first_ = {0};
  std::vector<Share> shares_;  // of a vertex by the node's number
  // By carriers: the vertices that they carry, ascending, with the same weights.
  std::vector<int> first_carried_;
  std::vector<Share> carried_;
};

}  // namespace robot_tissue
