#include "probe.h"

#include "ladder.h"
#include "robot_tissue/scene/value_text.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

const std::string kPatchName = "probe";
const std::string kHeldName = "probe_hold";

struct Face {
  int axis = 2;
  bool upper = true;

  double sign() const { return upper ? 1.0 : -1.0; }
  Vec3 outwards() const { return sign() * Vec3::Unit(axis); }
  double coordinate(const Box& box) const { return upper ? box.max()[axis] : box.min()[axis]; }
  Face opposite() const { return {axis, !upper}; }
};

// Measured in extents of the tissue.
Face farthestFromFixed(const TissueConfig& tissue, const Box& bounds) {
  if (tissue.fixed.empty()) return {};
  Vec3 center = Vec3::Zero();
  for (const Box& box : tissue.fixed) {
    const Vec3 inside = 0.5 * (box.min().cwiseMax(bounds.min()) + box.max().cwiseMin(bounds.max()));
    center += inside / static_cast<double>(tissue.fixed.size());
  }
  Face farthest;
  double distance = -1.0;
  for (const int axis : {2, 1, 0}) {
    for (const bool upper : {true, false}) {
      const Face face{axis, upper};
      const double extent = bounds.max()[axis] - bounds.min()[axis];
      const double away = face.sign() * (face.coordinate(bounds) - center[axis]) / extent;
      if (away <= distance + tuning::kBeyond) continue;
      distance = away;
      farthest = face;
    }
  }
  return farthest;
}

// Nodes of the outermost `share` of the extent at a face, in the middle part of its edges.
PatchConfig patchAt(const Face& face, const Box& bounds, double middle, double share) {
  const Vec3 extent = bounds.max() - bounds.min();
  PatchConfig patch;
  patch.box.min() = bounds.min() + 0.5 * (1.0 - middle) * extent;
  patch.box.max() = bounds.max() - 0.5 * (1.0 - middle) * extent;
  const double edge = face.coordinate(bounds);
  const double depth = (share + tuning::kBeyond) * extent[face.axis];
  patch.box.min()[face.axis] = face.upper ? edge - depth : edge - extent[face.axis];
  patch.box.max()[face.axis] = face.upper ? edge + extent[face.axis] : edge + depth;
  patch.displacement = {{0.0, 0.0, 0.0}};
  return patch;
}

PatchConfig heldAt(const Face& face, const Box& bounds, bool mesh) {
  PatchConfig held = patchAt(face, bounds, 3.0, mesh ? tuning::kHeld : 0.0);
  held.name = kHeldName;
  return held;
}

LoadStep pressOf(const Face& face, const Box& bounds) {
  LoadStep press;
  PatchConfig patch = patchAt(face, bounds, tuning::kPatch, 0.0);
  patch.name = kPatchName;
  const double depth = tuning::kDepth * (bounds.max()[face.axis] - bounds.min()[face.axis]);
  (*patch.displacement)[at(face.axis)] = -face.sign() * depth;
  press.patches.push_back(patch);
  return press;
}

ToolConfig sphereOf(double radius) {
  ToolShape shape;
  shape.type = ToolShape::Type::kSphere;
  shape.radius = radius;
  ToolLink link;
  link.shapes.push_back(shape);
  ToolConfig tool;
  tool.name = kPatchName;
  tool.links.push_back(link);
  return tool;
}

MoveStep moveOf(const Face& face, const TriangleMesh& mesh, const Box& bounds, double radius) {
  const Vec3 outwards = face.outwards();
  Vec3 outermost = mesh.vertices.front();
  for (const Vec3& vertex : mesh.vertices) {
    if (vertex.dot(outwards) > outermost.dot(outwards)) outermost = vertex;
  }
  const double depth = tuning::kDepth * (bounds.max()[face.axis] - bounds.min()[face.axis]);
  MoveStep move;
  move.tool = kPatchName;
  move.from = MoveStep::Place();
  move.from->pose.translation() = outermost + (1.0 + tuning::kClearance) * radius * outwards;
  move.to.pose.translation() = outermost + (radius - depth) * outwards;
  return move;
}

}  // namespace

Scene probed(const Scene& scene) {
  Scene result = scene;
  const Box bounds = boxOf(scene.tissue);
  const Face face = farthestFromFixed(scene.tissue, bounds);
  result.tools.clear();
  result.steps.clear();
  if (scene.tissue.fixed.empty()) {
    LoadStep hold;
    hold.increments = 1;
    hold.patches.push_back(heldAt(face.opposite(), bounds, scene.tissue.mesh != nullptr));
    result.steps.emplace_back(hold);
  }
  if (!scene.tissue.mesh) {
    result.steps.emplace_back(pressOf(face, bounds));
    return result;
  }
  const double radius = tuning::kRadius * (bounds.max() - bounds.min()).minCoeff();
  result.tools.push_back(sphereOf(radius));
  result.steps.emplace_back(moveOf(face, *scene.tissue.mesh, bounds, radius));
  return result;
}

std::string probeText(const Scene& probed) {
  const Step& press = probed.steps.back();
  if (const auto* load = std::get_if<LoadStep>(&press)) {
    const PatchConfig& patch = load->patches.front();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double way = (*patch.displacement)[axis].value_or(0.0);
      if (way == 0.0) continue;
      return "no steps, so a patch is pressed by " + numberText(std::abs(way)) + " m along " +
             (way > 0.0 ? "+" : "-") + std::string(1, "xyz"[axis]);
    }
  }
  const auto& move = std::get<MoveStep>(press);
  const Vec3 way = move.to.pose.translation() - move.from->pose.translation();
  return "no steps, so a sphere of radius " +
         numberText(probed.tools.front().links.front().shapes.front().radius) +
         " m is pressed in by " + numberText(way.norm()) + " m";
}

}  // namespace robot_tissue
