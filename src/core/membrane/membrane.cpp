#include "membrane/membrane.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "membrane/bending_parts.h"

namespace robot_tissue {
namespace {

// Of the mean area of a membrane's triangles (1): what cuts leave that is smaller counts for
// nothing, and its shape is rounding.
constexpr double kNoArea = 1e-7;

template <typename Law>
typename Law::Corners placesAt(const std::array<int, 4>& vertices,
                               const std::vector<Vec3>& places) {
  typename Law::Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = places[at(vertices[i])];
  return corners;
}

// Where the corners are that an element with this law has.
template <typename Law>
typename Law::Corners cornersOf(const Law&, const std::array<int, 4>& vertices,
                                const std::vector<Vec3>& places) {
  return placesAt<Law>(vertices, places);
}

template <typename Law>
constexpr std::size_t countOf(const Law&) {
  return std::tuple_size<typename Law::Corners>::value;
}

double areaOf(const TissueSurface& surface, int triangle) {
  return 0.5 * doubleArea(surface.rest, surface.triangles[at(triangle)]).norm();
}

// Those with an area.
std::vector<int> sheetOf(const TissueSurface& surface, const MembranePart& part) {
  double area = 0.0;
  for (const int triangle : part.triangles) area += areaOf(surface, triangle);
  const double least = kNoArea * area / static_cast<double>(part.triangles.size());
  std::vector<int> sheet;
  for (const int triangle : part.triangles) {
    if (areaOf(surface, triangle) > least) sheet.push_back(triangle);
  }
  return sheet;
}

}  // namespace

Membrane::Membrane(const TissueSurface& surface, const std::vector<MembranePart>& parts) {
  take(surface, parts);
  bindKernel();
  bindNodes(surface);
  makePattern();
  const std::vector<Vec3> rest = placesOf(std::vector<Vec3>(nodes_.size(), Vec3::Zero()));
  rounding_.assign(rest_.size(), Vec3::Zero());
  sheet_.addForces(rest, rounding_);
  NodeBlocks stiffness = pattern_;
  findStiffness(std::vector<Vec3>(nodes_.size(), Vec3::Zero()), Curvature::kConvex, stiffness);
  for (const Eigen::Matrix3d& own : carriers_.diagonal(stiffness)) {
    rest_stiffness_.push_back(own.trace() / 3.0);
  }
}

// Elements with the surface's vertices, which are then numbered anew.
void Membrane::take(const TissueSurface& surface, const std::vector<MembranePart>& parts) {
  for (const MembranePart& part : parts) {
    addSheet(surface, part);
    addHinges(surface, part);
    for (const int triangle : part.pressed) {
      const MeshTriangle& corners = surface.triangles[at(triangle)];
      const Vec3& origin = surface.rest[at(surface.triangles[at(part.pressed.front())][0])];
      elements_.push_back(
          {PressedTriangle(part.pressure, origin), {corners[0], corners[1], corners[2], -1}});
    }
  }
  std::vector<int> number(surface.rest.size(), -1);
  for (Element& element : elements_) {
    for (int& vertex : element.vertices) {
      if (vertex < 0) continue;
      if (number[at(vertex)] < 0) {
        number[at(vertex)] = static_cast<int>(rest_.size());
        rest_.push_back(surface.rest[at(vertex)]);
        vertex_of_surface_.push_back(vertex);
      }
      vertex = number[at(vertex)];
    }
  }
}

void Membrane::bindKernel() {
  for (std::size_t number = 0; number < elements_.size(); ++number) {
    const Element& element = elements_[number];
    const auto& [a, b, c, d] = element.vertices;
    if (const auto* triangle = std::get_if<StretchedTriangle>(&element.law)) {
      sheet_.add(*triangle, {a, b, c});
    } else if (const auto* hinge = std::get_if<Hinge>(&element.law)) {
      sheet_.add(*hinge, {a, b, c, d});
    } else {
      pressed_.push_back(static_cast<int>(number));
    }
  }
}

void Membrane::addSheet(const TissueSurface& surface, const MembranePart& part) {
  for (const int triangle : sheetOf(surface, part)) {
    const MeshTriangle& corners = surface.triangles[at(triangle)];
    const StretchedTriangle law(
        part.law,
        {surface.rest[at(corners[0])], surface.rest[at(corners[1])], surface.rest[at(corners[2])]});
    elements_.push_back({law, {corners[0], corners[1], corners[2], -1}});
  }
}

void Membrane::addHinges(const TissueSurface& surface, const MembranePart& part) {
  std::vector<MeshTriangle> sheet;
  for (const int triangle : sheetOf(surface, part))
    sheet.push_back(surface.triangles[at(triangle)]);
  for (const std::array<int, 4>& corners : bendingEdges(surface.rest, sheet)) {
    const Hinge law(part.law.bending, placesAt<Hinge>(corners, surface.rest));
    elements_.push_back({law, corners});
  }
}

void Membrane::bindNodes(const TissueSurface& surface) {
  for (const int vertex : vertex_of_surface_) {
    for (const NodeWeight& carrier : surface.carriers[at(vertex)]) nodes_.push_back(carrier.node);
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  std::vector<VertexCarriers::Shares> of_vertices;
  for (const int vertex : vertex_of_surface_) {
    const CarrierRange carriers = surface.carriers[at(vertex)];
    of_vertices.emplace_back(carriers.begin(), carriers.end());
    for (NodeWeight& carrier : of_vertices.back()) {
      const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), carrier.node);
      carrier.node = static_cast<int>(found - nodes_.begin());
    }
  }
  carriers_ = VertexCarriers(static_cast<int>(nodes_.size()), of_vertices);
  elements_at_.resize(nodes_.size());
  for (std::size_t element = 0; element < elements_.size(); ++element) {
    for (const int vertex : elements_[element].vertices) {
      if (vertex < 0) continue;
      for (const NodeWeight* share = carriers_.begin(vertex); share != carriers_.end(vertex);
           ++share) {
        std::vector<int>& there = elements_at_[at(share->node)];
        const int number = static_cast<int>(element);
        if (there.empty() || there.back() != number) there.push_back(number);
      }
    }
  }
}

