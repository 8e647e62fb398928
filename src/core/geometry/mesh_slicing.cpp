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

// Points of the triangle whose weighted sum integrates polynomials up to degree 4 exactly: each
// stands for three, by turning its barycentric coordinates (Dunavant 1985).
struct TrianglePoint {
  double weight;  // of the triangle's area
  double apart;   // barycentric coordinate of two of the corners
};
constexpr TrianglePoint kTrianglePoints[] = {
    {0.22338158967801146569500700843312, 0.44594849091596488631832925388305},
    {0.10995174365532186763832632490021, 0.09157621350977074345957146340220}};

// Of the area under a piece, seen from above, with x and y from the cell's middle.
struct Shadow {
  double area = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;

  void add(double px, double py, double with_area) {
    area += with_area;
    x += with_area * px;
    y += with_area * py;
    xx += with_area * px * px;
    xy += with_area * px * py;
    yy += with_area * py * py;
  }
  Shadow& operator+=(const Shadow& other) {
    area += other.area;
    x += other.x;
    y += other.y;
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    return *this;
  }
};

// Of the column over a small area, from height `low` to `high`.
void addColumn(FillIntegrals& sum, double x, double y, double area, double low, double high) {
  const double height = high - low;
  const double z = 0.5 * (high * high - low * low);
  const double zz = (high * high * high - low * low * low) / 3.0;
  sum.volume += area * height;
  sum.first += area * Vec3(x * height, y * height, z);
  Eigen::Matrix3d second;
  second << x * x * height, x * y * height, x * z,  //
      x * y * height, y * y * height, y * z,        //
      x * z, y * z, zz;
  sum.second += area * second;
  sum.triple += area * x * y * z;
}

// Of columns through the whole cell.
FillIntegrals throughCell(const Shadow& shadow) {
  FillIntegrals sum;
  sum.volume = shadow.area;
  sum.first = {shadow.x, shadow.y, 0.0};
  sum.second << shadow.xx, shadow.xy, 0.0,  //
      shadow.xy, shadow.yy, 0.0,            //
      0.0, 0.0, shadow.area / 12.0;
  return sum;
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
    surface_of_.assign(count, -1);
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
    findMoments();
    return std::move(result_);
  }

 private:
  // What the surface does in one cell: the prisms under its pieces, and their shadow on what is
  // below.
  struct SurfaceCell {
    FillIntegrals under;
    Shadow shadow;
  };

  // From the highest layer down, with the shadow of all that is above.
  void findMoments() {
    const std::size_t layer = at(cells_[0]) * at(cells_[1]);
    std::vector<Shadow> above(layer);
    for (std::size_t cell = surface_of_.size(); cell-- > 0;) {
      if (surface_of_[cell] < 0) continue;
      const SurfaceCell& surface = surfaces_[at(surface_of_[cell])];
      Shadow& shadow = above[cell % layer];
      const double filled = result_.filled[cell];
      if (filled > 0.0 && filled < 1.0) {
        FillIntegrals sum = throughCell(shadow);
        sum += surface.under;
        sum.volume = filled;
        result_.partial.emplace_back(static_cast<int>(cell), sum);
      }
      shadow += surface.shadow;
    }
    std::reverse(result_.partial.begin(), result_.partial.end());
  }

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
    if (surface_of_[cell] < 0) {
      surface_of_[cell] = static_cast<int>(surfaces_.size());
      surfaces_.emplace_back();
    }
    SurfaceCell& surface = surfaces_[at(surface_of_[cell])];
    const Vec3 from = piece[0] - lowest - Vec3::Constant(0.5);
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
      addPrism(surface, from, b, c, area);
    }
    const bool reaches_in = (max.array() > lowest.array() + tuning::kCellSlack).all() &&
                            (min.array() < lowest.array() + 1.0 - tuning::kCellSlack).all();
    if (reaches_in) result_.occupied[cell] = 1;
  }

  // Under the triangle of the corner `from` and the edges b and c there, down to the cell's floor.
  static void addPrism(SurfaceCell& surface, const Vec3& from, const Vec3& b, const Vec3& c,
                       double area) {
    for (const TrianglePoint& point : kTrianglePoints) {
      const double apart = point.apart, rest = 1.0 - 2.0 * point.apart;
      const double with_area = point.weight * area;
      for (const Vec3& at_point :
           {Vec3(from + apart * b + apart * c), Vec3(from + rest * b + apart * c),
            Vec3(from + apart * b + rest * c)}) {
        addColumn(surface.under, at_point.x(), at_point.y(), with_area, -0.5, at_point.z());
        surface.shadow.add(at_point.x(), at_point.y(), with_area);
      }
    }
  }

  std::array<int, 3> cells_{};  // along x, y, z
  std::array<int, 3> index_{};  // of the cell that is being cut out
  MeshCells result_;
  std::vector<double> shadow_;   // per cell: signed area of the pieces in it, seen from above
  std::vector<int> surface_of_;  // per cell, into surfaces_; -1 = the surface is not in it
  std::vector<SurfaceCell> surfaces_;
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

namespace {

// In spacings from the grid's lowest node.
Polygon placed(const TriangleMesh& mesh, const MeshTriangle& triangle, const Grid& grid) {
  Polygon polygon;
  for (const int vertex : triangle) {
    polygon.push_back((mesh.vertices[at(vertex)] - grid.shape().min()) / grid.spacing());
  }
  return polygon;
}

// What of the triangle has a shadow in the grid's cells: the part beside the grid and below it
// goes, the part above it is laid down on its top.
void addWithin(const Grid& grid, Polygon rest, Slicer& slicer) {
  Polygon below, above;
  for (int axis = 0; axis < 3; ++axis) {
    split(rest, axis, 0.0, below, above);
    rest.swap(above);
    if (rest.size() < 3) return;
    split(rest, axis, grid.size()[at(axis)] - 1.0, below, above);
    rest.swap(below);
    if (axis < 2 && rest.size() < 3) return;
  }
  if (rest.size() > 2) slicer.add(rest);
  const double top = grid.size()[2] - 1.0;
  const bool is_above = std::any_of(above.begin(), above.end(),
                                    [top](const Vec3& corner) { return corner.z() > top; });
  if (!is_above) return;
  for (Vec3& corner : above) corner.z() = top;
  slicer.add(above);
}

}  // namespace

MeshCells sliced(const TriangleMesh& mesh, const Grid& grid) {
  Slicer slicer(grid);
  for (const MeshTriangle& triangle : mesh.triangles) slicer.add(placed(mesh, triangle, grid));
  return slicer.finish();
}

MeshCells slicedWithin(const TriangleMesh& mesh, const Grid& grid) {
  Slicer slicer(grid);
  for (const MeshTriangle& triangle : mesh.triangles) {
    addWithin(grid, placed(mesh, triangle, grid), slicer);
  }
  return slicer.finish();
}

}  // namespace robot_tissue
