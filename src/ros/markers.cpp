#include "robot_tissue/ros/markers.h"

#include <algorithm>
#include <utility>

#include "drawn_state.h"
#include "robot_tissue/ros/conversions.h"
#include "thread_lines.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

geometry_msgs::Vector3 sphereScale(double diameter) { return toVector3(Vec3::Constant(diameter)); }

// Whether two markers of one namespace and id look alike: what is not compared, but for the stamp,
// is the same in all of these.
bool looksAlike(const Marker& a, const Marker& b) {
  return a.ns == b.ns && a.id == b.id && a.action == b.action && a.scale == b.scale &&
         a.pose == b.pose && a.points == b.points && a.color == b.color && a.colors == b.colors &&
         a.text == b.text;
}

// Each takes a marker with all but its places and sizes.
using Draw = void (*)(const Drawn& drawn, const Marker& blank, MarkerArray& array);

// What a cut opened keeps its own color, so that a wound is always told from the skin.
template <bool opened>
void drawSurface(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  Marker marker = blank;
  DrawnTriangles triangles;
  const bool colored = !opened && !drawn.values.empty();
  drawn.display.draw(opened, colored ? &drawn.values : nullptr, triangles);
  marker.points = toPoints(triangles.points);
  marker.colors.reserve(triangles.values.size());
  for (std::size_t i = 0; i < triangles.values.size(); ++i) {
    marker.colors.push_back(litColorOf(triangles.values[i] / drawn.scale, triangles.normals[i]));
  }
  add(std::move(marker), array);
}

void drawWireframe(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  Marker wires = blank;
  const Tissue& tissue = drawn.tissue();
  wires.scale.x = tuning::kWireWidth;
  std::vector<Vec3> ends;
  ends.reserve(2 * drawn.wires.size());
  for (const Wire& wire : drawn.wires) {
    if (wire.edge >= 0) {
      drawn.display.drawEdge(wire.edge, ends);
      continue;
    }
    const Spring& spring = tissue.lattice().springs()[at(wire.spring)];
    ends.push_back(tissue.nodePosition(spring.a));
    ends.push_back(tissue.nodePosition(spring.b));
  }
  wires.points = toPoints(ends);
  add(std::move(wires), array);
}

void drawLips(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  Marker lips = blank;
  lips.scale.x = tuning::kLipWidth;
  std::vector<Vec3> ends;
  drawn.display.drawLips(ends);
  lips.points = toPoints(ends);
  add(std::move(lips), array);
}

void drawFixedNodes(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  Marker fixed = blank;
  const Tissue& tissue = drawn.tissue();
  fixed.scale = sphereScale(tuning::kNodeDiameter * drawn.spacing());
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    if (!tissue.lattice().isFixed(node) || isRemoved(tissue.state(), node)) continue;
    fixed.points.push_back(toPoint(tissue.nodePosition(node)));
  }
  add(std::move(fixed), array);
}

void drawLoadedNodes(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  Marker loaded = blank;
  const Tissue& tissue = drawn.tissue();
  loaded.scale = sphereScale(2.0 * tuning::kNodeDiameter * drawn.spacing());
  const auto addNodes = [&](const std::vector<int>& nodes) {
    for (const int node : nodes) loaded.points.push_back(toPoint(tissue.nodePosition(node)));
  };
  for (std::size_t patch = 0; patch < tissue.namedPatches(); ++patch) {
    addNodes(tissue.patches()[patch].nodes);
  }
  for (const ToolReport& tool : drawn.pipeline.report().tools) addNodes(tool.nodes);
  add(std::move(loaded), array);
}

void drawSutures(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  Marker threads = blank;
  threads.scale.x = tuning::kThreadWidth;
  threads.points = toPoints(threadLines(drawn.tissue()));
  add(std::move(threads), array);
}

