#include "membrane/bending_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

#include "robot_tissue/core/disjoint_sets.h"

namespace robot_tissue {
namespace {

// Twice a part's area over the square of its longest edge (1, as `fullness` of a triangle, at most
// 0.87): thinner parts do not bend by themselves. A cut bar of 9,300 triangles under its weight,
// cycles: without this 1,543 in vain, 0.01 19, 0.05 18, 0.1 to 0.3 7. Up: the sheet's bending is
// told more coarsely.
constexpr double kThin = 0.1;

constexpr int kNone = -1;

// As its triangle goes around it.
struct SheetEdge {
  int from = 0, to = 0;  // vertices
  int triangle = 0;
  int beyond = kNone;  // the triangle that goes along it the other way
  double length = 0.0;
};

std::vector<SheetEdge> edgesOf(const std::vector<Vec3>& rest,
                               const std::vector<MeshTriangle>& sheet) {
  std::map<std::pair<int, int>, int> triangle_at;
  for (std::size_t triangle = 0; triangle < sheet.size(); ++triangle) {
    const MeshTriangle& corners = sheet[triangle];
    for (std::size_t i = 0; i < 3; ++i) {
      triangle_at[{corners[i], corners[(i + 1) % 3]}] = static_cast<int>(triangle);
    }
  }
  std::vector<SheetEdge> edges;
  for (const auto& [ends, triangle] : triangle_at) {
    const auto [from, to] = ends;
    const auto other = triangle_at.find({to, from});
    edges.push_back({from, to, triangle, other == triangle_at.end() ? kNone : other->second,
                     (rest[at(to)] - rest[at(from)]).norm()});
  }
  return edges;
}

class BendingParts {
 public:
  BendingParts(const std::vector<Vec3>& rest, const std::vector<MeshTriangle>& sheet)
      : rest_(rest), sheet_(sheet), edges_(edgesOf(rest, sheet)), parts_(sheet.size()) {
    while (joinThin()) {
    }
  }

  std::vector<std::array<int, 4>> edges() {
    std::vector<std::vector<int>> corners_of(sheet_.size());
    for (std::size_t triangle = 0; triangle < sheet_.size(); ++triangle) {
      std::vector<int>& corners = corners_of[at(partOf(static_cast<int>(triangle)))];
      corners.insert(corners.end(), sheet_[triangle].begin(), sheet_[triangle].end());
    }
    std::vector<std::array<int, 4>> found;
    for (const SheetEdge& edge : edges_) {
      if (edge.from > edge.to || !isBetweenParts(edge)) continue;
      found.push_back({edge.from, edge.to, farthest(edge, corners_of[at(partOf(edge.triangle))]),
                       farthest(edge, corners_of[at(partOf(edge.beyond))])});
    }
    return found;
  }

 private:
  // Which it is known by: a triangle of it.
  int partOf(int triangle) { return parts_.lowest(triangle); }
  bool isBetweenParts(const SheetEdge& edge) {
    return edge.beyond != kNone && partOf(edge.triangle) != partOf(edge.beyond);
  }

  // False: no part is thin that has a neighbor.
  bool joinThin() {
    std::vector<double> doubled_area(sheet_.size(), 0.0), longest(sheet_.size(), 0.0);
    std::vector<const SheetEdge*> to_next(sheet_.size(), nullptr);
    for (std::size_t triangle = 0; triangle < sheet_.size(); ++triangle) {
      doubled_area[at(partOf(static_cast<int>(triangle)))] +=
          doubleArea(rest_, sheet_[triangle]).norm();
    }
    for (const SheetEdge& edge : edges_) {
      const std::size_t part = at(partOf(edge.triangle));
      longest[part] = std::max(longest[part], edge.length);
      const SheetEdge*& next = to_next[part];
      if (isBetweenParts(edge) && (next == nullptr || edge.length > next->length)) next = &edge;
    }
    bool any = false;
    for (std::size_t part = 0; part < sheet_.size(); ++part) {
      const bool is_thin = doubled_area[part] < kThin * longest[part] * longest[part];
      if (!is_thin || to_next[part] == nullptr) continue;
      parts_.join(to_next[part]->triangle, to_next[part]->beyond);
      any = true;
    }
    return any;
  }

  // From the edge's line.
  int farthest(const SheetEdge& edge, const std::vector<int>& corners) const {
    const Vec3& from = rest_[at(edge.from)];
    const Vec3 along = rest_[at(edge.to)] - from;
    const auto distance = [&](int corner) {
      return along.cross(rest_[at(corner)] - from).squaredNorm();
    };
    return *std::max_element(corners.begin(), corners.end(),
                             [&](int a, int b) { return distance(a) < distance(b); });
  }

  const std::vector<Vec3>& rest_;
  const std::vector<MeshTriangle>& sheet_;
  std::vector<SheetEdge> edges_;  // by their ends
  DisjointSets parts_;            // of the triangles
};

}  // namespace

std::vector<std::array<int, 4>> bendingEdges(const std::vector<Vec3>& rest,
                                             const std::vector<MeshTriangle>& sheet) {
  return BendingParts(rest, sheet).edges();
}

}  // namespace robot_tissue
