#include "geometry/mesh_slicing.h"

#include <algorithm>
#include <cmath>

#include "geometry/tuning.h"

namespace robot_tissue {
namespace {

using Polygon = std::vector<Vec3>;  // convex, in spacings from the grid's lowest node

// Parts on both sides of a plane across the axis; corners on it go to both.
void split(const Polygon& polygon, int axis, double plane, Polygon& below, Polygon& above) {
  below.clear();
  above.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double from = a[axis] - plane;
    const double to = b[axis] - plane;
    if (from <= 0.0) below.push_back(a);
    if (from >= 0.0) above.push_back(a);
    if ((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0)) {
      Vec3 crossing = a + from / (from - to) * (b - a);
      crossing[axis] = plane;
      below.push_back(crossing);
      above.push_back(crossing);
    }
  }
}

class Slicer {
 public:
  explicit Slicer(const Grid& grid) {
    std::size_t count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells_[axis] = grid.size()[axis] - 1;
      count *= at(cells_[axis]);
    }
    result_.filled.assign(count, 0.0);
    result_.occupied.assign(count, 0);
    shadow_.assign(count, 0.0);
  }

  void add(const Polygon& triangle) { cutAlong(0, triangle); }

  MeshCells finish() {
    const std::size_t layer = at(cells_[0]) * at(cells_[1]);
    for (std::size_t cell = shadow_.size(); cell-- > 0;) {
      if (cell + layer < shadow_.size()) {
        shadow_[cell] += shadow_[cell + layer];
        result_.filled[cell] += shadow_[cell + layer];
      }
      double& filled = result_.filled[cell];
      filled = filled < tuning::kShareRounding         ? 0.0
               : filled > 1.0 - tuning::kShareRounding ? 1.0
                                                       : filled;
      if (filled > tuning::kCellSlack) result_.occupied[cell] = 1;
    }
    return std::move(result_);
  }

 private:
  void cutAlong(int axis, Polygon rest) {
    if (axis == 3) return addPiece(rest);
    double low = rest.front()[axis];
    double high = low;
    for (const Vec3& corner : rest) {
      low = std::min(low, corner[axis]);
      high = std::max(high, corner[axis]);
    }
    const int top = cells_[at(axis)] - 1;
    const int first = std::clamp(static_cast<int>(std::floor(low)), 0, top);
    const int last = std::clamp(static_cast<int>(std::ceil(high)) - 1, first, top);
    Polygon below;
    Polygon above;
    for (int cell = first; cell < last; ++cell) {
      split(rest, axis, cell + 1.0, below, above);
      index_[at(axis)] = cell;
      if (below.size() > 2) cutAlong(axis + 1, below);
      rest.swap(above);
      if (rest.size() < 3) return;
    }
    index_[at(axis)] = last;
    cutAlong(axis + 1, std::move(rest));
  }

  void addPiece(const Polygon& piece) {
    const std::size_t cell =
        at(index_[0]) + at(cells_[0]) * (at(index_[1]) + at(cells_[1]) * at(index_[2]));
    const Vec3 lowest(index_[0], index_[1], index_[2]);
    Vec3 min = piece[0];
    Vec3 max = piece[0];
    for (std::size_t i = 1; i < piece.size(); ++i) {
      min = min.cwiseMin(piece[i]);
      max = max.cwiseMax(piece[i]);
      if (i + 1 == piece.size()) continue;
      const Vec3 b = piece[i] - piece[0];
      const Vec3 c = piece[i + 1] - piece[0];
      const double area = 0.5 * (b.x() * c.y() - b.y() * c.x());  // of the shadow; > 0: faces up
      const double height = piece[0].z() + (b.z() + c.z()) / 3.0 - lowest.z();
      result_.filled[cell] += area * height;
      shadow_[cell] += area;
    }
    const bool reaches_in = (max.array() > lowest.array() + tuning::kCellSlack).all() &&
                            (min.array() < lowest.array() + 1.0 - tuning::kCellSlack).all();
    if (reaches_in) result_.occupied[cell] = 1;
  }

  std::array<int, 3> cells_{};  // along x, y, z
  std::array<int, 3> index_{};  // of the cell that is being cut out
  MeshCells result_;
  std::vector<double> shadow_;  // per cell: signed area of the pieces in it, seen from above
};

}  // namespace

Grid gridAround(const TriangleMesh& mesh, double spacing) {
  const Box bounds = boundsOf(mesh.vertices);
  const Vec3 middle = 0.5 * (bounds.min() + bounds.max());
  Vec3 half;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = (bounds.max()[axis] - bounds.min()[axis]) / spacing;
    half[axis] = 0.5 * std::max(1.0, std::ceil(extent - tuning::kCellSlack)) * spacing;
  }
  return Grid({middle - half, middle + half}, spacing);
}

MeshCells sliced(const TriangleMesh& mesh, const Grid& grid) {
  Slicer slicer(grid);
  Polygon polygon(3);
  for (const MeshTriangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      polygon[i] = (mesh.vertices[at(triangle[i])] - grid.shape().min()) / grid.spacing();
    }
    slicer.add(polygon);
  }
  return slicer.finish();
}

}  // namespace robot_tissue
