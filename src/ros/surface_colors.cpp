#include "robot_tissue/ros/surface_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/triangle_point.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

constexpr std::array<ColorMeaning, 4> kMeanings = {{{"none", "", ""},
                                                    {"displacement", "displacement", "mm"},
                                                    {"strain", "stretch of the surface", "%"},
                                                    {"pressure", "pressure of tools", "kPa"}}};
constexpr double kPercent = 100.0;
constexpr double kMillimeters = 1e3;   // in a meter
constexpr double kKilopascals = 1e-3;  // in a pascal

// ColorBrewer's YlOrRd (Brewer 2003): light to dark, told apart by the color-blind, too.
constexpr std::array<std::array<double, 3>, 5> kRamp = {{{1.00, 1.00, 0.80},
                                                         {1.00, 0.85, 0.46},
                                                         {0.99, 0.55, 0.24},
                                                         {0.89, 0.10, 0.11},
                                                         {0.50, 0.00, 0.15}}};
// Towards the light, unit: from above and before.
const Vec3 kLight(0.36, -0.48, 0.80);

Corners cornersOf(const std::vector<Vec3>& vertices, const MeshTriangle& triangle) {
  return {vertices[at(triangle[0])], vertices[at(triangle[1])], vertices[at(triangle[2])]};
}

// Where nodes have them (m): what is drawn at tools' edges is aside of that.
std::vector<Vec3> verticesOfNodes(const Tissue& tissue) {
  std::vector<Vec3> vertices;
  deform(tissue.surface(), tissue.shownDisplacement(), vertices);
  return vertices;
}

std::vector<double> displacements(const Tissue& tissue) {
  const std::vector<Vec3> vertices = verticesOfNodes(tissue);
  std::vector<double> values;
  values.reserve(vertices.size());
  for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
    const Vec3 way = vertices[vertex] - tissue.surface().rest[vertex];
    values.push_back(kMillimeters * way.norm());
  }
  return values;
}

// First fundamental form: scalar products of two sides.
Eigen::Matrix2d metricOf(const Corners& corners) {
  const Vec3 side = corners[1] - corners[0], other = corners[2] - corners[0];
  Eigen::Matrix2d metric;
  metric << side.dot(side), side.dot(other), side.dot(other), other.dot(other);
  return metric;
}

// The greatest eigenvalue of (rest metric)^-1 (metric) is the square of the stretch.
double greatestStretch(const Corners& rest, const Corners& now) {
  const Eigen::Matrix2d rest_metric = metricOf(rest);
  if (!(rest_metric.determinant() > 0.0)) return 1.0;
  const Eigen::Matrix2d change = rest_metric.inverse() * metricOf(now);
  const double mean = 0.5 * change.trace();
  return std::sqrt(mean + std::sqrt(std::max(mean * mean - change.determinant(), 0.0)));
}

std::vector<double> strains(const Tissue& tissue) {
  const TissueSurface& surface = tissue.surface();
  const std::vector<Vec3> vertices = verticesOfNodes(tissue);
  std::vector<double> values(surface.rest.size(), 0.0), areas(surface.rest.size(), 0.0);
  for (const MeshTriangle& triangle : surface.triangles) {
    const double area = doubleArea(surface.rest, triangle).norm();
    const double strain =
        greatestStretch(cornersOf(surface.rest, triangle), cornersOf(vertices, triangle)) - 1.0;
    for (const int vertex : triangle) {
      values[at(vertex)] += kPercent * area * strain;
      areas[at(vertex)] += area;
    }
  }
  for (std::size_t vertex = 0; vertex < values.size(); ++vertex) {
    if (areas[vertex] > 0.0) values[vertex] /= areas[vertex];
  }
  return values;
}

std::vector<ToolTouch> pressingTouches(const Pipeline& pipeline) {
  std::vector<ToolTouch> pressing;
  for (std::size_t tool = 0; tool < pipeline.tools().size() && pipeline.pose(); ++tool) {
    for (const ToolTouch& touch : pipeline.touchesOf(tool)) {
      if (touch.normal_force > 0.0) pressing.push_back(touch);
    }
  }
  return pressing;
}

