// How severed springs divide a cell among its corners (own).
//
// The blade is known by where it passed through springs. A cell's corner has the part of it nearest
// along the cell's edges, faces and diagonals: up to where its springs were parted, to a point of
// each face at it, and to a point inside. These points lie where the blade passed:
//   edge   where the spring was parted, half way where it is whole;
//   face   half way between two parted edges, where the lines between opposite ones cross; else its
//          middle. It hangs on the face's edges alone, so cells on both sides have the same;
//   inside the mean of the parted edges between two parts of the cell; where more parts meet, what
//          is nearest to the planes through the points between each two of them.
// Springs that are severed since nothing is left along them part nothing here, so that what is left
// of a cell stays as it is.
// The corner's part is six tetrahedra of corner, edge, face and inside point. All have a volume
// above zero and they fill the cell, whatever was severed. A plane through the cell, two that
// cross, or three, come out exactly; of a curved blade each cell has facets through the points on
// its springs. A blade that passes a spring a second time, or that no spring of the cell crosses,
// is not seen.
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "geometry/tetrahedron.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// Indices along x, y, z in half spacings from the cell's lowest corner, 0 to 2: corners have 0 or
// 2, edges a 1, faces two.
using CellPoint = std::array<int, 3>;

// The lattice's cells that have the spring as an edge; -1: there is none.
std::array<int, 4> cellsAround(const Lattice& lattice, const Spring& spring);

// Per cell of the lattice, 1: one of its springs is severed.
std::vector<char> cellsWithSevered(const Lattice& lattice, const LatticeState& state);

// Whether a blade parted any spring of the lattice's cell.
bool hasPartedSprings(const Lattice& lattice, const LatticeState& state, const Cell& cell);

class CellDivision {
 public:
  CellDivision();  // of a cell of which nothing is parted
  // Whether springs ahead count as parted (cut_front.h): for the material, but not for the shown
  // surface, as cells beside it do not know of them.
  enum class Ahead { kWhole, kParted };
  // Of the lattice's cell, with what was removed of it.
  CellDivision(const Lattice& lattice, const LatticeState& state, const Cell& cell,
               Ahead ahead = Ahead::kWhole);

  // From the cell's lowest corner, in spacings.
  const Vec3& at(const CellPoint& point) const { return points_[indexOf(point)]; }
  // The corner's tetrahedra, in spacings from the cell's middle.
  std::array<Tetrahedron, 6> aroundCorner(int corner) const;

 private:
  static std::size_t indexOf(const CellPoint& point) {
    return robot_tissue::at(point[0] + 3 * point[1] + 9 * point[2]);
  }
  bool isParted(const CellPoint& edge) const { return parted_[indexOf(edge)]; }
  void placeEdges(const Lattice& lattice, const LatticeState& state, const Cell& cell, Ahead ahead);
  void placeFace(int across, int side);
  int partedEdges(const CellPoint& face, int across) const;
  void placeInside();

  // Between two parts of the cell, lower number first.
  struct PartedEdge {
    CellPoint middle{};
    int axis = 0;
    std::pair<int, int> parts;
  };
  std::vector<PartedEdge> edgesBetweenParts() const;
  std::map<std::pair<int, int>, std::vector<Vec3>> pointsBetween(
      const std::vector<PartedEdge>& edges) const;

  std::array<Vec3, 27> points_;
  std::array<bool, 27> parted_{};  // edges
};

// Of the cells that a blade parted springs of.
class CellDivisions {
 public:
  CellDivisions(const Lattice& lattice, const LatticeState& state);

  // Null: nothing parts the cell at the place. Valid while this is.
  const CellDivision* find(int place) const {
    const int division = number(place);
    return division < 0 ? nullptr : &divisions_[robot_tissue::at(division)];
  }
  // Of the divisions there are, -1: none.
  int number(int place) const {
    return division_of_.empty() ? -1 : division_of_[robot_tissue::at(place)];
  }
  std::size_t count() const { return divisions_.size(); }

 private:
  std::vector<int> division_of_;  // per cell; empty: no blade parted any
  std::vector<CellDivision> divisions_;
};

// The material that each corner of the lattice's cell has; together all of the cell's. Where a mesh
// fills a cell in part, that is taken as a box along the axes of its covariance, of the same
// volume, centroid and second moments, and clipped: exact where the fill is a box, else near it.
std::array<FillIntegrals, kCorners> cornerFills(const Lattice& lattice, const LatticeState& state,
                                                const Cell& cell);

}  // namespace robot_tissue
