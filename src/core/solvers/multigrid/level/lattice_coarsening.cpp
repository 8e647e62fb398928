#include "solvers/multigrid/level/lattice_coarsening.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "robot_tissue/core/disjoint_sets.h"
#include "solvers/multigrid/level/cell_kernel.h"

namespace robot_tissue {
namespace {

using Place = std::array<int, 3>;

int padded(int entries) { return (entries + kLanes - 1) / kLanes * kLanes; }

Place cornerOf(const Place& place, int corner) {
  return {place[0] + (corner & 1), place[1] + (corner >> 1 & 1), place[2] + (corner >> 2 & 1)};
}

FillIntegrals integralsIn(const LevelCell& cell) {
  return cell.fill != nullptr ? cell.fill->integrals : integralsOf(CellFill()).scaledBy(cell.shear);
}

// The fill of a coarse cell from its parts' (own).
class FillSum {
 public:
  void add(const LevelCell& part) {
    ++count_;
    is_full_ = is_full_ && part.fill == nullptr && (count_ == 1 || part.shear == shear_);
    shear_ = part.shear;
    const FillIntegrals in_part = integralsIn(part);
    Vec3 middle;
    for (int axis = 0; axis < 3; ++axis)
      middle[axis] = part.place[at(axis)] % 2 == 0 ? -0.25 : 0.25;
    const double weight = in_part.volume / kCorners;
    const Vec3 first = in_part.first / kCorners;
    sum_.volume += weight;
    sum_.first += weight * middle + 0.5 * first;
    sum_.second += weight * middle * middle.transpose() +
                   0.5 * (first * middle.transpose() + middle * first.transpose()) +
                   0.25 / kCorners * in_part.second;
    const Vec3 centroid = middle + 0.5 * in_part.first / in_part.volume;
    squares_ += weight * centroid.cwiseAbs2();
  }

  // Null: eight full parts that are alike.
  std::shared_ptr<const LevelFill> fill(double bulk_by_shear) const {
    if (is_full_ && count_ == kCorners) return nullptr;
    auto fill = std::make_shared<LevelFill>();
    fill->integrals = sum_;
    fill->law = fillLaw(fillOf(sum_), bulk_by_shear);
    const Vec3& centroid = fill->law.centroid;
    fill->between_parts = (squares_ / sum_.volume - centroid.cwiseAbs2()).cwiseMax(0.0);
    return fill;
  }

 private:
  FillIntegrals sum_;
  Vec3 squares_ = Vec3::Zero();
  bool is_full_ = true;
  double shear_ = 0.0;
  int count_ = 0;
};

// Whatever the object's size, the work beside what is cut, or at its outside, is a few steps a
// cell: most cells are plain, their nodes the grid's own.
class Coarsener {
 public:
  Coarsener(const LevelGrid& fine, const std::vector<LevelCell>& cells, int entries)
      : fine_(fine), cells_(cells), entries_(entries) {
    has_fills_ = std::any_of(cells.begin(), cells.end(),
                             [](const LevelCell& cell) { return cell.fill != nullptr; });
    Place size{};
    for (std::size_t axis = 0; axis < 3; ++axis) size[axis] = fine.size[axis] / 2 + 1;
    result_.grid = LevelGrid(size);
  }

  Coarsening run() {
    gatherPieces();
    findNodes();
    findCarriers();
    findStarts();
    return std::move(result_);
  }

 private:
  // The coarse cells that have a fine node, at most one for each of its cells.
  struct PiecesAt {
    std::array<int, kCorners> all{};
    int count = 0;

    void add(int piece) {
      const auto end = all.begin() + count;
      if (std::find(all.begin(), end, piece) == end) all[at(count++)] = piece;
    }
  };

