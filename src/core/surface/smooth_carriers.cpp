#include "surface/smooth_carriers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace robot_tissue {
namespace {

// A node's weight (1) that is none. More: points beside a cell's side are carried by that side
// alone. Rounding.
constexpr double kNoWeight = 1e-9;

double cornerWeight(int corner, int axis, const Vec3& place) {
  return (corner >> axis & 1) != 0 ? place[axis] : 1.0 - place[axis];
}

// u = ... + bend * q along the axis.
void addBend(const Cell& cell, const Cell& neighbor, int axis, int side, const Vec3& place,
             double bend, std::vector<NodeWeight>& to) {
  for (int r = 0; r < kFaceNodes; ++r) {
    const int near = faceCorner(axis, side, r), far = faceCorner(axis, -side, r);
    const double weight = bend * cornerWeight(near, (axis + 1) % 3, place) *
                          cornerWeight(near, (axis + 2) % 3, place);
    to.push_back({cell.nodes[at(near)], -2.0 * weight});
    to.push_back({cell.nodes[at(far)], weight});
    to.push_back({neighbor.nodes[at(near)], weight});
  }
}

// Each node once, without those that have no weight.
std::vector<NodeWeight> summed(std::vector<NodeWeight> all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const NodeWeight& a, const NodeWeight& b) { return a.node < b.node; });
  std::vector<NodeWeight> sums;
  double whole = 0.0;
  for (auto next = all.begin(); next != all.end();) {
    NodeWeight sum{next->node, 0.0};
    for (; next != all.end() && next->node == sum.node; ++next) sum.weight += next->weight;
    if (std::abs(sum.weight) <= kNoWeight) continue;
    sums.push_back(sum);
    whole += sum.weight;
  }
  for (NodeWeight& sum : sums) sum.weight /= whole;
  return sums;
}

}  // namespace

Hold trilinearCarriers(const Cell& cell, const Vec3& place) {
  Hold hold;
  double sum = 0.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) weight *= cornerWeight(corner, axis, place);
    if (weight <= kNoWeight) continue;
    hold.add(cell.nodes[at(corner)], weight);
    sum += weight;
  }
  for (int i = 0; i < hold.count; ++i) hold.carriers[at(i)].weight /= sum;
  return hold;
}

std::vector<NodeWeight> smoothCarriers(const CellSet& cells, const Cell& cell, const Vec3& place) {
  const Hold straight = trilinearCarriers(cell, place);
  std::vector<NodeWeight> all(straight.begin(), straight.end());
  for (int axis = 0; axis < 3; ++axis) {
    const double bend = 0.5 * place[axis] * (place[axis] - 1.0);
    if (std::abs(bend) <= kNoWeight) continue;
    const std::array<const Cell*, 2> neighbors = {cells.across(cell, axis, -1),
                                                  cells.across(cell, axis, 1)};
    double filled = 0.0;
    for (const Cell* neighbor : neighbors) filled += neighbor == nullptr ? 0.0 : neighbor->share();
    filled = std::max(filled, cell.share());
    for (const int side : {-1, 1}) {
      const Cell* neighbor = neighbors[side < 0 ? 0 : 1];
      if (neighbor == nullptr) continue;
      addBend(cell, *neighbor, axis, side, place, neighbor->share() / filled * bend, all);
    }
  }
  return summed(std::move(all));
}

}  // namespace robot_tissue
