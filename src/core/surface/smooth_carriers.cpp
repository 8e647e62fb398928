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

// u = ... + bend * q of that neighbor.
void addBend(const Cell& cell, const Cell& neighbor, int side, const Vec3& place, double bend,
             std::vector<NodeWeight>& to) {
  const int axis = side / 2;
  for (int r = 0; r < kFaceNodes; ++r) {
    const int near = faceCorner(side, r), far = faceCorner(side ^ 1, r);
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
    const Cell* const below = cells.across(cell, 2 * axis);
    const Cell* const above = cells.across(cell, 2 * axis + 1);
    CellReach reach;
    reach.weigh(axis, cell.share(), below == nullptr ? 0.0 : below->share(),
                above == nullptr ? 0.0 : above->share());
    for (const int side : {2 * axis, 2 * axis + 1}) {
      if (!reach.has(side)) continue;
      const Cell& neighbor = side % 2 == 0 ? *below : *above;
      addBend(cell, neighbor, side, place, reach.share[at(side)] * bend, all);
    }
  }
  return summed(std::move(all));
}

}  // namespace robot_tissue
