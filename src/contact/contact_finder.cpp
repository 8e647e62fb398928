#include "robot_tissue/contact/contact_finder.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "collision_shape.h"
#include "triangle_samples.h"

namespace robot_tissue {
namespace {

// An edge or a corner of a tool presses between samples by up to their distance.
constexpr int kEdgeSubdivisions = 4;
constexpr double kRigidSlack = 1e-6;

bool isRigid(const Pose& pose) {
  if (!pose.matrix().allFinite()) return false;
  const Eigen::Matrix3d rotation = pose.linear();
  return (rotation.transpose() * rotation).isIdentity(kRigidSlack) && rotation.determinant() > 0.0;
}

// A shape where it is now.
struct PlacedShape {
  const CollisionShape* shape = nullptr;
  Pose tissue_T_shape = Pose::Identity();
  Pose shape_T_tissue = Pose::Identity();
};

struct Tool {
  std::vector<CollisionShape> shapes;
  double sample_spacing = 0.0;  // m
  int least_subdivisions = 1;   // of a triangle's edge
};

Box emptyBox() {
  const double infinity = std::numeric_limits<double>::infinity();
  return {Vec3::Constant(infinity), Vec3::Constant(-infinity)};
}

// Grows `box` by the axis-aligned box around a placed shape.
void growBy(const PlacedShape& placed, Box& box) {
  const Box& bounds = placed.shape->bounds();
  const Vec3 center = placed.tissue_T_shape * Vec3(0.5 * (bounds.min + bounds.max));
  const Vec3 reach = placed.tissue_T_shape.linear().cwiseAbs() * (0.5 * (bounds.max - bounds.min));
  box.min = box.min.cwiseMin(center - reach);
  box.max = box.max.cwiseMax(center + reach);
}

// One bit for each side of the box that the point is beyond.
std::uint8_t sidesBeyond(const Vec3& point, const Box& box) {
  unsigned sides = 0;
  for (int axis = 0; axis < 3; ++axis) {
    sides |= (point[axis] < box.min[axis] ? 1U : 0U) << (2 * axis);
    sides |= (point[axis] > box.max[axis] ? 1U : 0U) << (2 * axis + 1);
  }
  return static_cast<std::uint8_t>(sides);
}

// The deepest of the tool's shapes at a point; normal in the tissue frame.
std::optional<WayOut> deepest(const std::vector<PlacedShape>& shapes, const Vec3& point) {
  std::optional<WayOut> best;
  for (const PlacedShape& placed : shapes) {
    const auto out = placed.shape->wayOut(placed.shape_T_tissue * point);
    if (!out || (best && out->depth_m <= best->depth_m)) continue;
    best = WayOut{out->depth_m, placed.tissue_T_shape.linear() * out->normal};
  }
  return best;
}

bool hasEdges(const ToolGeometry& geometry) {
  return std::any_of(geometry.shapes.begin(), geometry.shapes.end(),
                     [](const ToolShape& shape) { return shape.type != ToolShape::Type::kSphere; });
}

// Into the tissue: for a point that every way leads out of the tool alike.
Vec3 inward(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 area = (b - a).cross(c - a);
  const double length = area.norm();
  return length > 0.0 ? Vec3(-area / length) : Vec3(-Vec3::UnitZ());
}

}  // namespace

struct ContactFinder::Impl {
  std::vector<Tool> tools;
  double touch_margin = 0.0;  // m, part of the shapes' padding
  std::vector<std::string> warnings;

  // Scratch, kept to spare allocations.
  std::vector<PlacedShape> placed;
  std::vector<Vec3> centers;               // of the placed shapes, tissue frame (m)
  std::vector<std::uint8_t> beyond;        // per vertex: sidesBeyond() the tool's box
  std::vector<std::uint8_t> vertex_asked;  // per vertex, 1 = tested against this tool
  std::vector<Vec3> samples;

  void place(const Tool& tool, const Pose& tissue_T_tool, const std::vector<Vec3>& vertices);
  void findOnTriangle(int tool, int triangle, const Surface& surface,
                      const std::vector<Vec3>& vertices, ContactSet& found);
};

ContactFinder::~ContactFinder() = default;
ContactFinder::ContactFinder(ContactFinder&&) noexcept = default;
ContactFinder& ContactFinder::operator=(ContactFinder&&) noexcept = default;

ContactFinder::ContactFinder(const std::vector<ToolGeometry>& tools, double touch_margin)
    : impl_(std::make_unique<Impl>()) {
  impl_->touch_margin = touch_margin;
  for (const ToolGeometry& geometry : tools) {
    Tool tool;
    double thinnest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < geometry.shapes.size(); ++i) {
      const std::string owner = "tool '" + geometry.name + "', shape " + std::to_string(i + 1);
      tool.shapes.emplace_back(geometry.shapes[i], geometry.padding + touch_margin, owner,
                               impl_->warnings);
      thinnest = std::min(thinnest, tool.shapes.back().thickness());
    }
    tool.sample_spacing = 0.5 * thinnest;
    if (hasEdges(geometry)) tool.least_subdivisions = kEdgeSubdivisions;
    impl_->tools.push_back(std::move(tool));
  }
}