// Markers of the supports, which never move; a plane is a box as long as the tissue's diagonal.
void drawSupports(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  const Lattice& lattice = drawn.tissue().lattice();
  const Box bounds = lattice.bounds();
  for (std::size_t i = 0; i < drawn.supports.size(); ++i) {
    const ToolShape& shape = drawn.supports[i].shape;
    Vec3 size = shape.size;
    Vec3 center = shape.pose.translation();
    if (shape.type == ToolShape::Type::kPlane) {
      const double length = (bounds.max() - bounds.min()).norm();
      size = Vec3(length, length, tuning::kPlaneThickness * lattice.spacing());
      Vec3 in_plane = shape.pose.inverse() * Vec3(0.5 * (bounds.min() + bounds.max()));
      in_plane.z() = -0.5 * size.z();
      center = shape.pose * in_plane;
    }
    Marker support = blank;
    support.id = static_cast<int>(i);
    const Eigen::Quaterniond turn(shape.pose.linear());
    support.pose.position = toPoint(center);
    support.pose.orientation.x = turn.x();
    support.pose.orientation.y = turn.y();
    support.pose.orientation.z = turn.z();
    support.pose.orientation.w = turn.w();
    support.scale = toVector3(size);
    array.markers.push_back(std::move(support));
  }
}

struct Color {
  double red, green, blue;
};

// What it shows: the shape as it is, or the tools where the tissue reached them.
enum class Of { kShape, kTools };

struct Namespace {
  const char* name;
  int type;
  Color color;
  Of of;
  Draw draw;
};

const Namespace kNamespaces[] = {
    {"surface", Marker::TRIANGLE_LIST, {0.85, 0.47, 0.43}, Of::kShape, drawSurface<false>},
    {"cut_faces", Marker::TRIANGLE_LIST, {0.55, 0.06, 0.10}, Of::kShape, drawSurface<true>},
    {"cut_edges", Marker::LINE_LIST, {0.35, 0.0, 0.04}, Of::kShape, drawLips},
    {"wireframe", Marker::LINE_LIST, {0.30, 0.13, 0.12}, Of::kShape, drawWireframe},
    {"fixed_nodes", Marker::SPHERE_LIST, {0.25, 0.25, 0.30}, Of::kShape, drawFixedNodes},
    {"loading_patches", Marker::SPHERE_LIST, {1.0, 0.80, 0.10}, Of::kShape, drawLoadedNodes},
    {"sutures", Marker::LINE_LIST, {0.95, 0.95, 0.90}, Of::kShape, drawSutures},
    {"contact_normals", Marker::ARROW, {0.10, 0.45, 0.85}, Of::kTools, drawNormals},
    {"contact_forces", Marker::ARROW, {0.20, 0.85, 0.35}, Of::kTools, drawForces},
    {"force_labels", Marker::TEXT_VIEW_FACING, {0.65, 1.0, 0.70}, Of::kTools, drawForceLabels},
    {"force_list", Marker::TEXT_VIEW_FACING, {0.65, 1.0, 0.70}, Of::kTools, drawForceList},
    {"tool_edges", Marker::LINE_LIST, {1.0, 1.0, 1.0}, Of::kTools, drawEdges},
    {"legend", Marker::TEXT_VIEW_FACING, {0.95, 0.95, 0.95}, Of::kShape, drawLegend},
    {"supports", Marker::CUBE, {0.45, 0.50, 0.55}, Of::kShape, drawSupports},
};

Marker blankOf(const Namespace& of, const std::string& frame_id, const ros::Time& stamp) {
  Marker marker;
  marker.header.frame_id = frame_id;
  marker.header.stamp = stamp;
  marker.ns = of.name;
  marker.type = of.type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color.r = static_cast<float>(of.color.red);
  marker.color.g = static_cast<float>(of.color.green);
  marker.color.b = static_cast<float>(of.color.blue);
  marker.color.a = 1.0F;
  marker.frame_locked = 1;  // it moves with the tissue's frame, also where it is not told anew
  return marker;
}

// Of a tool that is no more there.
void dim(Marker& marker) {
  marker.color.r = marker.color.g = marker.color.b = tuning::kGrayOfBehind;
  marker.color.a = tuning::kOpacityOfBehind;
}

}  // namespace

MarkerBuilder::MarkerBuilder(std::string frame_id, const MarkerStyle& style,
                             std::vector<SupportConfig> supports)
    : frame_id_(std::move(frame_id)), style_(style), supports_(std::move(supports)) {}

