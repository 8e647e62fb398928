// A mesh cut into pieces at the planes of a grid of half spacings, so that it can be taken apart
// along them (own).
//
// An octant is the eighth of a cell around one of its corners. Every piece lies in one octant.
// All decisions hang on which side of a plane a vertex is, which is the same for all pieces that
// have it; points that planes cut out of a common edge are common. So where the mesh is closed, the
// pieces of one octant and the lids on its faces are closed to the last bit, whatever the rounding.
//
// The mesh is cut by the planes of nodes first. In a cell a bent plane (bent_grid.h) is facets that
// meet along lines from its middle; it cuts a triangle from where it meets one edge to where it
// meets the other, over the points where those lines pass through the triangle. So all pieces lie
// in the mesh's triangles, and all seams on the facets. Where planes bend so much that one meets an
// edge more than once, the edge is parted there; what comes and goes between two of the points that
// are looked at stands out of the skin.
#pragma once

#include <array>
#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

#include "geometry/index_hash.h"
#include "geometry/mesh_points.h"
#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

class MeshPieces {
 public:
  struct Piece {
    HalfIndex octant{};
    std::vector<int> outline;  // three vertices, turned as the triangle
    int triangle = 0;          // of the mesh
  };
  // `vertices` in spacings from the grid's lowest corner; `cells` of the grid along x, y, z. The
  // grid must outlive this.
  MeshPieces(std::vector<Vec3> vertices, const std::array<int, 3>& cells, const BentGrid& grid);

  // Cuts a triangle. Its pieces are kept if asked for; where it crosses the grid's lines always is.
  void add(const MeshTriangle& triangle, int number, bool keep_pieces);
  // MeshPoints: those of the mesh first, then what planes cut out.
  std::vector<int> subdivided(int from, int to) { return points_.subdivided(from, to); }
  int addMiddle(const std::vector<int>& points) { return points_.addMiddle(points); }
  const Vec3& straight(int point) const { return points_.straight(point); }
  const Vec3& place(int point) const { return points_.place(point); }
  HalfIndex octantOf(const Vec3& straight) const { return points_.octantOf(straight); }

  const std::vector<Piece>& pieces() const { return pieces_; }

  // What the mesh encloses on the upper face of the octant along the axis: loops of points around
  // it, as seen from above that face, where the mesh runs in it and along parts of its edges. None
  // passes a point twice. All triangles must have been added, those near it with their pieces.
  std::vector<std::vector<int>> lid(const HalfIndex& octant, int axis);

 private:
  // An edge of a polygon starts at `vertex`; `face` is 2 * axis + side of the octant's face that it
  // runs in (side 1 = the upper one), -1 = none.
  struct Corner {
    int vertex = 0;
    int face = -1;
  };
  using Polygon = std::vector<Corner>;
  using Segment = std::pair<int, int>;  // directed, between vertices
  // Where a line of the grid passes through the mesh.
  struct Crossing {
    double place = 0.0;  // along the line, spacings
    int vertex = 0;
    int octant = 0;  // along the line
    int change = 0;  // +1: into the mesh, going up
  };
  using LineKey = std::array<int, 3>;  // axis, and the half indices along the two next ones

  enum class Direction { kForwards, kBackwards };  // along an axis

  void split(const Polygon& triangle, int axis, int plane, Polygon& below, Polygon& above);
  void noteCrossing(const Corner& from, int axis, int plane, int vertex);
  std::vector<int> bendsBetween(int from, int to, const Polygon& triangle, int axis);
  void bend(const Polygon& triangle, int axis, Polygon& below, Polygon& above);
  Vec3 normalOf(const Polygon& triangle) const;
  std::vector<MeshTriangle> fillOf(const Polygon& polygon, const Vec3& normal) const;
  std::vector<Polygon> trianglesOf(const Polygon& polygon, const Vec3& normal) const;
  void cutAtNodes(int axis, const Polygon& triangle, bool keep);
  void cutInCell(int axis, const Polygon& triangle, int rounds, bool keep);
  void cutBetweenNodes(int axis, const Polygon& triangle, bool keep);
  void keepWithin(int axis, int first, int last);
  void keepWithinCell(int axis);
  void keepPiece(const Polygon& piece);
  int gridPoint(const HalfIndex& point);
  std::vector<Segment> border(const HalfIndex& octant, int axis);
  void addEdge(const HalfIndex& start, int axis, Direction direction, std::vector<Segment>& border);

  const BentGrid& grid_;
  HalfIndex octants_{};  // of the grid, along x, y, z
  MeshPoints points_;
  int triangle_ = 0;            // that is being cut
  HalfIndex first_{}, last_{};  // octants that what is being cut out lies in
  std::vector<Piece> pieces_;
  template <std::size_t N, class Value>
  using Table = std::unordered_map<std::array<int, N>, Value, IndexHash>;
  Table<3, std::vector<Crossing>> lines_;
  Table<4, std::vector<Segment>> seams_;  // octant, axis: upper face
  Table<3, int> grid_points_;
};

}  // namespace robot_tissue