  // Fine cells by the coarse place they are in, then by connected pieces (over shared nodes).
  void gatherPieces() {
    const Place& size = result_.grid.size;
    std::vector<int> ends(at(size[0] * size[1] * size[2] + 1), 0), order(cells_.size());
    const auto place_of = [&](const LevelCell& cell) {
      return cell.place[0] / 2 + size[0] * (cell.place[1] / 2 + size[1] * (cell.place[2] / 2));
    };
    for (const LevelCell& cell : cells_) ++ends[at(place_of(cell) + 1)];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      order[at(ends[at(place_of(cells_[cell]))]++)] = static_cast<int>(cell);
    }
    piece_of_.assign(cells_.size(), -1);
    for (std::size_t first = 0, place = 0; first < order.size(); ++place) {
      const std::size_t end = at(ends[place]);
      if (end == first) continue;
      splitGroup(order.data() + first, order.data() + end);
      first = end;
    }
  }

  void splitGroup(const int* first, const int* last) {
    const auto count = static_cast<std::size_t>(last - first);
    DisjointSets sets(count);
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a + 1; b < count; ++b) {
        const int left = static_cast<int>(a), right = static_cast<int>(b);
        if (sets.lowest(left) != sets.lowest(right) && haveCommonNode(first[a], first[b])) {
          sets.join(left, right);
        }
      }
    }
    const std::size_t first_piece = result_.cells.size();
    for (std::size_t i = 0; i < count; ++i) {
      const int root = sets.lowest(static_cast<int>(i));
      int& piece = piece_of_[at(first[i])];
      if (root == static_cast<int>(i)) {
        piece = static_cast<int>(result_.cells.size());
        const Place& place = cells_[at(first[i])].place;
        result_.cells.push_back({{place[0] / 2, place[1] / 2, place[2] / 2}, {}, 0, 0, 0, {}, {}});
        fills_.emplace_back();
      } else {
        piece = piece_of_[at(first[root])];
      }
      LevelCell& coarse = result_.cells[at(piece)];
      const LevelCell& fine = cells_[at(first[i])];
      coarse.shear += fine.shear / kCorners;
      coarse.bulk += fine.bulk / kCorners;
      coarse.stiffening += fine.shear * fine.stiffening / kCorners;
      if (has_fills_) fills_[at(piece) - first_piece].add(fine);
    }
    for (std::size_t piece = first_piece; piece < result_.cells.size(); ++piece) {
      LevelCell& coarse = result_.cells[piece];
      if (coarse.stiffening > 0.0) coarse.stiffening /= coarse.shear;  // the mean by stiffness
      if (has_fills_) coarse.fill = fills_[piece - first_piece].fill(coarse.bulk / coarse.shear);
    }
    fills_.clear();
    is_alone_.resize(result_.cells.size(), result_.cells.size() - first_piece == 1 ? 1 : 0);
  }

  bool haveCommonNode(int a, int b) const {
    const auto& left = cells_[at(a)].nodes;
    const auto& right = cells_[at(b)].nodes;
    return std::any_of(left.begin(), left.end(), [&](int node) {
      return std::find(right.begin(), right.end(), node) != right.end();
    });
  }

  // Pieces with a common fine node have the coarse nodes in common that lie at both.
  void findNodes() {
    pieces_at_.assign(at(entries_), {});
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      for (const int node : cells_[cell].nodes) pieces_at_[at(node)].add(piece_of_[cell]);
    }
    DisjointSets corners(kCorners * result_.cells.size());
    joined_.assign(result_.cells.size(), 0);
    for (const PiecesAt& pieces : pieces_at_) {
      for (int other = 1; other < pieces.count; ++other) {
        for (int one = 0; one < other; ++one) {
          joinPieces(pieces.all[at(one)], pieces.all[at(other)], corners);
        }
      }
    }
    numberNodes(corners);
  }

  // Those alone at their places are joined once, however many nodes they share.
  void joinPieces(int a, int b, DisjointSets& corners) {
    const Place& from = result_.cells[at(a)].place;
    const Place& to = result_.cells[at(b)].place;
    if (is_alone_[at(a)] != 0 && is_alone_[at(b)] != 0) {
      const int toward =
          to[0] - from[0] + 1 + 3 * (to[1] - from[1] + 1 + 3 * (to[2] - from[2] + 1));
      const std::uint32_t bit = std::uint32_t{1} << toward;
      if ((joined_[at(a)] & bit) != 0) return;
      joined_[at(a)] |= bit;
    }
    for (int corner = 0; corner < kCorners; ++corner) {
      const Place point = cornerOf(from, corner);
      int other = 0;
      bool common = true;
      for (int axis = 0; axis < 3; ++axis) {
        const int offset = point[at(axis)] - to[at(axis)];
        common = common && offset >= 0 && offset <= 1;
        if (offset == 1) other |= 1 << axis;
      }
      if (common) corners.join(kCorners * a + corner, kCorners * b + other);
    }
  }

  // The first at a grid point has the grid's entry, others stand beside.
  void numberNodes(DisjointSets& corners) {
    std::vector<std::uint8_t> taken(at(result_.grid.beside), 0);
    std::vector<int> entry_of(kCorners * result_.cells.size(), -1);
    places_.assign(at(result_.grid.beside), {});
    for (std::size_t piece = 0; piece < result_.cells.size(); ++piece) {
      LevelCell& cell = result_.cells[piece];
      for (int corner = 0; corner < kCorners; ++corner) {
        int& entry = entry_of[at(corners.lowest(kCorners * static_cast<int>(piece) + corner))];
        if (entry < 0) {
          const Place point = cornerOf(cell.place, corner);
          const int on_grid = result_.grid.index(point[0], point[1], point[2]);
          entry = taken[at(on_grid)] == 0 ? on_grid : result_.grid.beside + result_.nodes_beside++;
          taken[at(on_grid)] = 1;
          if (entry != on_grid) places_.push_back({});
          places_[at(entry)] = point;
        }
        cell.nodes[at(corner)] = entry;
      }
    }
  }

  // A fine node is the mean of the corners of any coarse cell that has it.
  void findCarriers() {
    fine_places_.assign(at(entries_), {});
    std::vector<int> cell_at(at(entries_), -1);
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      for (int corner = 0; corner < kCorners; ++corner) {
        const int node = cells_[cell].nodes[at(corner)];
        if (cell_at[at(node)] >= 0) continue;
        cell_at[at(node)] = static_cast<int>(cell);
        fine_places_[at(node)] = cornerOf(cells_[cell].place, corner);
      }
    }
    is_carried_.assign(at(entries_), 0);
    for (int node = 0; node < entries_; ++node) {
      if (cell_at[at(node)] < 0) continue;
      const LevelCell& coarse = result_.cells[at(piece_of_[at(cell_at[at(node)])])];
      if (node < fine_.beside && isPlain(coarse)) continue;
      findCarriers(node, coarse);
    }
  }

  // Its nodes are the grid's.
  bool isPlain(const LevelCell& coarse) const {
    const int beside = result_.grid.beside;
    return std::all_of(coarse.nodes.begin(), coarse.nodes.end(),
                       [beside](int node) { return node < beside; });
  }

  void findCarriers(int node, const LevelCell& coarse) {
    NodeShares shares = sharesAround(result_.grid, fine_places_[at(node)]);
    bool usual = node < fine_.beside;
    for (NodeWeight& share : shares) {
      const Place point = result_.grid.placeOf(share.node);
      int corner = 0;
      for (int axis = 0; axis < 3; ++axis) {
        if (point[at(axis)] > coarse.place[at(axis)]) corner |= 1 << axis;
      }
      usual = usual && coarse.nodes[at(corner)] == share.node;
      share.node = coarse.nodes[at(corner)];
    }
    if (usual) return;
    is_carried_[at(node)] = 1;
    result_.carried.push_back({node, std::move(shares)});
  }

  void findStarts() {
    std::vector<std::uint8_t> is_usual(places_.size(), 0);
    for (int node = 0; node < result_.grid.beside; ++node) is_usual[at(node)] = startsAtNode(node);
    std::unordered_map<int, NodeShares> around;
    std::vector<int> order;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      for (const int node : result_.cells[at(piece_of_[cell])].nodes) {
        if (is_usual[at(node)] != 0) continue;
        if (around.count(node) == 0) order.push_back(node);
        const Place& point = places_[at(node)];
        addAround(cells_[cell], {2 * point[0], 2 * point[1], 2 * point[2]}, around[node]);
      }
    }
    for (const int node : order) {
      NodeShares& fine = around[node];
      double sum = 0.0;
      for (const NodeWeight& share : fine) sum += share.weight;
      for (NodeWeight& share : fine) share.weight /= sum;
      if (!fine.empty()) result_.starts.push_back({node, fine});
    }
  }

  // Of the grid: where the fine node at its place is, which has it as a carrier.
  bool startsAtNode(int node) const {
    const Place& point = places_[at(node)];
    const Place twice = {2 * point[0], 2 * point[1], 2 * point[2]};
    if (!isOnFineGrid(twice)) return false;
    const std::size_t fine = at(fine_.index(twice[0], twice[1], twice[2]));
    return fine_places_[fine] == twice && pieces_at_[fine].count > 0 && is_carried_[fine] == 0;
  }

  bool isOnFineGrid(const Place& place) const {
    return place[0] < fine_.size[0] && place[1] < fine_.size[1] && place[2] < fine_.size[2];
  }

  // The node at the place alone, if there is one; else those next to it.
  void addAround(const LevelCell& cell, const Place& twice, NodeShares& fine) const {
    if (fine.size() == 1 && fine.front().weight == 1.0) return;
    for (int corner = 0; corner < kCorners; ++corner) {
      const int node = cell.nodes[at(corner)];
      const Place& place = fine_places_[at(node)];
      int apart = 0, furthest = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        apart += std::abs(place[axis] - twice[axis]);
        furthest = std::max(furthest, std::abs(place[axis] - twice[axis]));
      }
      const auto same = [node](const NodeWeight& share) { return share.node == node; };
      if (furthest > 1 || std::any_of(fine.begin(), fine.end(), same)) continue;
      if (apart == 0) {
        fine = {{node, 1.0}};
        return;
      }
      fine.push_back({node, std::pow(0.5, apart)});
    }
  }

  const LevelGrid& fine_;
  const std::vector<LevelCell>& cells_;
  int entries_;
  // Of any of the cells: then coarse cells have theirs. Without, an odd block's last cells have the
  // mean moduli alone.
  bool has_fills_ = false;
  std::vector<FillSum> fills_;  // of the pieces at the present place
  Coarsening result_;
  std::vector<int> piece_of_;             // per fine cell: the coarse one
  std::vector<std::uint8_t> is_alone_;    // per coarse cell: no other is at its place
  std::vector<std::uint32_t> joined_;     // per coarse cell: bits of neighbors
  std::vector<PiecesAt> pieces_at_;       // per fine node
  std::vector<Place> fine_places_;        // per fine node
  std::vector<std::uint8_t> is_carried_;  // per fine node: by others than the grid's around it
  std::vector<Place> places_;             // of coarse nodes
};

}  // namespace

LevelGrid::LevelGrid(const std::array<int, 3>& points)
    : size(points),
      row(points[0]),
      plane(padded(points[0] * points[1]) + kLanes),
      beside(padded(plane * (points[2] + 1) + row + 1 + kLanes)) {}

Coarsening coarsened(const LevelGrid& fine, const std::vector<LevelCell>& cells, int entries) {
  return Coarsener(fine, cells, entries).run();
}

NodeShares sharesAround(const LevelGrid& coarse, const std::array<int, 3>& fine_place) {
  NodeShares shares;
  shares.reserve(kCorners);
  shares.push_back({coarse.index(fine_place[0] / 2, fine_place[1] / 2, fine_place[2] / 2), 1.0});
  const std::array<int, 3> strides = {1, coarse.row, coarse.plane};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (fine_place[axis] % 2 == 0) continue;
    const std::size_t count = shares.size();
    for (std::size_t i = 0; i < count; ++i) {
      shares[i].weight *= 0.5;
      shares.push_back({shares[i].node + strides[axis], shares[i].weight});
    }
  }
  return shares;
}

}  // namespace robot_tissue
