#include "membrane/vertex_carriers.h"

#include <algorithm>
#include <utility>

#include "membrane/row_kernel.h"

namespace robot_tissue {

VertexCarriers::VertexCarriers(int carriers, const std::vector<Shares>& of_vertices)
    : carriers_(carriers) {
  for (const Shares& shares : of_vertices) add(shares);
  transpose();
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
  transpose();
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

void VertexCarriers::transpose() {
  first_carried_.assign(at(carriers_) + 1, 0);
  for (const Share& share : shares_) ++first_carried_[at(share.node) + 1];
  for (int carrier = 0; carrier < carriers_; ++carrier) {
    first_carried_[at(carrier) + 1] += first_carried_[at(carrier)];
  }
  carried_.resize(shares_.size());
  std::vector<int> next = first_carried_;
  for (int vertex = 0; vertex < vertices(); ++vertex) {
    for (const Share* share = begin(vertex); share != end(vertex); ++share) {
      carried_[at(next[at(share->node)]++)] = {vertex, share->weight};
    }
  }
}

double VertexCarriers::weight(int vertex, int carrier) const {
  const Share* found = std::find_if(
      begin(vertex), end(vertex), [carrier](const Share& share) { return share.node == carrier; });
  return found == end(vertex) ? 0.0 : found->weight;
}

std::vector<Vec3> VertexCarriers::toVertices(const std::vector<Vec3>& of_carriers) const {
  std::vector<Vec3> means(at(vertices()));
  sumShares(first_.data(), shares_.data(), vertices(), padded(of_carriers).data(), means.data());
  return means;
}

std::vector<Vec3> VertexCarriers::toCarriers(const std::vector<Vec3>& on_vertices) const {
  std::vector<Vec3> sums(at(carriers_));
  sumShares(first_carried_.data(), carried_.data(), carriers_, padded(on_vertices).data(),
            sums.data());
  return sums;
}

// Row by row of W^T (K W): what a vertex's row adds goes to the blocks of its carriers' rows.
NodeBlocks VertexCarriers::stiffness(const NodeBlocks& of_vertices) const {
  NodeBlocks product(0, {});
  std::vector<Eigen::Matrix3d> row(at(carriers_));
  std::vector<std::uint8_t> is_there(at(carriers_), 0);
  std::vector<int> columns;
  for (int carrier = 0; carrier < carriers_; ++carrier) {
    columns = {carrier};
    row[at(carrier)].setZero();
    is_there[at(carrier)] = 1;
    for (int k = first_carried_[at(carrier)]; k < first_carried_[at(carrier) + 1]; ++k) {
      const auto& [vertex, weight] = carried_[at(k)];
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

// Of both blocks of a pair of vertices at once, which are each other's transposes: the matrices are
// symmetric, and six numbers of each are summed.
std::vector<Eigen::Matrix3d> VertexCarriers::diagonal(const NodeBlocks& of_vertices) const {
  Numbers<double> sums(at(carriers_) * kPaddedSymmetric, 0.0);
  std::vector<double> own(at(carriers_), 0.0);  // weights of the vertex
  for (int vertex = 0; vertex < vertices(); ++vertex) {
    for (const Share* share = begin(vertex); share != end(vertex); ++share) {
      own[at(share->node)] = share->weight;
    }
    for (int i = of_vertices.place(vertex, vertex); i < of_vertices.last(vertex); ++i) {
      const int other = of_vertices.column(i);
      Eigen::Matrix3d both = of_vertices.block(i);
      if (other != vertex) both += of_vertices.block(i).transpose();
      addShared(both, own.data(), begin(other), end(other), sums.data());
    }
    for (const Share* share = begin(vertex); share != end(vertex); ++share) {
      own[at(share->node)] = 0.0;
    }
  }
  std::vector<Eigen::Matrix3d> diagonal(at(carriers_));
  for (int carrier = 0; carrier < carriers_; ++carrier) {
    const double* sum = sums.data() + kPaddedSymmetric * carrier;
    diagonal[at(carrier)] << sum[0], sum[5], sum[4], sum[5], sum[1], sum[3], sum[4], sum[3], sum[2];
  }
  return diagonal;
}

}  // namespace robot_tissue
