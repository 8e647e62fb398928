#include "surface/smooth_carriers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace robot_tissue {
namespace {

// A node's weight (1) that is none. More: points beside a cell's side are carried by that side
// alone. Rounding.
constexpr double kNoWeight = 1e-9;

double cornerWeight(int corner, int axis, const Vec3& place) {
  return (corner >> axis & 1) != 0 ? place[axis] : 1.0 - place[axis];
}

// An edge of a cell along an axis, from its lower to its upper end.
struct CellEdge {
  int lower = 0, upper = 0;  // corners
  int axis = 0;
};

// How much the cells hold that have both of its ends, one beside the other (of h^3).
double shareAround(const CellSet& cells, const Cell& cell, const CellEdge& edge) {
  const int lower = cell.nodes[at(edge.lower)], upper = cell.nodes[at(edge.upper)];
  double share = 0.0;
  for (const CellSet::Meeting& met : cells.meetings(lower)) {
    const Cell& other = cells.all()[met.cell];
    const int corner = static_cast<int>(met.corner), end = corner | 1 << edge.axis;
    if (corner != end && other.nodes[at(end)] == upper) share += other.share();
  }
  return share;
}

// The nodes next to an end of it, away from the edge, each with how much that cell holds which has
// it next to the end.
std::vector<NodeWeight> beyond(const CellSet& cells, const Cell& cell, const CellEdge& edge,
                               bool is_lower) {
  const int end = cell.nodes[at(is_lower ? edge.lower : edge.upper)], bit = 1 << edge.axis;
  std::vector<NodeWeight> found;
  for (const CellSet::Meeting& met : cells.meetings(end)) {
    const Cell& other = cells.all()[met.cell];
    const int corner = static_cast<int>(met.corner);
    if (((corner & bit) != 0) != is_lower) continue;
    found.push_back({other.nodes[at(corner ^ bit)], other.share()});
  }
  return found;
}

double sumOf(const std::vector<NodeWeight>& shares) {
  return std::accumulate(shares.begin(), shares.end(), 0.0,
                         [](double sum, const NodeWeight& each) { return sum + each.weight; });
}

// u = ... + bend * q along the edge: of q of both ends.
void addBend(const CellSet& cells, const Cell& cell, const CellEdge& edge, double bend,
             std::vector<NodeWeight>& to) {
  const auto below = beyond(cells, cell, edge, true), above = beyond(cells, cell, edge, false);
  const double filled = std::max(shareAround(cells, cell, edge), sumOf(below) + sumOf(above));
  for (const bool is_lower : {true, false}) {
    for (const NodeWeight& next : is_lower ? below : above) {
      const double weight = bend * next.weight / filled;
      to.push_back({cell.nodes[at(is_lower ? edge.lower : edge.upper)], -2.0 * weight});
      to.push_back({cell.nodes[at(is_lower ? edge.upper : edge.lower)], weight});
      to.push_back({next.node, weight});
    }
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
    for (int r = 0; r < kFaceNodes; ++r) {
      const CellEdge edge{faceCorner(2 * axis, r), faceCorner(2 * axis + 1, r), axis};
      const double weight = cornerWeight(edge.lower, (axis + 1) % 3, place) *
                            cornerWeight(edge.lower, (axis + 2) % 3, place);
      if (weight > kNoWeight) addBend(cells, cell, edge, weight * bend, all);
    }
  }
  return summed(std::move(all));
}

}  // namespace robot_tissue