void MarkerBuilder::setStyle(const MarkerStyle& style) {
  if (style.color != style_.color) scale_ = 0.0;  // it has another unit
  style_ = style;
}

MarkerBuilder::News MarkerBuilder::reach(const Pipeline& pipeline, const ros::Time& stamp) {
  const ReachedTools before = std::exchange(tools_, reachedTools(pipeline, stamp));
  const bool was_behind = std::exchange(is_behind_, false);
  return {before.forces != tools_.forces, was_behind || before.edges != tools_.edges};
}

bool MarkerBuilder::fallBehind(const Pipeline& pipeline) {
  if (!pipeline.pose() && !tools_.forces.empty()) {  // they were told to stand nowhere
    forgetTools();
    return true;
  }
  return !tools_.forces.empty() && !std::exchange(is_behind_, true);
}

void MarkerBuilder::forgetTools() {
  tools_ = ReachedTools();
  is_behind_ = false;
}

MarkerArray MarkerBuilder::build(const Pipeline& pipeline, const ros::Time& stamp) {
  MarkerArray all;
  for (const MarkerArray& each : draw(pipeline, stamp, What::kAll)) {
    all.markers.insert(all.markers.end(), each.markers.begin(), each.markers.end());
  }
  return all;
}

MarkerArray MarkerBuilder::buildChanged(const Pipeline& pipeline, const ros::Time& stamp,
                                        What what) {
  std::vector<MarkerArray> all = draw(pipeline, stamp, what);
  MarkerArray changed;
  told_.resize(all.size());
  for (std::size_t of = 0; of < all.size(); ++of) {
    told_[of].resize(std::max(told_[of].size(), all[of].markers.size()));
    for (std::size_t i = 0; i < all[of].markers.size(); ++i) {
      if (looksAlike(all[of].markers[i], told_[of][i])) continue;
      changed.markers.push_back(all[of].markers[i]);
      told_[of][i] = std::move(all[of].markers[i]);
    }
  }
  return changed;
}

// By the table's rows; empty where that is not of what is asked for.
std::vector<MarkerArray> MarkerBuilder::draw(const Pipeline& pipeline, const ros::Time& stamp,
                                             What what) {
  std::vector<double> values;
  if (what == What::kAll) values = followShape(pipeline);
  const ForceArrows arrows = forceArrows(pipeline, tools_, style_.force_scale);
  const Drawn drawn{pipeline, supports_, display_, wires_, style_,
                    values,   scale_,    tools_,   arrows, is_behind_};
  std::vector<MarkerArray> arrays;
  for (const Namespace& each : kNamespaces) {
    MarkerArray& array = arrays.emplace_back();
    const bool of_tools = each.of == Of::kTools;
    if (what == What::kTools && !of_tools) continue;
    Marker blank = blankOf(each, frame_id_, of_tools ? tools_.stamp : stamp);
    if (of_tools && is_behind_) dim(blank);
    each.draw(drawn, blank, array);
  }
  return arrays;
}

// Returns what colors the surface.
std::vector<double> MarkerBuilder::followShape(const Pipeline& pipeline) {
  const Tissue& tissue = pipeline.tissue();
  if (springs_revision_ != tissue.surface().revision) {
    display_.bind(tissue.surface());
    findWires(tissue);
  }
  display_.fit(tissue.vertices());
  std::vector<double> values = surfaceValues(style_.color, pipeline);
  scale_ = scaleFor(values, scale_);
  return values;
}

void MarkerBuilder::findWires(const Tissue& tissue) {
  const Lattice& lattice = tissue.lattice();
  std::vector<char> on_surface(at(lattice.nodeCount()), 0);
  for (const int node : tissue.surface().node) {
    if (node >= 0) on_surface[at(node)] = 1;
  }
  wires_.clear();
  for (const Spring ends : lattice.springs()) {
    if (tissue.state().severed[at(ends.number)] == 0 && on_surface[at(ends.a)] != 0 &&
        on_surface[at(ends.b)] != 0) {
      wires_.push_back({ends.number, display_.edgeBetween(ends.a, ends.b)});
    }
  }
  springs_revision_ = tissue.surface().revision;
}

}  // namespace robot_tissue