// Whose box reaches into the box around the touches: each of these is on one of them.
std::vector<MeshTriangle> trianglesAround(const std::vector<ToolTouch>& touches,
                                          const Tissue& tissue) {
  Box around;
  for (const ToolTouch& touch : touches) around.extend(touch.point);
  const Box near = grownBy(tissue.lattice().spacing(), around);
  std::vector<MeshTriangle> triangles;
  for (const MeshTriangle& triangle : tissue.surface().triangles) {
    Box box;
    for (const int vertex : triangle) box.extend(tissue.vertices()[at(vertex)]);
    if (box.intersects(near)) triangles.push_back(triangle);
  }
  return triangles;
}

// Shares the force among the corners of the triangle that the point is on.
void addForce(const Tissue& tissue, const std::vector<MeshTriangle>& triangles, const Vec3& point,
              double force, std::vector<double>& forces) {
  double nearest = std::numeric_limits<double>::infinity();
  MeshTriangle found{};
  Vec3 shares = Vec3::Zero();
  for (const MeshTriangle& triangle : triangles) {
    const Corners corners = cornersOf(tissue.vertices(), triangle);
    const Vec3 weights = nearestInTriangle(point, corners);
    const double distance = (pointOf(corners, weights) - point).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    found = triangle;
    shares = weights;
  }
  for (int k = 0; k < 3; ++k) forces[at(found[at(k)])] += shares[k] * force;
}

std::vector<double> pressures(const Pipeline& pipeline) {
  const Tissue& tissue = pipeline.tissue();
  std::vector<double> values(tissue.vertices().size(), 0.0);
  const std::vector<ToolTouch> touches = pressingTouches(pipeline);
  if (touches.empty()) return values;
  const std::vector<MeshTriangle> near = trianglesAround(touches, tissue);
  for (const ToolTouch& touch : touches) {
    addForce(tissue, near, touch.point, touch.normal_force, values);
  }
  std::vector<double> areas(values.size(), 0.0);
  for (const MeshTriangle& triangle : tissue.surface().triangles) {
    const double share = doubleArea(tissue.vertices(), triangle).norm() / 6.0;
    for (const int vertex : triangle) areas[at(vertex)] += share;
  }
  for (std::size_t vertex = 0; vertex < values.size(); ++vertex) {
    if (areas[vertex] > 0.0) values[vertex] *= kKilopascals / areas[vertex];
  }
  return values;
}

}  // namespace

const ColorMeaning& meaningOf(ColorBy color) { return kMeanings[static_cast<std::size_t>(color)]; }

std::optional<ColorBy> colorByName(const std::string& name) {
  for (std::size_t i = 0; i < kMeanings.size(); ++i) {
    if (name == kMeanings[i].name) return static_cast<ColorBy>(i);
  }
  return {};
}

std::vector<std::string> colorNames() {
  std::vector<std::string> names;
  names.reserve(kMeanings.size());
  for (const ColorMeaning& each : kMeanings) names.emplace_back(each.name);
  return names;
}

std::vector<double> surfaceValues(ColorBy color, const Pipeline& pipeline) {
  switch (color) {
    case ColorBy::kDisplacement:
      return displacements(pipeline.tissue());
    case ColorBy::kStrain:
      return strains(pipeline.tissue());
    case ColorBy::kPressure:
      return pressures(pipeline);
    case ColorBy::kNone:
      break;
  }
  return {};
}

double scaleFor(const std::vector<double>& values, double present) {
  const double most = values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
  if (most <= present && most > tuning::kScaleInUse * present) return present;
  if (!(most > tuning::kLeastScale)) return tuning::kLeastScale;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (most <= step * power) return step * power;
  }
  return 10.0 * power;
}

std_msgs::ColorRGBA colorOf(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(kRamp.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
  const double rest = place - static_cast<double>(low);
  const auto channel = [&](std::size_t k) {
    return static_cast<float>((1.0 - rest) * kRamp[low][k] + rest * kRamp[low + 1][k]);
  };
  std_msgs::ColorRGBA color;
  color.r = channel(0);
  color.g = channel(1);
  color.b = channel(2);
  color.a = 1.0F;
  return color;
}

std_msgs::ColorRGBA litColorOf(double share, const Vec3& normal) {
  const double facing = 0.5 * (1.0 + normal.dot(kLight));
  const auto light = static_cast<float>(tuning::kDarkest + (1.0 - tuning::kDarkest) * facing);
  std_msgs::ColorRGBA color = colorOf(share);
  color.r *= light;
  color.g *= light;
  color.b *= light;
  return color;
}

}  // namespace robot_tissue
