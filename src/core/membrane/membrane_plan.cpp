#include "membrane/membrane_plan.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "geometry/connected_triangles.h"
#include "robot_tissue/core/triangle_point.h"

namespace robot_tissue {
namespace {

// Spacings between a triangle's middle and the triangle that it was part of before a cut: rounding.
// More: faces beside a thin wall count as that wall's.
constexpr double kSamePlace = 1e-3;

Vec3 middleOf(const TissueSurface& surface, int triangle) {
  const MeshTriangle& corners = surface.triangles[at(triangle)];
  return (surface.rest[at(corners[0])] + surface.rest[at(corners[1])] +
          surface.rest[at(corners[2])]) /
         3.0;
}

// Twice the area, outwards.
Vec3 normalOf(const TissueSurface& surface, int triangle) {
  return doubleArea(surface.rest, surface.triangles[at(triangle)]);
}

std::vector<std::vector<int>> connected(const TissueSurface& surface,
                                        const std::vector<int>& triangles) {
  return connectedTriangles(surface.triangles, triangles, surface.rest.size());
}

std::vector<int> allOf(const TissueSurface& surface) {
  std::vector<int> all(surface.triangles.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return all;
}

// Of what lies behind the triangles, or, < 0, in a cavity that they enclose (m^3).
double volumeBehind(const TissueSurface& surface, const std::vector<int>& triangles) {
  double volume = 0.0;
  const Vec3 origin = middleOf(surface, triangles.front());
  for (const int triangle : triangles) {
    volume += normalOf(surface, triangle).dot(middleOf(surface, triangle) - origin) / 6.0;
  }
  return volume;
}

// Every edge is run along both ways.
bool isClosed(const TissueSurface& surface, const std::vector<int>& triangles) {
  std::set<std::pair<int, int>> edges;
  for (const int triangle : triangles) {
    const MeshTriangle& corners = surface.triangles[at(triangle)];
    for (std::size_t i = 0; i < 3; ++i) edges.insert({corners[i], corners[(i + 1) % 3]});
  }
  return std::all_of(edges.begin(), edges.end(), [&](const std::pair<int, int>& edge) {
    return edges.count({edge.second, edge.first}) > 0;
  });
}

bool isIn(const std::vector<Box>& boxes, const Vec3& place) {
  return boxes.empty() || std::any_of(boxes.begin(), boxes.end(),
                                      [&](const Box& box) { return box.contains(place); });
}

using Parts = std::vector<std::vector<int>>;

std::vector<std::uint8_t> coveredBy(const MembraneConfig& membrane, const TissueSurface& surface,
                                    const Parts& parts) {
  using Side = MembraneConfig::Side;
  std::vector<std::uint8_t> covered(surface.triangles.size(), 0);
  for (const std::vector<int>& part : parts) {
    const bool is_inner = volumeBehind(surface, part) < 0.0;
    if (membrane.side == (is_inner ? Side::kOuter : Side::kInner)) continue;
    for (const int triangle : part) {
      covered[at(triangle)] = isIn(membrane.boxes, middleOf(surface, triangle)) ? 1 : 0;
    }
  }
  return covered;
}

[[noreturn]] void refuse(std::size_t membrane, const std::string& problem) {
  throw InputError("tissue.membranes[" + std::to_string(membrane) + "]." + problem);
}

}  // namespace

MembranePlan::MembranePlan(const std::vector<MembraneConfig>& membranes,
                           const TissueSurface& as_made, double spacing)
    : membranes_(membranes), as_made_(as_made), spacing_(spacing) {
  const Parts parts = connected(as_made_, allOf(as_made_));
  const bool has_cavity = std::any_of(parts.begin(), parts.end(), [&](const auto& part) {
    return volumeBehind(as_made_, part) < 0.0;
  });
  for (std::size_t i = 0; i < membranes_.size(); ++i) {
    const MembraneConfig& membrane = membranes_[i];
    if (membrane.side == MembraneConfig::Side::kInner && !has_cavity) {
      refuse(i, "side: inner, but the tissue has no cavity; allowed: all, outer");
    }
    covers_.push_back(coveredBy(membrane, as_made_, parts));
    if (std::count(covers_.back().begin(), covers_.back().end(), 1) == 0) {
      refuse(i, "boxes: hold the middle of no triangle of the surface; allowed: boxes that do");
    }
    if (membrane.pressure == 0.0) continue;
    if (membrane.side == MembraneConfig::Side::kAll && has_cavity) {
      refuse(i, "pressure: in the tissue or in its cavity? allowed: with side outer, or inner");
    }
    if (partOn(as_made_, i).pressed.empty()) {
      refuse(i, "pressure: the boxes leave no closed part of the surface; allowed: all of one");
    }
  }
  fillBins();
}

MembranePlan::Bin MembranePlan::binOf(const Vec3& place) const {
  Bin bin{};
  for (int axis = 0; axis < 3; ++axis) {
    bin[at(axis)] = static_cast<int>(std::floor(place[axis] / spacing_));
  }
  return bin;
}

void MembranePlan::fillBins() {
  for (const int triangle : allOf(as_made_)) {
    Box box;
    for (const int corner : as_made_.triangles[at(triangle)]) {
      box.extend(as_made_.rest[at(corner)]);
    }
    box = grownBy(kSamePlace * spacing_, box);
    const Bin low = binOf(box.min()), high = binOf(box.max());
    for (int i = low[0]; i <= high[0]; ++i) {
      for (int j = low[1]; j <= high[1]; ++j) {
        for (int k = low[2]; k <= high[2]; ++k) bins_[{i, j, k}].push_back(triangle);
      }
    }
  }
}

// The triangle as made that it was part of; -1: none, a cut made it.
int MembranePlan::madeFrom(const TissueSurface& surface, int triangle) const {
  if (surface.opened[at(triangle)] != 0) return -1;
  const Vec3 middle = middleOf(surface, triangle), normal = normalOf(surface, triangle);
  const auto bin = bins_.find(binOf(middle));
  if (bin == bins_.end()) return -1;
  int nearest = -1;
  double shortest = kSamePlace * spacing_;
  for (const int candidate : bin->second) {
    if (normalOf(as_made_, candidate).dot(normal) <= 0.0) continue;
    const MeshTriangle& numbers = as_made_.triangles[at(candidate)];
    const Corners corners = {as_made_.rest[at(numbers[0])], as_made_.rest[at(numbers[1])],
                             as_made_.rest[at(numbers[2])]};
    const double distance = (pointOf(corners, nearestInTriangle(middle, corners)) - middle).norm();
    if (distance >= shortest) continue;
    shortest = distance;
    nearest = candidate;
  }
  return nearest;
}

MembranePart MembranePlan::partOn(const TissueSurface& surface, std::size_t membrane) const {
  MembranePart part;
  part.law = sheetLaw(membranes_[membrane]);
  const bool is_as_made = surface.triangles == as_made_.triangles && surface.rest == as_made_.rest;
  for (const int triangle : allOf(surface)) {
    const int made_from = is_as_made ? triangle : madeFrom(surface, triangle);
    if (made_from >= 0 && covers_[membrane][at(made_from)] != 0) part.triangles.push_back(triangle);
  }
  part.pressure = membranes_[membrane].pressure;
  if (part.pressure == 0.0) return part;
  for (const std::vector<int>& shell : connected(surface, part.triangles)) {
    if (!isClosed(surface, shell)) continue;
    part.pressed.insert(part.pressed.end(), shell.begin(), shell.end());
    if (volumeBehind(surface, shell) < 0.0) part.pressure = -membranes_[membrane].pressure;
  }
  return part;
}

std::shared_ptr<const Membrane> MembranePlan::on(const TissueSurface& surface) const {
  std::vector<MembranePart> parts;
  for (std::size_t membrane = 0; membrane < membranes_.size(); ++membrane) {
    MembranePart part = partOn(surface, membrane);
    if (!part.triangles.empty()) parts.push_back(std::move(part));
  }
  return parts.empty() ? nullptr : std::make_shared<const Membrane>(surface, parts);
}

}  // namespace robot_tissue
