#include "surface/cut_mesh_surface.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "geometry/index_hash.h"
#include "geometry/mesh_pieces.h"
#include "surface/cell_parts.h"
#include "surface/cut_region.h"
#include "surface/divided_grid.h"
#include "surface/hinges.h"
#include "surface/merged_skin.h"
#include "surface/mesh_surface.h"
#include "surface/octant_grid.h"
#include "surface/smooth_carriers.h"

namespace robot_tissue {
namespace {

// Spacings (1): so near a line of straight coordinates a point is on it. Rounding.
constexpr double kOnDiagonal = 1e-9;

constexpr int kNotLookedFor = -2;  // a cell; -1: none

class CutMeshBuilder {
 public:
  CutMeshBuilder(const Lattice& lattice, const LatticeState& state, const TriangleMesh& mesh)
      : lattice_(lattice),
        state_(state),
        parts_(lattice, state),
        mesh_(mesh),
        grid_(lattice, state),
        pieces_(inSpacings(), cells(), grid_),
        region_(lattice, parts_) {}

  TissueSurface build() {
    for (std::size_t number = 0; number < mesh_.triangles.size(); ++number) {
      const MeshTriangle& triangle = mesh_.triangles[number];
      const bool near = isNear(triangle);
      pieces_.add(triangle, static_cast<int>(number), near);
      if (!near) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        cut_edges_.insert(edgeOf(triangle[i], triangle[(i + 1) % 3]));
      }
    }
    for (std::size_t number = 0; number < mesh_.triangles.size(); ++number) {
      mesh_triangle_ = static_cast<int>(number);
      if (!isNear(mesh_.triangles[number])) addWhole(mesh_.triangles[number]);
    }
    for (const MeshPieces::Piece& piece : pieces_.pieces()) {
      if (isRemoved(piece.octant)) continue;
      mesh_triangle_ = piece.triangle;
      for (std::size_t i = 1; i + 1 < piece.outline.size(); ++i) {
        add({piece.outline[0], piece.outline[i], piece.outline[i + 1]}, piece.octant, Face::kOuter);
      }
    }
    mesh_triangle_ = -1;
    for (const HalfIndex& octant : region_.octants()) {
      for (int axis = 0; axis < 3; ++axis) addLids(octant, axis);
    }
    std::vector<int> mesh_triangles;
    for (const int part_of : separateHinges(OctantGrid(lattice_, state_), std::move(owners_),
                                            std::move(places_), surface_)) {
      mesh_triangles.push_back(mesh_triangle_of_[at(part_of)]);
    }
    is_of_mesh_.resize(surface_.rest.size(), 1);
    return mergedSkin(surface_, mesh_triangles, is_of_mesh_);
  }

 private:
  std::array<int, 3> cells() const {
    const auto& size = lattice_.size();
    return {size[0] - 1, size[1] - 1, size[2] - 1};
  }

  static std::array<int, 2> edgeOf(int from, int to) {
    return {std::min(from, to), std::max(from, to)};
  }

  std::vector<Vec3> inSpacings() const {
    std::vector<Vec3> points;
    for (const Vec3& vertex : mesh_.vertices) {
      points.push_back((vertex - lattice_.bounds().min()) / lattice_.spacing());
    }
    return points;
  }

