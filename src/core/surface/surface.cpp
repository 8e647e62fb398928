#include "robot_tissue/core/surface.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "surface/hinges.h"
#include "surface/octant_grid.h"

namespace robot_tissue {
namespace {

// A value for each point of the half grid.
template <typename Value>
class OnHalfGrid {
 public:
  OnHalfGrid(const std::array<int, 3>& size, Value all)
      : row_(at(2 * size[0])),
        plane_(row_ * at(2 * size[1])),
        values_(plane_ * at(2 * size[2]), all) {}

  Value& operator[](const HalfPoint& point) {
    return values_[at(point[0]) + row_ * at(point[1]) + plane_ * at(point[2])];
  }

 private:
  std::size_t row_, plane_;
  std::vector<Value> values_;
};

// Whole cells show whole sides; split ones, and what a removal left of cells, show the sides of
// their eighths. Where these meet, the whole sides get the points between their corners, too.
class SurfaceBuilder {
 public:
  SurfaceBuilder(const Lattice& lattice, const LatticeState& state)
      : lattice_(lattice),
        octants_(lattice, state),
        place_of_part_(octants_.partCount(), -1),
        vertices_at_(lattice.size(), -1),
        is_fine_(lattice.size(), 0) {}

  TissueSurface build() {
    for (const Cell& cell : lattice_.cells()) {
      for (int side = 0; side < 6; ++side) addSide(cell, side);
      if (octants_.isOpen(cell.place)) addInside(cell);
    }
    for (const WholeSide& whole : whole_sides_) addWhole(whole);
    separateHinges(octants_, std::move(owners_), std::move(places_), surface_);
    return std::move(surface_);
  }

 private:
  struct WholeSide {
    Octant octant;  // any of the cell's at the side
    HalfPoint lowest{};
    int side = 0;
    Face face = Face::kOuter;
  };

  std::array<Octant, 4> octantsAt(const Cell& cell, int side) const {
    std::array<Octant, 4> octants;
    std::size_t count = 0;
    for (int corner = 0; corner < kCorners; ++corner) {
      if ((corner >> side / 2 & 1) == side % 2) octants[count++] = {cell.place, corner};
    }
    return octants;
  }

  void addSide(const Cell& cell, int side) {
    auto index = lattice_.gridIndex(cell.nodes.front());
    index[at(side / 2)] += side % 2 == 1 ? 1 : -1;
    const int neighbor = octants_.cellAt(index);
    const bool is_whole = !octants_.isOpen(cell.place);
    if (neighbor >= 0 && is_whole && !octants_.isOpen(neighbor)) return;
    const Face face = neighbor < 0 ? Face::kOuter : Face::kOpened;
    const std::array<Octant, 4> octants = octantsAt(cell, side);
    const auto is_bare = [&](const Octant& octant) {
      return !octants_.isThere({neighbor, octant.corner ^ 1 << side / 2});
    };
    if (is_whole && std::all_of(octants.begin(), octants.end(), is_bare)) {
      whole_sides_.push_back({octants[0], octants_.lowestOf({cell.place, 0}), side, face});
      return;
    }
    for (const Octant& octant : octants) {
      if (octants_.isThere(octant) && is_bare(octant)) addEighth(octant, side, face);
    }
  }

  // Where a cut runs through the cell, or a removal ends in it.
  void addInside(const Cell& cell) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const Octant octant = {cell.place, corner};
      if (!octants_.isThere(octant)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const int side = 2 * axis + (1 - (corner >> axis & 1));
        if (!octants_.isJoined(octant, side)) addEighth(octant, side, Face::kOpened);
      }
    }
  }