double ContactFinder::reach(std::size_t tool) const {
  double farthest = 0.0;
  for (const CollisionShape& shape : impl_->tools[tool].shapes) {
    const Vec3 corner = shape.bounds().min.cwiseAbs().cwiseMax(shape.bounds().max.cwiseAbs());
    farthest = std::max(farthest, shape.poseInLink().translation().norm() + corner.norm());
  }
  return farthest;
}

Vec3 ContactFinder::center(std::size_t tool) const {
  Vec3 sum = Vec3::Zero();
  const auto& shapes = impl_->tools[tool].shapes;
  for (const CollisionShape& shape : shapes) sum += shape.poseInLink().translation();
  return shapes.empty() ? sum : Vec3(sum / static_cast<double>(shapes.size()));
}

const std::vector<std::string>& ContactFinder::warnings() const { return impl_->warnings; }

ContactSet ContactFinder::find(const RobotPose& pose, const Surface& surface,
                               const std::vector<Vec3>& vertices) {
  if (pose.tools.size() != impl_->tools.size()) {
    throw InputError("robot pose: has " + std::to_string(pose.tools.size()) +
                     " tools; allowed is one for each of the " +
                     std::to_string(impl_->tools.size()) + " tools of the scene");
  }
  if (vertices.size() != surface.rest.size()) {
    throw InputError("surface: has " + std::to_string(vertices.size()) +
                     " deformed vertices; allowed is one for each of its " +
                     std::to_string(surface.rest.size()) + " vertices");
  }
  ContactSet found;
  for (std::size_t t = 0; t < impl_->tools.size(); ++t) {
    const Tool& tool = impl_->tools[t];
    if (tool.shapes.empty() || !isRigid(pose.tools[t])) continue;
    impl_->place(tool, pose.tools[t], vertices);
    for (std::size_t k = 0; k < surface.triangles.size(); ++k) {
      impl_->findOnTriangle(static_cast<int>(t), static_cast<int>(k), surface, vertices, found);
    }
  }
  return found;
}

// Broad phase: the tool's shapes where they are now, and which vertices are out of their box.
void ContactFinder::Impl::place(const Tool& tool, const Pose& tissue_T_tool,
                                const std::vector<Vec3>& vertices) {
  placed.clear();
  centers.clear();
  Box box = emptyBox();
  for (const CollisionShape& shape : tool.shapes) {
    PlacedShape at{&shape, tissue_T_tool * shape.poseInLink(), Pose::Identity()};
    at.shape_T_tissue = at.tissue_T_shape.inverse();
    growBy(at, box);
    centers.push_back(at.tissue_T_shape * Vec3(0.5 * (shape.bounds().min + shape.bounds().max)));
    placed.push_back(at);
  }
  beyond.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) beyond[i] = sidesBeyond(vertices[i], box);
  vertex_asked.assign(vertices.size(), 0);
}

void ContactFinder::Impl::findOnTriangle(int tool, int triangle, const Surface& surface,
                                         const std::vector<Vec3>& vertices, ContactSet& found) {
  const auto& corners = surface.triangles[static_cast<std::size_t>(triangle)];
  const auto a_index = static_cast<std::size_t>(corners[0]);
  const auto b_index = static_cast<std::size_t>(corners[1]);
  const auto c_index = static_cast<std::size_t>(corners[2]);
  if ((beyond[a_index] & beyond[b_index] & beyond[c_index]) != 0) return;
  const Vec3& a = vertices[a_index];
  const Vec3& b = vertices[b_index];
  const Vec3& c = vertices[c_index];
  if (!(a.allFinite() && b.allFinite() && c.allFinite())) return;

  const auto ask = [&](const Vec3& weights) {
    const Vec3 point = weights[0] * a + weights[1] * b + weights[2] * c;
    const auto out = deepest(placed, point);
    if (!out) return;
    const Vec3 normal = out->normal.isZero() ? inward(a, b, c) : out->normal;
    found.contacts.push_back({tool, triangle, weights, point, normal, out->depth_m - touch_margin});
  };
  for (int k = 0; k < 3; ++k) {
    const auto vertex = static_cast<std::size_t>(corners[static_cast<std::size_t>(k)]);
    if (vertex_asked[vertex] != 0) continue;
    vertex_asked[vertex] = 1;
    if (beyond[vertex] == 0) ask(Vec3::Unit(k));
  }
  const Tool& asking = tools[static_cast<std::size_t>(tool)];
  const SampleGrid grid{asking.sample_spacing, asking.least_subdivisions};
  sampleTriangle(corners, vertices, grid, centers, samples);
  for (const Vec3& weights : samples) ask(weights);
}

}  // namespace robot_tissue
