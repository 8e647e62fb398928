#include "membrane/vertex_carriers.h"

#include <algorithm>
#include <utility>

namespace robot_tissue {

VertexCarriers::VertexCarriers(int carriers, const std::vector<Shares>& of_vertices)
    : carriers_(carriers) {
  for (const Shares& shares : of_vertices) add(shares);
}

VertexCarriers::VertexCarriers(const VertexCarriers& before, int carriers,
                               const std::vector<Shares>& rows)
    : carriers_(carriers) {
  for (int vertex = 0; vertex < before.vertices(); ++vertex) {
    Shares shares;
    for (const Share* share = before.begin(vertex); share != before.end(vertex); ++share) {
      for (const Share& own : rows[at(share->node)]) {
        shares.push_back({own.node, share->weight * own.weight});
      }
    }
    add(std::move(shares));
  }
}

// What is of one carrier becomes one.
void VertexCarriers::add(Shares shares) {
  std::stable_sort(shares.begin(), shares.end(),
                   [](const Share& a, const Share& b) { return a.node < b.node; });
  const std::size_t begin = shares_.size();
  for (const Share& share : shares) {
    if (shares_.size() > begin && shares_.back().node == share.node) {
      shares_.back().weight += share.weight;
    } else {
      shares_.push_back(share);
    }
  }
  first_.push_back(static_cast<int>(shares_.size()));
}

double VertexCarriers::weight(int vertex, int carrier) const {
  const Share* found = std::find_if(
      begin(vertex), end(vertex), [carrier](const Share& share) { return share.node == carrier; });
  return found == end(vertex) ? 0.0 : found->weight;
}

Vec3 VertexCarriers::mean(int vertex, const std::vector<Vec3>& of_carriers) const {
  Vec3 mean = Vec3::Zero();
  for (const Share* share = begin(vertex); share != end(vertex); ++share) {
    mean += share->weight * of_carriers[at(share->node)];
  }
  return mean;
}

std::vector<Vec3> VertexCarriers::toVertices(const std::vector<Vec3>& of_carriers) const {
  std::vector<Vec3> means(at(vertices()));
  for (int vertex = 0; vertex < vertices(); ++vertex) {
    means[at(vertex)] = mean(vertex, of_carriers);
  }
  return means;
}

std::vector<Vec3> VertexCarriers::toCarriers(const std::vector<Vec3>& on_vertices) const {
  std::vector<Vec3> on_carriers(at(carriers_), Vec3::Zero());
  for (int vertex = 0; vertex < vertices(); ++vertex) {
    for (const Share* share = begin(vertex); share != end(vertex); ++share) {
      on_carriers[at(share->node)] += share->weight * on_vertices[at(vertex)];
    }
  }
  return on_carriers;
}

// Row by row of W^T (K W): what a vertex's row adds goes to the blocks of its carriers' rows.
NodeBlocks VertexCarriers::stiffness(const NodeBlocks& of_vertices) const {
  std::vector<std::vector<std::pair<int, double>>> vertices_of(at(carriers_));
  for (int vertex = 0; vertex < vertices(); ++vertex) {
    for (const Share* share = begin(vertex); share != end(vertex); ++share) {
      vertices_of[at(share->node)].emplace_back(vertex, share->weight);
    }
  }
  NodeBlocks product(0, {});
  std::vector<Eigen::Matrix3d> row(at(carriers_));
  std::vector<std::uint8_t> is_there(at(carriers_), 0);
  std::vector<int> columns;
  for (int carrier = 0; carrier < carriers_; ++carrier) {
    columns = {carrier};
    row[at(carrier)].setZero();
    is_there[at(carrier)] = 1;
    for (const auto& [vertex, weight] : vertices_of[at(carrier)]) {
      for (int i = of_vertices.first(vertex); i < of_vertices.last(vertex); ++i) {
        const int other = of_vertices.column(i);
        for (const Share* share = begin(other); share != end(other); ++share) {
          const std::size_t column = at(share->node);
          if (is_there[column] == 0) {
            is_there[column] = 1;
            row[column].setZero();
            columns.push_back(share->node);
          }
          row[column] += weight * share->weight * of_vertices.block(i);
        }
      }
    }
    std::sort(columns.begin(), columns.end());
    product.addRow(columns, row);
    for (const int column : columns) is_there[at(column)] = 0;
  }
  return product;
}

std::vector<Eigen::Matrix3d> VertexCarriers::diagonal(const NodeBlocks& of_vertices) const {
  std::vector<Eigen::Matrix3d> diagonal(at(carriers_), Eigen::Matrix3d::Zero());
  for (int vertex = 0; vertex < vertices(); ++vertex) {
    for (int i = of_vertices.first(vertex); i < of_vertices.last(vertex); ++i) {
      const int other = of_vertices.column(i);
      const Share* theirs = begin(other);
      for (const Share* share = begin(vertex); share != end(vertex); ++share) {
        while (theirs != end(other) && theirs->node < share->node) ++theirs;
        if (theirs == end(other)) break;
        if (theirs->node != share->node) continue;
        diagonal[at(share->node)] += share->weight * theirs->weight * of_vertices.block(i);
      }
    }
  }
  return diagonal;
}

}  // namespace robot_tissue