  // The diagonal begins at the node's corner of the side: symmetric where the lattice is.
  void addEighth(const Octant& octant, int side, Face face) {
    const auto corners = cornersOfSide(octants_.lowestOf(octant), side, 1);
    std::array<int, 4> vertices{};
    std::size_t first = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      vertices[i] = vertex(octant, corners[i]);
      int odd = 0;
      for (int axis = 0; axis < 3; ++axis) {
        if (axis != side / 2) odd += corners[i][at(axis)] & 1;
      }
      if (odd == 0) first = i;
      if (isBetweenNodes(corners[i])) is_fine_[corners[i]] = 1;
    }
    for (const std::size_t start : {first, first + 2}) {
      add({vertices[start % 4], vertices[(start + 1) % 4], vertices[(start + 2) % 4]}, octant,
          face);
    }
  }

  static bool isBetweenNodes(const HalfPoint& point) {
    return (point[0] & 1) + (point[1] & 1) + (point[2] & 1) == 1;
  }

  // The diagonal joins the even nodes, so that the triangles are symmetric where the lattice is.
  void addWhole(const WholeSide& whole) {
    const auto corners = cornersOfSide(whole.lowest, whole.side, 2);
    std::vector<int> outline;
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfPoint& from = corners[i];
      const HalfPoint& to = corners[(i + 1) % 4];
      outline.push_back(vertex(whole.octant, from));
      const HalfPoint middle = {(from[0] + to[0]) / 2, (from[1] + to[1]) / 2,
                                (from[2] + to[2]) / 2};
      if (is_fine_[middle] != 0) outline.push_back(vertex(whole.octant, middle));
    }
    if (outline.size() == 4) {
      const std::size_t first =
          (corners[0][0] + corners[0][1] + corners[0][2]) / 2 % 2 == 0 ? 0 : 1;
      for (const std::size_t start : {first, first + 2}) {
        add({outline[start % 4], outline[(start + 1) % 4], outline[(start + 2) % 4]}, whole.octant,
            whole.face);
      }
      return;
    }
    HalfPoint middle{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      middle[axis] = (corners[0][axis] + corners[2][axis]) / 2;
    const int center = vertex(whole.octant, middle);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      add({center, outline[i], outline[(i + 1) % outline.size()]}, whole.octant, whole.face);
    }
  }

  void add(const MeshTriangle& triangle, const Octant& owner, Face face) {
    surface_.triangles.push_back(triangle);
    surface_.opened.push_back(face == Face::kOpened ? 1 : 0);
    owners_.push_back(owner);
  }

  // Where the point hangs on the same nodes it is the same vertex.
  int vertex(const Octant& octant, const HalfPoint& point) {
    if (!octants_.isOpen(octant.cell)) return vertexAt(octant, point);
    int& known = vertexOfPart(octant, point);
    if (known < 0) return known = vertexAt(octant, point);
    const bool is_node = (point[0] & 1) + (point[1] & 1) + (point[2] & 1) == 0;
    if (!is_node) standBeside(octants_.nodeOf(octant), known);
    return known;
  }

  // -1: it was not asked for.
  int& vertexOfPart(const Octant& octant, const HalfPoint& point) {
    int& place = place_of_part_[at(octants_.partOf(octant))];
    if (place < 0) {
      place = static_cast<int>(vertices_of_parts_.size());
      vertices_of_parts_.emplace_back().fill(-1);
    }
    const CellPoint in_cell = octants_.inCell(octant.cell, point);
    return vertices_of_parts_[at(place)][at(in_cell[0] + 3 * in_cell[1] + 9 * in_cell[2])];
  }

  void standBeside(int node, int vertex) {
    int& known = surface_.node[at(vertex)];
    if (known != node) known = -1;
  }

  int vertexAt(const Octant& octant, const HalfPoint& point) {
    const Hold hold = octants_.holdOf(octant, point);
    const int next = static_cast<int>(surface_.rest.size());
    int& last_there = vertices_at_[point];
    const int first_there = last_there;
    for (int vertex = first_there; vertex >= 0; vertex = next_there_[at(vertex)]) {
      if (!holdTheSame(holds_[at(vertex)], hold)) continue;
      if (hold.count > 1) standBeside(octants_.nodeOf(octant), vertex);
      return vertex;
    }
    last_there = next;
    next_there_.push_back(first_there);
    holds_.push_back(hold);
    surface_.rest.push_back(octants_.placeOf(octant, point));
    places_.push_back(Vec3(point[0], point[1], point[2]));
    octants_.addCarriers(hold, surface_.carriers);
    surface_.node.push_back(hold.count > 1 ? octants_.nodeOf(octant) : hold.begin()->node);
    return next;
  }

  const Lattice& lattice_;
  OctantGrid octants_;
  TissueSurface surface_;
  std::vector<Octant> owners_;  // per triangle
  std::vector<Vec3> places_;    // per vertex, in the half grid
  std::vector<WholeSide> whole_sides_;
  std::vector<Hold> holds_;                             // per vertex
  std::vector<int> place_of_part_;                      // of an open cell, in the next; -1: not yet
  std::vector<std::array<int, 27>> vertices_of_parts_;  // by CellPoint, x running fastest
  OnHalfGrid<int> vertices_at_;                         // the last one made there
  std::vector<int> next_there_;                         // per vertex; -1: none
  OnHalfGrid<char> is_fine_;                            // in the middle of springs
};

}  // namespace

TissueSurface extractSurface(const Lattice& lattice, const LatticeState& state) {
  return SurfaceBuilder(lattice, state).build();
}

Box deform(const TissueSurface& surface, const std::vector<Vec3>& displacement,
           std::vector<Vec3>& vertices) {
  vertices.resize(surface.rest.size());
  Box bounds;
  for (std::size_t vertex = 0; vertex < surface.rest.size(); ++vertex) {
    vertices[vertex] = carriedFrom(surface.rest[vertex], surface.carriers[vertex], displacement);
    bounds.extend(vertices[vertex]);
  }
  return bounds;
}

std::vector<NodeWeight> carriersAt(const TissueSurface& surface, const SurfacePoint& point) {
  std::vector<NodeWeight> carriers;
  const auto isBefore = [](const NodeWeight& carrier, int node) { return carrier.node < node; };
  for (int corner = 0; corner < 3; ++corner) {
    const double share = point.barycentric[corner];
    if (share == 0.0) continue;
    const int vertex = surface.triangles[at(point.triangle)][at(corner)];
    for (const auto& [node, weight] : surface.carriers[at(vertex)]) {
      const auto place = std::lower_bound(carriers.begin(), carriers.end(), node, isBefore);
      if (place != carriers.end() && place->node == node) {
        place->weight += share * weight;
      } else {
        carriers.insert(place, {node, share * weight});
      }
    }
  }
  const auto isNone = [](const NodeWeight& carrier) { return carrier.weight == 0.0; };
  carriers.erase(std::remove_if(carriers.begin(), carriers.end(), isNone), carriers.end());
  return carriers;
}

int vertexAt(const TissueSurface& surface, const SurfacePoint& point) {
  // Barycentric (1): a point that is off a corner by less is that vertex. Less: points rounded by
  // the search for contacts are none. Chosen.
  constexpr double kOff = 1e-6;
  Eigen::Index corner = 0;
  if (point.barycentric.maxCoeff(&corner) <= 1.0 - kOff) return -1;
  return surface.triangles[at(point.triangle)][at(static_cast<int>(corner))];
}

double enclosedVolume(const TissueSurface& surface, const std::vector<Vec3>& vertices) {
  return enclosedVolume(vertices, surface.triangles);
}

}  // namespace robot_tissue
