#include "surface/hinges.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "robot_tissue/core/disjoint_sets.h"

namespace robot_tissue {
namespace {

// Where a triangle has an edge: 3 * triangle + the corner that the edge begins at.
using EdgePlace = int;

// Every pass splits all but edges of one triangle: more than a few are never needed. Chosen.
constexpr int kMostPasses = 16;
// Half spacings (1): a vertex that is nearer to a line of the half grid is on it. Rounding.
constexpr double kOnLine = 1e-6;

struct Edge {
  int low = 0, high = 0;  // vertices
  EdgePlace place = 0;

  bool joinsAs(const Edge& other) const { return low == other.low && high == other.high; }
  bool operator<(const Edge& other) const {
    return std::tie(low, high, place) < std::tie(other.low, other.high, other.place);
  }
};

class HingeSeparator {
 public:
  HingeSeparator(const OctantGrid& octants, std::vector<Octant> owners, std::vector<Vec3> places,
                 TissueSurface& surface)
      : octants_(octants),
        owners_(std::move(owners)),
        places_(std::move(places)),
        surface_(surface),
        part_of_(surface.triangles.size()),
        fans_(3 * surface.triangles.size()) {
    std::iota(part_of_.begin(), part_of_.end(), 0);
  }

  std::vector<int> run() {
    separateFans();
    return std::move(part_of_);
  }

 private:
  void separateFans() {
    findEdges();
    const bool has_hinges = hasHinges();
    forAll([this](const std::vector<EdgePlace>& places) { joinAlong(places); });
    separate();
    if (!has_hinges) return;
    findEdges();
    for (int passes = 0; hasHinges() && passes < kMostPasses; ++passes) {
      if (!splitEdges()) return;
      findEdges();
    }
  }

  // Ascending; by their lower ends first, of which each has few.
  void findEdges() {
    const int triangles = static_cast<int>(surface_.triangles.size());
    std::vector<int> ends(surface_.rest.size() + 1, 0);
    const auto edge_at = [this](EdgePlace place) -> Edge {
      const int from = vertexAt(place / 3, place % 3), to = vertexAt(place / 3, (place + 1) % 3);
      return {std::min(from, to), std::max(from, to), place};
    };
    for (EdgePlace place = 0; place < 3 * triangles; ++place) ++ends[at(edge_at(place).low + 1)];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    edges_.resize(at(3 * triangles));
    for (EdgePlace place = 0; place < 3 * triangles; ++place) {
      const Edge edge = edge_at(place);
      edges_[at(ends[at(edge.low)]++)] = edge;
    }
    auto first = edges_.begin();
    for (std::size_t vertex = 0; vertex < surface_.rest.size(); ++vertex) {
      const auto end = edges_.begin() + ends[vertex];
      std::sort(first, end);
      first = end;
    }
  }

  bool hasHinges() const {
    for (std::size_t i = 2; i < edges_.size(); ++i) {
      if (edges_[i].joinsAs(edges_[i - 2])) return true;
    }
    return false;
  }

  // Calls with the places of each edge.
  template <class Call>
  void forAll(const Call& call) const {
    std::vector<EdgePlace> places;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      places.push_back(edges_[i].place);
      if (i + 1 < edges_.size() && edges_[i].joinsAs(edges_[i + 1])) continue;
      call(places);
      places.clear();
    }
  }

  int vertexAt(int triangle, int corner) const {
    return surface_.triangles[at(triangle)][at(corner)];
  }

  // Corners of triangles that meet along an edge are of one fan at both its ends.
  void join(EdgePlace a, EdgePlace b) {
    for (const int a_end : {0, 1}) {
      for (const int b_end : {0, 1}) {
        const int one = 3 * (a / 3) + (a % 3 + a_end) % 3;
        const int other = 3 * (b / 3) + (b % 3 + b_end) % 3;
        if (vertexAt(one / 3, one % 3) == vertexAt(other / 3, other % 3)) fans_.join(one, other);
      }
    }
  }

  void joinAlong(const std::vector<EdgePlace>& places) {
    if (places.size() == 2) return join(places[0], places[1]);
    const std::vector<int> wedge_of = wedgesOf(places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (wedge_of[i] == wedge_of[j]) join(places[i], places[j]);
      }
    }
  }

  // Each has two triangles: where the skin touches itself, more are of one and the same material.
  std::vector<int> wedgesOf(const std::vector<EdgePlace>& places) {
    std::vector<int> wedge_of = materialOf(places);
    // More than there are octants around a point, or owners of these triangles.
    const int apart = kCorners + static_cast<int>(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      int before = 0;  // that run along the edge the same way
      for (std::size_t j = 0; j < i; ++j) {
        const bool is_same =
            wedge_of[j] % apart == wedge_of[i] && startOf(places[j]) == startOf(places[i]);
        before += is_same ? 1 : 0;
      }
      wedge_of[i] += apart * before;
    }
    return wedge_of;
  }

  int startOf(EdgePlace place) const { return vertexAt(place / 3, place % 3); }

