#include "exact_surface.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace robot_tissue {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Corners = std::array<Kernel::Point_3, 3>;

Kernel::Point_3 toPoint(const Vec3& place) { return {place.x(), place.y(), place.z()}; }

// Of the triangles' corners alone; triangles by their numbers.
void makeSoup(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles,
              std::vector<Kernel::Point_3>& points, std::vector<std::vector<std::size_t>>& faces) {
  std::map<int, std::size_t> number;
  for (const MeshTriangle& triangle : triangles) {
    std::vector<std::size_t> face;
    for (const int vertex : triangle) {
      const auto [known, is_new] = number.try_emplace(vertex, points.size());
      if (is_new) points.push_back(toPoint(vertices[at(vertex)]));
      face.push_back(known->second);
    }
    faces.push_back(face);
  }
}

// Corners of `a` are strictly on both sides of the plane of `b`.
bool straddles(const Corners& a, const Corners& b) {
  bool above = false, below = false;
  for (const Kernel::Point_3& corner : a) {
    const CGAL::Orientation side = CGAL::orientation(b[0], b[1], b[2], corner);
    above = above || side == CGAL::POSITIVE;
    below = below || side == CGAL::NEGATIVE;
  }
  return above && below;
}

Exact::Triangle_3 exactOf(const Corners& corners) {
  const auto exact = [](const Kernel::Point_3& p) { return Exact::Point_3(p.x(), p.y(), p.z()); };
  return {exact(corners[0]), exact(corners[1]), exact(corners[2])};
}

bool meet(const Corners& a, std::size_t corner, const Corners& b) {
  return CGAL::do_intersect(Kernel::Segment_3(a[(corner + 1) % 3], a[(corner + 2) % 3]),
                            Kernel::Triangle_3(b[0], b[1], b[2]));
}

// What triangles with a corner in common have in common beyond it ends at the edge across from it,
// of one or the other. Signs alone, so exact, and in far less time than what they have in common.
bool crosses(const Corners& a, const Corners& b) {
  if (!straddles(a, b) || !straddles(b, a)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (a[i] == b[j]) return meet(a, i, b) || meet(b, j, a);
    }
  }
  if (!CGAL::do_intersect(Kernel::Triangle_3(a[0], a[1], a[2]),
                          Kernel::Triangle_3(b[0], b[1], b[2]))) {
    return false;
  }
  const auto common = CGAL::intersection(exactOf(a), exactOf(b));
  return common && boost::get<Exact::Segment_3>(&*common) != nullptr;
}

// How far the corners of `a` are off the plane of `b` on the side where they are less.
double depthIn(const Corners& a, const Corners& b) {
  const auto normal = CGAL::cross_product(b[1] - b[0], b[2] - b[0]);
  double above = 0.0, below = 0.0;
  for (const Kernel::Point_3& corner : a) {
    const double off = normal * (corner - b[0]) / std::sqrt(normal.squared_length());
    above = std::max(above, off);
    below = std::max(below, -off);
  }
  return std::min(above, below);
}

}  // namespace

bool isClosedAndManifold(const std::vector<Vec3>& vertices,
                         const std::vector<MeshTriangle>& triangles) {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> faces;
  makeSoup(vertices, triangles, points, faces);
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) return false;
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, faces, mesh);
  return mesh.is_valid() && CGAL::is_closed(mesh);
}

double volumeInside(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles) {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> faces;
  makeSoup(vertices, triangles, points, faces);
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, faces, mesh);
  return pmp::volume(mesh);
}

Crossings crossingsOf(const std::vector<Vec3>& vertices,
                      const std::vector<MeshTriangle>& triangles) {
  using BoxOfTriangle = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
  std::vector<Corners> all;
  std::vector<BoxOfTriangle> boxes;
  for (const MeshTriangle& triangle : triangles) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = toPoint(vertices[at(triangle[i])]);
    if (CGAL::collinear(corners[0], corners[1], corners[2])) continue;  // has no inside
    all.push_back(corners);
    const CGAL::Bbox_3 box = corners[0].bbox() + corners[1].bbox() + corners[2].bbox();
    boxes.emplace_back(box, all.size() - 1);
  }
  Crossings crossings;
  CGAL::box_self_intersection_d(
      boxes.begin(), boxes.end(), [&](const auto& first, const auto& second) {
        const Corners &a = all[first.info()], &b = all[second.info()];
        if (!crosses(a, b)) return;
        ++crossings.pairs;
        crossings.depth = std::max(crossings.depth, std::min(depthIn(a, b), depthIn(b, a)));
      });
  return crossings;
}

}  // namespace robot_tissue
