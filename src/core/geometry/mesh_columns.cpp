#include "geometry/mesh_columns.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace robot_tissue {
namespace {

// Twice the area of a, b and the point, seen from above.
double turn(const Vec3& a, const Vec3& b, double x, double y) {
  return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
}

struct Crossing {
  double height;
  int enters;  // 1: upwards the line goes in here; -1: out
};

std::optional<Crossing> crossing(const std::array<Vec3, 3>& corners, double x, double y) {
  const double a = turn(corners[1], corners[2], x, y);
  const double b = turn(corners[2], corners[0], x, y);
  const double c = turn(corners[0], corners[1], x, y);
  const bool faces_up = a > 0.0 && b > 0.0 && c > 0.0;
  if (!faces_up && !(a < 0.0 && b < 0.0 && c < 0.0)) return std::nullopt;
  const double height =
      (a * corners[0].z() + b * corners[1].z() + c * corners[2].z()) / (a + b + c);
  return Crossing{height, faces_up ? -1 : 1};
}

}  // namespace

MeshColumns::MeshColumns(const TriangleMesh& mesh, const Grid& grid)
    : columns_{grid.size()[0] - 1, grid.size()[1] - 1}, met_(at(columns_[0]) * at(columns_[1])) {
  for (const MeshTriangle& triangle : mesh.triangles) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = (mesh.vertices[at(triangle[i])] - grid.shape().min()) / grid.spacing();
    }
    const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    if (high.x() < 0.0 || high.y() < 0.0 || low.x() > columns_[0] || low.y() > columns_[1]) {
      continue;
    }
    const int number = static_cast<int>(triangles_.size());
    triangles_.push_back(corners);
    const int first = columnOf(low.x(), low.y()), last = columnOf(high.x(), high.y());
    for (int row = first / columns_[0]; row <= last / columns_[0]; ++row) {
      for (int i = first % columns_[0]; i <= last % columns_[0]; ++i) {
        met_[at(i + columns_[0] * row)].push_back(number);
      }
    }
  }
}

int MeshColumns::columnOf(double x, double y) const {
  const auto within = [](double along, int count) {
    return static_cast<int>(std::clamp(std::floor(along), 0.0, count - 1.0));
  };
  return within(x, columns_[0]) + columns_[0] * within(y, columns_[1]);
}

std::vector<std::pair<double, double>> MeshColumns::insideAt(double x, double y) const {
  std::vector<Crossing> crossings;
  for (const int triangle : met_[at(columnOf(x, y))]) {
    if (const auto found = crossing(triangles_[at(triangle)], x, y)) crossings.push_back(*found);
  }
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& a, const Crossing& b) { return a.height < b.height; });
  std::vector<std::pair<double, double>> inside;
  int depth = 0;
  for (const Crossing& each : crossings) {
    depth += each.enters;
    if (depth == 1 && each.enters == 1) inside.emplace_back(each.height, each.height);
    if (depth == 0 && each.enters == -1 && !inside.empty()) inside.back().second = each.height;
  }
  return inside;
}

}  // namespace robot_tissue
