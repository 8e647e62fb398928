// A simple polygon as triangles.
#pragma once

#include <vector>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

// Of a triangle: twice its area over the square of its longest side (1).
double fullness(const Vec3& a, const Vec3& b, const Vec3& c);

// Triangles by the polygon's corners, turned as it is, and the least fullness of any of them.
struct PolygonTriangles {
  std::vector<MeshTriangle> triangles;
  double thinnest = 0.0;
};

// Corners in order, counter-clockwise seen from where the normal points; flat, a dozen or two at
// most (the work goes with the cube of their number). The thinnest triangle is as little so as can
// be (Klincsek 1980). No triangles: the polygon crosses itself, or has fewer than three corners.
PolygonTriangles polygonTriangles(const std::vector<Vec3>& corners, const Vec3& normal);

}  // namespace robot_tissue
