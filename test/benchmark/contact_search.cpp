// What finding contacts costs, without any solve. Prints CSV, a row a tool and a surface, for
// scripts/study contact_search; doc/contact_measured.md quotes it. Not a test: nothing here passes
// or fails.
//
//   contact_search CELLS [TOOL]     (of the block of 100 x 100 x 50 mm along its length, even)
//
// Times are the processor's, of one search with all of the surface and the tools a little
// elsewhere than before. The last column sums up all that was found, to compare two states with.
#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "robot_tissue/contact/contact_finder.h"
#include "timing.h"
#include "tool_meshes.h"

namespace robot_tissue {
namespace {

constexpr int kSearches = 60;
constexpr double kWay = 2.5e-4;  // of the tools from search to search (m)
constexpr double kDent = 0.006;  // m
constexpr double kMargin = 0.3;  // of the spacing, as the pipeline's

// The closed surface of a block on the plane z = 0, outside outwards.
TissueSurface blockSurface(const std::array<int, 3>& cells, double spacing) {
  TissueSurface surface;
  std::map<std::array<int, 3>, int> numbers;
  const auto vertex = [&](const std::array<int, 3>& node) {
    const auto [known, is_new] = numbers.try_emplace(node, static_cast<int>(surface.rest.size()));
    if (is_new) surface.rest.push_back(spacing * Vec3(node[0], node[1], node[2]));
    return known->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int side : {0, cells[axis]}) {
      for (int i = 0; i < cells[u]; ++i) {
        for (int j = 0; j < cells[v]; ++j) {
          std::array<int, 4> quad{};
          for (std::size_t k = 0; k < 4; ++k) {
            std::array<int, 3> node{};
            node[axis] = side;
            node[u] = i + (k == 1 || k == 2 ? 1 : 0);
            node[v] = j + (k >= 2 ? 1 : 0);
            quad[k] = vertex(node);
          }
          if (side == 0) std::swap(quad[1], quad[3]);
          surface.triangles.push_back({{quad[0], quad[1], quad[2]}});
          surface.triangles.push_back({{quad[0], quad[2], quad[3]}});
        }
      }
    }
  }
  surface.revision = 1;
  surface.opened.assign(surface.triangles.size(), 0);
  return surface;
}

// Pressed in around a place of its top.
std::vector<Vec3> dented(const TissueSurface& surface, const Vec3& place) {
  constexpr double kWidth = 0.02;
  std::vector<Vec3> vertices = surface.rest;
  for (Vec3& vertex : vertices) {
    const double away = (vertex - place).head<2>().squaredNorm() / (kWidth * kWidth);
    vertex.z() -= kDent * std::exp(-away) * vertex.z() / place.z();
  }
  return vertices;
}

struct Case {
  std::string name;
  std::vector<ToolGeometry> tools;
  std::vector<Vec3> links;  // origins from the place that is pressed (m)
};

ToolShape mesh(const std::string& resource) {
  ToolShape shape;
  shape.type = ToolShape::Type::kMesh;
  shape.resource = resource;
  return shape;
}

ToolGeometry toolOf(const std::string& name, const ToolShape& shape) {
  ToolGeometry tool;
  tool.name = name;
  tool.links.push_back({name, {shape}});
  return tool;
}

std::vector<Case> cases() {
  const Vec3 on_top(0.0, 0.0, 0.01 - kDent - 0.001);
  const auto one = [&](const std::string& name, const ToolShape& shape) {
    return Case{name, {toolOf(name, shape)}, {on_top}};
  };
  ToolShape sphere, cylinder, box;
  sphere.radius = 0.01;
  cylinder.type = ToolShape::Type::kCylinder;
  cylinder.radius = 0.01;
  cylinder.length = 0.04;
  cylinder.pose.linear() =
      Eigen::AngleAxisd(0.5 * M_PI, Vec3(1.0, 0.3, 0.0).normalized()).toRotationMatrix();
  box.type = ToolShape::Type::kBox;
  box.size = Vec3::Constant(0.02);
  const ToolShape ellipsoid = mesh(writeEllipsoid({0.012, 0.01, 0.01}));
  const ToolShape ring = mesh(writeRing(0.014, 0.005));
  std::vector<Case> all = {one("sphere", sphere), one("cylinder", cylinder), one("box", box),
                           one("mesh ball", ellipsoid), one("mesh ring", ring)};
  Case arm{"arm of ten meshes", {}, {}};
  for (int link = 0; link < 10; ++link) {
    const std::string name = "link" + std::to_string(link);
    arm.tools.push_back(toolOf(name, ring));
    arm.links.push_back(on_top + 0.04 * link * Vec3(0.5, 0.2, 1.0));
  }
  all.push_back(arm);
  return all;
}

double summed(const ContactSet& found) {
  double sum = 0.0;
  for (const Contact& contact : found.contacts) {
    sum += contact.depth_m + contact.point.sum() + contact.normal.dot(Vec3(1.0, 2.0, 3.0)) +
           contact.place.triangle + 1e3 * contact.link;
  }
  return sum;
}

void measure(const Case& scene, const TissueSurface& surface, double spacing) {
  const ContactFinder finder(scene.tools);
  std::vector<double> search, depth;
  std::size_t contacts = 0;
  double sum = 0.0;
  for (int i = 0; i < kSearches; ++i) {
    const Vec3 place(0.04 + kWay * i, 0.047, 0.05);
    RobotPose pose;
    for (const Vec3& origin : scene.links) {
      pose.links.push_back(Pose::Identity());
      pose.links.back().translation() = place + origin;
    }
    const std::vector<Vec3> vertices = dented(surface, place);
    const double begin = 1e3 * processorMs();
    const ContactSet found = finder.find(pose, surface, vertices, kMargin * spacing);
    const double end = 1e3 * processorMs();
    const double deepest = finder.penetrations({0}, pose, surface, vertices)[0];
    search.push_back(end - begin);
    depth.push_back(1e3 * processorMs() - end);
    contacts += found.contacts.size();
    sum += summed(found) + deepest;
  }
  const auto median = [](std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + kSearches / 2, values.end());
    return values[kSearches / 2];
  };
  std::printf("%s,%zu,%.1f,%.1f,%.1f,%.15g\n", scene.name.c_str(), surface.triangles.size(),
              static_cast<double>(contacts) / kSearches, median(search), median(depth), sum);
}

int run(int cells, const std::string& only) {
  const double spacing = 0.1 / cells;
  const TissueSurface surface = blockSurface({cells, cells, cells / 2}, spacing);
  std::printf("tool,triangles,contacts,search_us,penetration_us,sum\n");
  for (const Case& scene : cases()) {
    if (only.empty() || scene.name == only) measure(scene, surface, spacing);
  }
  return 0;
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::fprintf(stderr, "usage: contact_search CELLS [TOOL]\n");
    return 2;
  }
  return robot_tissue::run(std::atoi(argv[1]), argc == 3 ? argv[2] : "");
}