  // An edge inside the side of an octant has that octant on one side of it, another one beyond.
  std::vector<int> materialOf(const std::vector<EdgePlace>& places) {
    if (isPoint(places[0])) return wedgesAtPoint(places);
    if (!findAround(places[0])) return ownersOf(places);
    const std::array<int, 4> wedge = wedgesAround();
    std::vector<int> wedge_of;
    for (const EdgePlace place : places) wedge_of.push_back(wedge[numberAmong(around_, place)]);
    return wedge_of;
  }

  // Each by the first of the triangles that it owns.
  std::vector<int> ownersOf(const std::vector<EdgePlace>& places) const {
    std::vector<int> owner_of;
    for (const EdgePlace place : places) {
      const auto is_of_same = [&](EdgePlace other) {
        return owners_[at(other / 3)] == owners_[at(place / 3)];
      };
      const auto first = std::find_if(places.begin(), places.end(), is_of_same);
      owner_of.push_back(static_cast<int>(first - places.begin()));
    }
    return owner_of;
  }

  // Has no length, as where a mesh passes through a point of the half grid.
  bool isPoint(EdgePlace place) const {
    const Vec3& a = places_[at(vertexAt(place / 3, place % 3))];
    const Vec3& b = places_[at(vertexAt(place / 3, (place % 3 + 1) % 3))];
    return (a - b).cwiseAbs().maxCoeff() < kOnLine;
  }

