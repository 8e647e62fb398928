#include "robot_tissue/core/surface.h"

#include <algorithm>
#include <limits>
#include <map>

#include "cutting/split_cells.h"

namespace robot_tissue {
namespace {

enum class Face { kOuter, kOpened };  // opened by a cut

// Corners of each face, counter-clockwise seen from outside; faces in the order -x +x -y +y -z +z.
constexpr int kFaceCorners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

struct Corner {
  int node = 0;               // of the lattice, that stands at the corner
  std::vector<int> carriers;  // the node itself, or the part's nodes nearest to it
  bool own = true;
  int ghost = kNone;  // that the part has in place of a lost node; of the lattice where a cut ends

  static constexpr int kNone = -1;
};

using CornerKey = std::vector<int>;  // node, ghost, carriers

CornerKey keyOf(const Corner& corner) {
  CornerKey key = {corner.node, corner.ghost};
  key.insert(key.end(), corner.carriers.begin(), corner.carriers.end());
  return key;
}

class SurfaceBuilder {
 public:
  SurfaceBuilder(const Lattice& lattice, const LatticeState& state)
      : lattice_(lattice), state_(state), vertex_of_node_(at(lattice.nodeCount()), -1) {}

  TissueSurface build() {
    for (const Cell& cell : lattice_.cells()) addCell(cell);
    for (const auto& [key, quad] : between_cells_) addQuad(quad, Face::kOpened);
    return std::move(surface_);
  }

 private:
  using Quad = std::array<Corner, 4>;
  using QuadKey = std::array<CornerKey, 4>;

  std::array<int, kCorners> partsOf(const Cell& cell) const {
    return cellParts(lattice_, state_, cell.nodes);
  }

  static bool isWhole(const std::array<int, kCorners>& parts) {
    return std::all_of(parts.begin(), parts.end(), [](int part) { return part == 0; });
  }

  void addCell(const Cell& cell) {
    const auto parts = partsOf(cell);
    for (int face = 0; face < 6; ++face) {
      auto index = lattice_.gridIndex(cell.nodes.front());
      index[at(face / 2)] += face % 2 == 1 ? 1 : -1;
      const int neighbor = lattice_.cellAt(index);
      const bool outside = neighbor < 0;
      if (!outside && isWhole(parts) && isWhole(partsOf(lattice_.cells()[at(neighbor)]))) continue;
      for (int part = 0; part < kCorners; ++part) {
        if (parts[at(part)] == part) addFace(cell, parts, part, face, outside);
      }
    }
  }

  void addFace(const Cell& cell, const std::array<int, kCorners>& parts, int part, int face,
               bool outside) {
    Quad quad;
    bool touches_part = false;
    for (int i = 0; i < 4; ++i) {
      quad[at(i)] = makeCorner(cell, parts, part, kFaceCorners[face][i]);
      touches_part = touches_part || quad[at(i)].own;
    }
    if (!touches_part) {
      addQuad(quad, Face::kOpened);  // where the cut runs through the cell
    } else if (outside) {
      addQuad(quad, Face::kOuter);
    } else {
      addBetweenCells(quad);
    }
  }

  // Two parts of neighboring cells that share a face hide it from each other.
  void addBetweenCells(const Quad& quad) {
    QuadKey key;
    for (int i = 0; i < 4; ++i) key[at(i)] = keyOf(quad[at(i)]);
    std::sort(key.begin(), key.end());
    const auto [place, is_new] = between_cells_.emplace(key, quad);
    if (!is_new) between_cells_.erase(place);
  }

  Corner makeCorner(const Cell& cell, const std::array<int, kCorners>& parts, int part,
                    int corner) const {
    const auto& nodes = cell.nodes;
    Corner made;
    made.node = nodes[at(corner)];
    made.own = parts[at(corner)] == part;
    if (made.own) {
      made.carriers = {made.node};
      return made;
    }
    if (const Cell* with_ghosts = state_.cells->owner(cell.place, part)) {
      made.ghost = with_ghosts->nodes[at(corner)];
    }
    for (int distance = 1; distance <= 3 && made.carriers.empty(); ++distance) {
      for (int other = 0; other < kCorners; ++other) {
        const int apart = corner ^ other;
        const int steps = (apart & 1) + (apart >> 1 & 1) + (apart >> 2 & 1);
        if (parts[at(other)] == part && steps == distance) {
          made.carriers.push_back(nodes[at(other)]);
        }
      }
    }
    return made;
  }

  // The diagonal joins the even nodes, so that the triangles are symmetric where the lattice is.
  void addQuad(const Quad& quad, Face face) {
    std::array<int, 4> vertices{};
    for (int i = 0; i < 4; ++i) vertices[at(i)] = vertex(quad[at(i)]);
    const auto index = lattice_.gridIndex(quad[0].node);
    const int first = (index[0] + index[1] + index[2]) % 2;
    for (const int start : {first, first + 2}) {
      surface_.triangles.push_back(
          {vertices[at(start % 4)], vertices[at((start + 1) % 4)], vertices[at((start + 2) % 4)]});
      surface_.opened.push_back(face == Face::kOpened ? 1 : 0);
    }
  }

  int vertex(const Corner& corner) {
    if (corner.own) {
      int& known = vertex_of_node_[at(corner.node)];
      if (known < 0) known = newVertex(corner);
      return known;
    }
    const CornerKey key = keyOf(corner);
    const auto known = lost_corners_.find(key);
    if (known != lost_corners_.end()) return known->second;
    return lost_corners_[key] = newVertex(corner);
  }

  int newVertex(const Corner& corner) {
    const double share = 1.0 / static_cast<double>(corner.carriers.size());
    const bool has_ghost = corner.ghost != Corner::kNone;
    Vec3 carriers_mean = Vec3::Zero();
    std::vector<NodeWeight> weights;
    for (const int carrier : corner.carriers) {
      weights.push_back({carrier, has_ghost ? 0.5 * share : share});
      carriers_mean += share * lattice_.restPosition(carrier);
    }
    if (has_ghost) weights.push_back({corner.ghost, 0.5});
    surface_.rest.push_back(corner.own
                                ? lattice_.restPosition(corner.node)
                                : 0.5 * (carriers_mean + lattice_.restPosition(corner.node)));
    surface_.carriers.push_back(std::move(weights));
    surface_.node.push_back(corner.carriers.size() == 1 ? corner.carriers.front() : -1);
    return static_cast<int>(surface_.rest.size()) - 1;
  }

  const Lattice& lattice_;
  const LatticeState& state_;
  TissueSurface surface_;
  std::vector<int> vertex_of_node_;
  std::map<CornerKey, int> lost_corners_;
  std::map<QuadKey, Quad> between_cells_;
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
    Vec3 position = surface.rest[vertex];
    for (const NodeWeight& carrier : surface.carriers[vertex]) {
      position += carrier.weight * displacement[at(carrier.node)];
    }
    vertices[vertex] = position;
    bounds.extend(position);
  }
  return bounds;
}

std::vector<NodeWeight> carriersAt(const TissueSurface& surface, const SurfacePoint& point) {
  std::map<int, double> weights;
  for (int corner = 0; corner < 3; ++corner) {
    const int vertex = surface.triangles[at(point.triangle)][at(corner)];
    for (const NodeWeight& carrier : surface.carriers[at(vertex)]) {
      weights[carrier.node] += point.barycentric[corner] * carrier.weight;
    }
  }
  std::vector<NodeWeight> carriers;
  for (const auto& [node, weight] : weights) {
    if (weight > 0.0) carriers.push_back({node, weight});
  }
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
