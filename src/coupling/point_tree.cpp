#include "point_tree.h"

#include <algorithm>
#include <cmath>

namespace robot_tissue {

PointTree::PointTree(std::vector<Entry> entries) {
  nodes_.reserve(entries.size());
  for (const Entry& entry : entries) nodes_.push_back({entry, 0});
  part(0, nodes_.size());
}

void PointTree::part(std::size_t begin, std::size_t end) {
  if (end - begin < 2) return;
  Box bounds;
  for (std::size_t i = begin; i < end; ++i) bounds.extend(nodes_[i].entry.point);
  Eigen::Index axis = 0;
  bounds.sizes().maxCoeff(&axis);
  const auto place = [&](std::size_t i) { return nodes_.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(place(begin), place(middle), place(end), [&](const Node& a, const Node& b) {
    return a.entry.point[axis] < b.entry.point[axis];
  });
  nodes_[middle].axis = static_cast<int>(axis);
  part(begin, middle);
  part(middle + 1, end);
}

std::optional<PointTree::Nearest> PointTree::nearest(const Vec3& point,
                                                     const Counts& counts) const {
  std::optional<Nearest> found;
  look(0, nodes_.size(), point, counts, found);
  return found;
}

void PointTree::look(std::size_t begin, std::size_t end, const Vec3& point, const Counts& counts,
                     std::optional<Nearest>& found) const {
  if (begin == end) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const Node& node = nodes_[middle];
  const double beyond = point[node.axis] - node.entry.point[node.axis];
  const bool after = beyond > 0.0;
  after ? look(middle + 1, end, point, counts, found) : look(begin, middle, point, counts, found);
  const Nearest here{(node.entry.point - point).norm(), node.entry.id};
  if ((!found || here.isBefore(*found)) && counts(node.entry)) found = here;
  if (found && std::abs(beyond) > found->off) return;
  after ? look(begin, middle, point, counts, found) : look(middle + 1, end, point, counts, found);
}

}  // namespace robot_tissue