  // Octants around the point that are joined over their sides are of one wedge.
  std::vector<int> wedgesAtPoint(const std::vector<EdgePlace>& places) const {
    const std::array<Octant, 8> around =
        aroundPoint(places_[at(vertexAt(places[0] / 3, places[0] % 3))]);
    DisjointSets sets(8);
    for (int i = 0; i < 8; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const int beyond = i | 1 << axis;
        const Octant &one = around[at(i)], &other = around[at(beyond)];
        const bool is_same = one == other;
        if (is_same || (octants_.isThere(one) && octants_.isJoined(one, 2 * axis + 1))) {
          sets.join(i, beyond);
        }
      }
    }
    std::vector<int> wedge_of;
    for (const EdgePlace place : places) {
      wedge_of.push_back(sets.lowest(static_cast<int>(numberAmong(around, place))));
    }
    return wedge_of;
  }

  // The lower bit for x; the same one on both sides of a plane that the point is not on.
  std::array<Octant, 8> aroundPoint(const Vec3& point) const {
    std::array<Octant, 8> around;
    for (int i = 0; i < 8; ++i) {
      HalfPoint lowest{};
      for (int axis = 0; axis < 3; ++axis) {
        const double nearest = std::round(point[axis]);
        const bool is_on_plane = std::abs(point[axis] - nearest) < kOnLine;
        lowest[at(axis)] = static_cast<int>(is_on_plane ? nearest - 1.0 + (i >> axis & 1)
                                                        : std::floor(point[axis]));
      }
      around[at(i)] = octants_.octantAt(lowest);
    }
    return around;
  }

  // The four octants around the edge, one after the other; of a longer edge around its middle.
  // False where it runs along none of the half grid's lines.
  bool findAround(EdgePlace place) {
    const Vec3& a = places_[at(vertexAt(place / 3, place % 3))];
    const Vec3& b = places_[at(vertexAt(place / 3, (place % 3 + 1) % 3))];
    Eigen::Index along = 0;
    (a - b).cwiseAbs().maxCoeff(&along);
    along_ = static_cast<int>(along);
    HalfPoint lowest{};
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = 0.5 * (a[axis] + b[axis]), nearest = std::round(middle);
      lowest[at(axis)] = static_cast<int>(axis == along_ ? std::floor(middle - kOnLine) : nearest);
      const bool is_on_line =
          std::abs(a[axis] - nearest) < kOnLine && std::abs(b[axis] - nearest) < kOnLine;
      if (axis != along_ && !is_on_line) return false;
    }
    const std::size_t u = at((along_ + 1) % 3), v = at((along_ + 2) % 3);
    constexpr int kTurn[4][2] = {{0, 0}, {-1, 0}, {-1, -1}, {0, -1}};
    for (std::size_t i = 0; i < 4; ++i) {
      HalfPoint at_turn = lowest;
      at_turn[u] += kTurn[i][0];
      at_turn[v] += kTurn[i][1];
      around_[i] = octants_.octantAt(at_turn);
    }
    return true;
  }

  // Octants that are joined over the sides around the edge are of one wedge.
  std::array<int, 4> wedgesAround() const {
    const int u = (along_ + 1) % 3, v = (along_ + 2) % 3;
    const int side_to_next[4] = {2 * u, 2 * v, 2 * u + 1, 2 * v + 1};
    DisjointSets sets(4);
    for (int i = 0; i < 4; ++i) {
      const Octant& octant = around_[at(i)];
      if (octants_.isThere(octant) && octants_.isJoined(octant, side_to_next[i])) {
        sets.join(i, (i + 1) % 4);
      }
    }
    std::array<int, 4> wedges{};
    for (int i = 0; i < 4; ++i) wedges[at(i)] = sets.lowest(i);
    return wedges;
  }

  // Which of the octants the triangle is of, or its cell has.
  template <std::size_t N>
  std::size_t numberAmong(const std::array<Octant, N>& around, EdgePlace place) const {
    const Octant& owner = owners_[at(place / 3)];
    for (std::size_t i = 0; i < N; ++i) {
      if (around[i] == owner) return i;
    }
    for (std::size_t i = 0; i < N; ++i) {
      if (around[i].cell == owner.cell && !octants_.isOpen(owner.cell)) return i;
    }
    return 0;
  }

  // The first fan at a vertex keeps it, others get copies.
  void separate() {
    std::vector<int> fan_of(surface_.rest.size(), -1);
    std::unordered_map<int, int> copies;  // per fan
    for (int place = 0; place < static_cast<int>(3 * surface_.triangles.size()); ++place) {
      int& vertex = surface_.triangles[at(place / 3)][at(place % 3)];
      const int fan = fans_.lowest(place);
      int& first = fan_of[at(vertex)];
      if (first < 0) first = fan;
      if (first == fan) continue;
      const auto [copy, is_new] = copies.try_emplace(fan, static_cast<int>(surface_.rest.size()));
      if (is_new) {
        places_.push_back(Vec3(places_[at(vertex)]));
        surface_.rest.push_back(Vec3(surface_.rest[at(vertex)]));
        const CarrierRange same = surface_.carriers[at(vertex)];
        surface_.carriers.push_back(std::vector<NodeWeight>(same.begin(), same.end()));
        surface_.node.push_back(int(surface_.node[at(vertex)]));
      }
      vertex = copy->second;
    }
  }

  // Where wedges that meet along an edge are one around its ends, all but the first get a vertex of
  // their own in the middle of the edge. False: there are none.
  bool splitEdges() {
    std::set<int> changed;  // triangles whose edges are others now: left to the next pass
    forAll([&](const std::vector<EdgePlace>& places) {
      const auto is_changed = [&](EdgePlace place) { return changed.count(place / 3) != 0; };
      if (places.size() < 3 || std::any_of(places.begin(), places.end(), is_changed)) return;
      const std::vector<int> wedge_of = wedgesOf(places);
      std::map<int, int> middles;  // per wedge
      for (std::size_t i = 0; i < places.size(); ++i) {
        if (wedge_of[i] == wedge_of[0]) continue;
        const auto [middle, is_new] =
            middles.try_emplace(wedge_of[i], static_cast<int>(surface_.rest.size()));
        if (is_new) addMiddle(places[i]);
        splitAt(places[i], middle->second);
        changed.insert(places[i] / 3);
      }
    });
    return !changed.empty();
  }

  void addMiddle(EdgePlace place) {
    const int a = vertexAt(place / 3, place % 3), b = vertexAt(place / 3, (place % 3 + 1) % 3);
    std::map<int, double> weights;
    for (const int end : {a, b}) {
      for (const NodeWeight& carrier : surface_.carriers[at(end)]) {
        weights[carrier.node] += 0.5 * carrier.weight;
      }
    }
    std::vector<NodeWeight> carriers;
    for (const auto& [node, weight] : weights) carriers.push_back({node, weight});
    places_.push_back(0.5 * (places_[at(a)] + places_[at(b)]));
    surface_.rest.push_back(0.5 * (surface_.rest[at(a)] + surface_.rest[at(b)]));
    surface_.carriers.push_back(carriers);
    surface_.node.push_back(-1);
  }

  // The triangle of the edge becomes two.
  void splitAt(EdgePlace place, int middle) {
    const std::size_t triangle = at(place / 3);
    MeshTriangle other = surface_.triangles[triangle];
    surface_.triangles[triangle][at((place % 3 + 1) % 3)] = middle;
    other[at(place % 3)] = middle;
    surface_.triangles.push_back(other);
    owners_.push_back(Octant(owners_[triangle]));
    part_of_.push_back(int(part_of_[triangle]));
    surface_.opened.push_back(std::uint8_t(surface_.opened[triangle]));
  }

  const OctantGrid& octants_;
  std::vector<Octant> owners_;  // per triangle
  std::vector<Vec3> places_;    // per vertex, in half spacings
  TissueSurface& surface_;
  std::vector<int> part_of_;  // per triangle, the one it was
  DisjointSets fans_;         // of corners of triangles
  std::vector<Edge> edges_;   // by their ends
  int along_ = 0;             // axis of the edge that is looked at
  std::array<Octant, 4> around_{};
};

}  // namespace

std::vector<int> separateHinges(const OctantGrid& octants, std::vector<Octant> owners,
                                std::vector<Vec3> places, TissueSurface& surface) {
  return HingeSeparator(octants, std::move(owners), std::move(places), surface).run();
}

}  // namespace robot_tissue