void Membrane::makePattern() {
  std::vector<std::pair<int, int>> pairs;
  for (const Element& element : elements_) {
    for (const int row : element.vertices) {
      for (const int column : element.vertices) {
        if (row >= 0 && column >= 0) pairs.emplace_back(row, column);
      }
    }
  }
  pattern_ = NodeBlocks(static_cast<int>(rest_.size()), std::move(pairs));
  for (const Element& element : elements_) {
    for (const int row : element.vertices) {
      for (const int column : element.vertices) {
        if (row >= 0 && column >= 0) places_.push_back(pattern_.place(row, column));
      }
    }
  }
}

std::vector<Vec3> Membrane::ofNodes(const std::vector<Vec3>& displacement) const {
  std::vector<Vec3> moved;
  moved.reserve(nodes_.size());
  for (const int node : nodes_) moved.push_back(displacement[at(node)]);
  return moved;
}

std::vector<Vec3> Membrane::placesOf(const std::vector<Vec3>& moved) const {
  std::vector<Vec3> places = carriers_.toVertices(moved);
  for (std::size_t vertex = 0; vertex < places.size(); ++vertex) places[vertex] += rest_[vertex];
  return places;
}

double Membrane::energy(const std::vector<Vec3>& moved) const {
  const std::vector<Vec3> places = placesOf(moved);
  double energy = 0.0;
  for (const Element& element : elements_) {
    energy += std::visit(
        [&](const auto& law) { return law.energy(cornersOf(law, element.vertices, places)); },
        element.law);
  }
  return energy;
}

void Membrane::addPressure(const std::vector<Vec3>& places, std::vector<Vec3>& on_vertices) const {
  for (const int number : pressed_) {
    const Element& element = elements_[at(number)];
    const auto& law = std::get<PressedTriangle>(element.law);
    const auto gradient = law.gradient(cornersOf(law, element.vertices, places));
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      on_vertices[at(element.vertices[i])] -= gradient[i];
    }
  }
}

// At rest, without a pressure, there is none, to the last bit: methods see that nothing is to do.
std::vector<Vec3> Membrane::forces(const std::vector<Vec3>& moved) const {
  const std::vector<Vec3> places = placesOf(moved);
  std::vector<Vec3> on_vertices(rest_.size(), Vec3::Zero());
  sheet_.addForces(places, on_vertices);
  for (std::size_t i = 0; i < rounding_.size(); ++i) on_vertices[i] -= rounding_[i];
  addPressure(places, on_vertices);
  return carriers_.toCarriers(on_vertices);
}

Vec3 Membrane::force(const std::vector<Vec3>& displacement, int node) const {
  Vec3 force = Vec3::Zero();
  const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), node);
  if (found == nodes_.end() || *found != node) return force;
  const int own = static_cast<int>(found - nodes_.begin());
  std::vector<Vec3> places(4);
  for (const int number : elements_at_[at(own)]) {
    const Element& element = elements_[at(number)];
    std::visit(
        [&](const auto& law) {
          for (std::size_t i = 0; i < countOf(law); ++i) {
            places[i] = rest_[at(element.vertices[i])];
            for (const NodeWeight* share = carriers_.begin(element.vertices[i]);
                 share != carriers_.end(element.vertices[i]); ++share) {
              places[i] += share->weight * displacement[at(nodes_[at(share->node)])];
            }
          }
          const auto gradient = law.gradient(cornersOf(law, {0, 1, 2, 3}, places));
          for (std::size_t i = 0; i < countOf(law); ++i) {
            force -= carriers_.weight(element.vertices[i], own) * gradient[i];
          }
        },
        element.law);
  }
  return force;
}

double Membrane::pressureNorm(const std::vector<Vec3>& moved) const {
  std::vector<Vec3> on_vertices(rest_.size(), Vec3::Zero());
  addPressure(placesOf(moved), on_vertices);
  double squared = 0.0;
  for (const Vec3& force : carriers_.toCarriers(on_vertices)) squared += force.squaredNorm();
  return std::sqrt(squared);
}

void Membrane::findStiffness(const std::vector<Vec3>& moved, Curvature curvature,
                             NodeBlocks& of_vertices) const {
  const std::vector<Vec3> places = placesOf(moved);
  of_vertices.clear();
  auto place = places_.begin();
  for (const Element& element : elements_) {
    std::visit(
        [&](const auto& law) {
          const auto hessian = law.hessian(cornersOf(law, element.vertices, places), curvature);
          const int count = static_cast<int>(countOf(law));
          for (int i = 0; i < count; ++i) {
            for (int j = 0; j < count; ++j) {
              of_vertices.block(*place++) += hessian.template block<3, 3>(3 * i, 3 * j);
            }
          }
        },
        element.law);
  }
}

double Membrane::restStiffness(int node) const {
  const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), node);
  const bool is_there = found != nodes_.end() && *found == node;
  return is_there ? rest_stiffness_[static_cast<std::size_t>(found - nodes_.begin())] : 0.0;
}

}  // namespace robot_tissue
