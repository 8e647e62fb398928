// Arrows and numbers of the forces on tools.
#include <algorithm>
#include <array>
#include <iomanip>
#include <locale>
#include <optional>
#include <sstream>
#include <string>

#include "drawn_state.h"
#include "robot_tissue/ros/conversions.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;
using Points = std::vector<geometry_msgs::Point>;

// An arrow a tool, along what `ends` gives: its start and its tip, or nothing.
template <class Ends>
void drawArrows(const Drawn& drawn, const Marker& blank, MarkerArray& array, const Ends& ends) {
  for (std::size_t tool = 0; tool < drawn.pipeline.tools().size(); ++tool) {
    Marker arrow = blank;
    arrow.id = static_cast<int>(tool);
    arrow.scale.x = tuning::kShaftDiameter * drawn.spacing();
    arrow.scale.y = 2.0 * tuning::kShaftDiameter * drawn.spacing();
    arrow.scale.z = 0.0;
    arrow.points = ends(tool);
    add(std::move(arrow), array);
  }
}

// An arrow along the force that is seen from outside the tools: on its own line, from where that
// leaves them, or, as along the shaft of an instrument, beside them.
ForceArrow arrowAlong(const Pipeline& pipeline, const RobotPose& pose, const Vec3& place,
                      const Vec3& force, double force_scale) {
  const Vec3 direction = force.normalized();
  const double farthest = tuning::kFarthestArrow * diagonalOf(pipeline.tissue());
  const double gap = tuning::kShaftDiameter * pipeline.tissue().lattice().spacing();
  const auto exitAlong = [&](const Vec3& way) {
    return pipeline.exitOf(pose, place, way, farthest);
  };
  const double ahead = exitAlong(direction);
  Vec3 start = place + ahead * direction, away = direction;
  const Vec3 aside = direction.unitOrthogonal(), other = direction.cross(aside);
  double least = farthest;
  for (const Vec3& way : std::array<Vec3, 4>{aside, other, Vec3(-aside), Vec3(-other)}) {
    if (ahead < farthest) break;
    const double exit = exitAlong(way);
    // By more than a hair, so that the arrow of a round tool does not jump.
    if (exit >= tuning::kClearlyLess * least) continue;
    least = exit;
    start = place + (exit + gap) * way;
    away = way;
  }
  return {start, start + force_scale * force, away, force.norm()};
}

// In parentheses where the tool is no more where it was.
std::string newtons(const Drawn& drawn, double force) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(2) << force << " N";
  return drawn.is_behind ? "(" + text.str() + ")" : text.str();
}

}  // namespace

ForceArrows forceArrows(const Pipeline& pipeline, const ReachedTools& tools, double force_scale) {
  ForceArrows arrows(pipeline.tools().size());
  const std::size_t count = std::min(arrows.size(), tools.forces.size());
  for (std::size_t tool = 0; tool < count; ++tool) {
    const ReachedTools::Force& on_tool = tools.forces[tool];
    if (on_tool.force.norm() <= tuning::kSmallestForce) continue;
    arrows[tool] = arrowAlong(pipeline, tools.pose, on_tool.place, on_tool.force, force_scale);
  }
  return arrows;
}

void drawNormals(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  drawArrows(drawn, blank, array, [&](std::size_t tool) {
    if (tool >= drawn.tools.forces.size()) return Points();
    const ReachedTools::Force& on_tool = drawn.tools.forces[tool];
    if (on_tool.normal.isZero()) return Points();
    const Vec3 way = tuning::kNormalLength * drawn.spacing() * on_tool.normal;
    return Points{toPoint(on_tool.place - way), toPoint(on_tool.place)};
  });
}

void drawForces(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  drawArrows(drawn, blank, array, [&](std::size_t tool) {
    const std::optional<ForceArrow>& arrow = drawn.arrows[tool];
    return arrow ? Points{toPoint(arrow->start), toPoint(arrow->tip)} : Points();
  });
}

void drawForceLabels(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  const double height = tuning::kTextHeight * drawn.diagonal();
  for (std::size_t tool = 0; tool < drawn.pipeline.tools().size(); ++tool) {
    Marker label = blank;
    label.id = static_cast<int>(tool);
    label.scale.x = label.scale.y = 0.0;
    label.scale.z = height;
    if (const std::optional<ForceArrow>& arrow = drawn.arrows[tool]) {
      label.text = newtons(drawn, arrow->force);
      label.pose.position = toPoint(arrow->tip + tuning::kLabelGap * height * arrow->away);
    }
    add(std::move(label), array);
  }
}

// Who pushes whom, a line a tool, at the foot of the tissue's front.
void drawForceList(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  Marker list = blank;
  const double height = tuning::kTextHeight * drawn.diagonal();
  std::string lines;
  for (std::size_t tool = 0; tool < drawn.pipeline.tools().size(); ++tool) {
    if (const std::optional<ForceArrow>& arrow = drawn.arrows[tool]) {
      lines += "\n" + newtons(drawn, arrow->force) + " on " + drawn.pipeline.tools()[tool].name;
    }
  }
  const std::string title = "force by the tissue";
  if (!lines.empty()) {
    list.text = title + (drawn.is_behind ? ", at an earlier pose" : "") + lines;
  }
  list.scale.x = list.scale.y = 0.0;
  list.scale.z = height;
  const Box bounds = drawn.tissue().lattice().bounds();
  list.pose.position =
      toPoint(Vec3(bounds.center().x(), bounds.min().y() - tuning::kLegendGap * drawn.diagonal(),
                   bounds.min().z() + tuning::kListHeight * height));
  add(std::move(list), array);
}

}  // namespace robot_tissue