  // Its box reaches into the region.
  bool isNear(const MeshTriangle& triangle) const {
    HalfIndex low = pieces_.octantOf(pieces_.straight(triangle[0]));
    HalfIndex high = low;
    for (const int vertex : triangle) {
      const HalfIndex octant = pieces_.octantOf(pieces_.straight(vertex));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], octant[axis]);
        high[axis] = std::max(high[axis], octant[axis]);
      }
    }
    return region_.reachesInto(low, high);
  }

  // A triangle off the region, with the points that a neighbor's edges were cut at.
  void addWhole(const MeshTriangle& triangle) {
    std::vector<int> outline;
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = triangle[i], to = triangle[(i + 1) % 3];
      std::vector<int> points = {from, to};
      if (cut_edges_.count(edgeOf(from, to)) != 0) points = pieces_.subdivided(from, to);
      outline.insert(outline.end(), points.begin(), points.end() - 1);
    }
    if (outline.size() == 3) return addPlain({outline[0], outline[1], outline[2]});
    const int middle = pieces_.addMiddle(outline);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      addPlain({middle, outline[i], outline[(i + 1) % outline.size()]});
    }
  }

  // Off the region a vertex hangs on whole cells, whatever its octant.
  void addPlain(const MeshTriangle& triangle) {
    MeshTriangle corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = vertex(triangle[i], pieces_.octantOf(pieces_.straight(triangle[i])));
    }
    surface_.triangles.push_back(corners);
    surface_.opened.push_back(0);
    mesh_triangle_of_.push_back(mesh_triangle_);
    owners_.push_back(octantAt(pieces_.octantOf(pieces_.straight(triangle[0]))));
  }

  void add(const MeshTriangle& triangle, const HalfIndex& octant, Face face) {
    MeshTriangle corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = vertex(triangle[i], octant);
    surface_.triangles.push_back(corners);
    surface_.opened.push_back(face == Face::kOpened ? 1 : 0);
    mesh_triangle_of_.push_back(mesh_triangle_);
    owners_.push_back(octantAt(octant));
  }

  Octant octantAt(const HalfIndex& octant) {
    const int cell = region_.cellOf(octant);
    return {cell, cell < 0 ? 0 : region_.cornerOf(cell, octant)};
  }

  // On the octant's upper face along the axis, one for each side. A fan from the middle has the
  // given border, whatever its shape.
  void addLids(const HalfIndex& octant, int axis) {
    HalfIndex upper = octant;
    if (++upper[at(axis)] >= 2 * cells()[at(axis)]) return;  // beyond there is none
    const bool below = !isRemoved(octant), above = !isRemoved(upper);
    if ((!below && !above) || areOfOnePart(octant, upper)) return;
    for (const std::vector<int>& loop : pieces_.lid(octant, axis)) {
      const bool parted = !below || !above || std::any_of(loop.begin(), loop.end(), [&](int point) {
        return nodesOf(holdOf(point, octant)) != nodesOf(holdOf(point, upper));
      });
      if (!parted) continue;
      const int middle = pieces_.addMiddle(aroundMiddle(loop, octant, axis));
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const int from = loop[i], to = loop[(i + 1) % loop.size()];
        if (below) add({middle, from, to}, octant, Face::kOpened);
        if (above) add({middle, to, from}, upper, Face::kOpened);
      }
    }
  }

  // The lid is two flat facets that meet along the line from the node's corner of the face to the
  // opposite one. Where its border is on both sides of that, the points on it; else all.
  std::vector<int> aroundMiddle(const std::vector<int>& border, const HalfIndex& octant,
                                int axis) const {
    const std::size_t u = at((axis + 1) % 3), v = at((axis + 2) % 3);
    std::vector<int> on_line;
    bool is_before = false, is_beyond = false;
    for (const int vertex : border) {
      const Vec3& point = pieces_.straight(vertex);
      const auto from_node = [&](std::size_t along) {
        const int node = (octant[along] + 1) / 2;
        return std::abs(point[static_cast<Eigen::Index>(along)] - node);
      };
      const double side = from_node(u) - from_node(v);
      if (std::abs(side) < kOnDiagonal) on_line.push_back(vertex);
      is_before = is_before || side < -kOnDiagonal;
      is_beyond = is_beyond || side > kOnDiagonal;
    }
    return is_before && is_beyond && on_line.size() > 1 ? on_line : border;
  }

  int cellAroundPoint(int point) {
    if (at(point) >= cell_around_.size()) cell_around_.resize(at(point) + 1, kNotLookedFor);
    int& cell = cell_around_[at(point)];
    if (cell == kNotLookedFor) cell = cellAround(lattice_, pieces_.place(point));
    return cell;
  }

  bool isRemoved(const HalfIndex& octant) {
    const int cell = region_.cellOf(octant);
    return cell >= 0 && parts_.owner(cell, region_.cornerOf(cell, octant)) == nullptr;
  }

  bool areOfOnePart(const HalfIndex& a, const HalfIndex& b) {
    const int cell = region_.cellOf(a);
    if (cell < 0 || cell != region_.cellOf(b)) return false;
    return parts_.owner(cell, region_.cornerOf(cell, a)) ==
           parts_.owner(cell, region_.cornerOf(cell, b));
  }

  // The cell, or part of one, that a point is in, as the material in the octant has it.
  const Cell& partAround(int point, const HalfIndex& octant) {
    int cell = region_.cellOf(octant);
    if (cell < 0 || !parts_.isOpen(cell)) {
      const int around = cellAroundPoint(point);  // whichever octant asks
      if (cell < 0 || !parts_.isOpen(around)) cell = around;
    }
    return *parts_.owner(cell, region_.cornerOf(cell, octant));
  }

  Vec3 placeIn(const Cell& part, int point) const {
    return robot_tissue::placeIn(lattice_, part, pieces_.place(point));
  }

  Hold holdOf(int point, const HalfIndex& octant) {
    const Cell& part = partAround(point, octant);
    return trilinearCarriers(part, placeIn(part, point));
  }

  using Nodes = std::array<int, kCorners>;  // ascending, the first ones -1 where there are fewer
  static Nodes nodesOf(const Hold& hold) {
    Nodes nodes{};
    nodes.fill(-1);
    std::transform(hold.begin(), hold.end(), nodes.begin(),
                   [](const NodeWeight& carrier) { return carrier.node; });
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }

  // The surface's vertex for a point. Where it hangs on the same nodes it is the same.
  int vertex(int point, const HalfIndex& octant) {
    const Cell& part = partAround(point, octant);
    const Vec3 place = placeIn(part, point);
    std::array<int, 1 + kCorners> key{point};
    const Nodes nodes = nodesOf(trilinearCarriers(part, place));
    std::copy(nodes.begin(), nodes.end(), key.begin() + 1);
    const auto [known, is_new] = vertices_.try_emplace(key, 0);
    if (is_new) {
      known->second = static_cast<int>(surface_.rest.size());
      const bool is_of_mesh = point < static_cast<int>(mesh_.vertices.size());
      surface_.rest.push_back(is_of_mesh ? mesh_.vertices[at(point)]
                                         : placed(pieces_.place(point)));
      is_of_mesh_.push_back(is_of_mesh ? 1 : 0);
      places_.push_back(2.0 * pieces_.straight(point));
      const std::vector<NodeWeight> carriers = smoothCarriers(parts_.cells(), part, place);
      parts_.addCarriers({carriers.data(), carriers.data() + carriers.size()}, surface_.carriers);
      surface_.node.push_back(-1);
    }
    return known->second;
  }

  Vec3 placed(const Vec3& point) const {
    return lattice_.bounds().min() + lattice_.spacing() * point;
  }

  const Lattice& lattice_;
  const LatticeState& state_;
  CellParts parts_;
  const TriangleMesh& mesh_;
  DividedGrid grid_;
  MeshPieces pieces_;
  std::vector<int> cell_around_;  // of the points up to the last that was asked for
  CutRegion region_;
  std::unordered_set<std::array<int, 2>, IndexHash> cut_edges_;
  std::unordered_map<std::array<int, 1 + kCorners>, int, IndexHash> vertices_;  // point, its nodes
  TissueSurface surface_;
  int mesh_triangle_ = -1;             // that what is added is part of; -1: a cut opened it
  std::vector<int> mesh_triangle_of_;  // the same per triangle
  std::vector<char> is_of_mesh_;       // per vertex
  std::vector<Octant> owners_;         // per triangle
  std::vector<Vec3> places_;           // per vertex, in half spacings
};

}  // namespace

TissueSurface cutMeshSurface(const Lattice& lattice, const LatticeState& state,
                             const TriangleMesh& mesh) {
  return CutMeshBuilder(lattice, state, mesh).build();
}

}  // namespace robot_tissue
