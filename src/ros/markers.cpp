#include "robot_tissue/ros/markers.h"

#include <utility>

#include "robot_tissue/ros/conversions.h"
#include "robot_tissue/ros/tool_forces.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

void setColor(Marker& marker, double red, double green, double blue, double alpha = 1.0) {
  marker.color.r = static_cast<float>(red);
  marker.color.g = static_cast<float>(green);
  marker.color.b = static_cast<float>(blue);
  marker.color.a = static_cast<float>(alpha);
}

geometry_msgs::Vector3 sphereScale(double diameter) { return toVector3(Vec3::Constant(diameter)); }

// But for the stamp. Of one namespace and id all else is always the same.
bool looksAlike(const Marker& a, const Marker& b) {
  return a.ns == b.ns && a.id == b.id && a.action == b.action && a.scale == b.scale &&
         a.pose == b.pose && a.points == b.points;
}

// rviz refuses an empty list: the marker is taken away instead.
void add(Marker marker, MarkerArray& array) {
  if (marker.points.empty()) {
    marker.action = Marker::DELETE;
  }
  array.markers.push_back(std::move(marker));
}

}  // namespace

MarkerBuilder::MarkerBuilder(std::string frame_id, double force_scale,
                             std::vector<SupportConfig> supports)
    : frame_id_(std::move(frame_id)), force_scale_(force_scale), supports_(std::move(supports)) {}

MarkerArray MarkerBuilder::build(const Pipeline& pipeline, const ros::Time& stamp,
                                 const ros::Time& reached) {
  stamp_ = stamp;
  MarkerArray array;
  addSurface(pipeline.tissue(), array);
  addWireframe(pipeline.tissue(), array);
  addFixedNodes(pipeline.tissue(), array);
  addLoadedNodes(pipeline, array);
  stamp_ = reached;
  addContacts(pipeline, array);
  stamp_ = stamp;
  addSupports(pipeline.tissue().lattice(), array);
  return array;
}

MarkerArray MarkerBuilder::buildChanged(const Pipeline& pipeline, const ros::Time& stamp,
                                        const ros::Time& reached) {
  MarkerArray all = build(pipeline, stamp, reached);
  MarkerArray changed;
  told_.resize(all.markers.size());
  for (std::size_t i = 0; i < all.markers.size(); ++i) {
    if (looksAlike(all.markers[i], told_[i])) continue;
    changed.markers.push_back(all.markers[i]);
    told_[i] = std::move(all.markers[i]);
  }
  return changed;
}

Marker MarkerBuilder::make(const std::string& ns, int id, int type) const {
  Marker marker;
  marker.header.frame_id = frame_id_;
  marker.header.stamp = stamp_;
  marker.ns = ns;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  return marker;
}

void MarkerBuilder::addSurface(const Tissue& tissue, MarkerArray& array) const {
  Marker outside = make("surface", 0, Marker::TRIANGLE_LIST);
  setColor(outside, 0.85, 0.47, 0.43);
  Marker opened = make("cut_faces", 0, Marker::TRIANGLE_LIST);
  setColor(opened, 0.55, 0.06, 0.10);
  const Surface& surface = tissue.surface();
  outside.points.reserve(3 * surface.triangles.size());
  for (std::size_t triangle = 0; triangle < surface.triangles.size(); ++triangle) {
    Marker& marker = surface.opened[triangle] != 0 ? opened : outside;
    for (const int vertex : surface.triangles[triangle]) {
      marker.points.push_back(toPoint(tissue.vertices()[at(vertex)]));
    }
  }
  add(std::move(outside), array);
  add(std::move(opened), array);
}

void MarkerBuilder::addWireframe(const Tissue& tissue, MarkerArray& array) {
  if (springs_version_ != tissue.surfaceVersion()) findSurfaceSprings(tissue);
  Marker wires = make("wireframe", 0, Marker::LINE_LIST);
  wires.scale.x = tuning::kWireWidth;
  setColor(wires, 0.30, 0.13, 0.12);
  wires.points.reserve(2 * surface_springs_.size());
  for (const int spring : surface_springs_) {
    const Spring& ends = tissue.lattice().springs()[at(spring)];
    wires.points.push_back(toPoint(tissue.nodePosition(ends.a)));
    wires.points.push_back(toPoint(tissue.nodePosition(ends.b)));
  }
  add(std::move(wires), array);
}

void MarkerBuilder::findSurfaceSprings(const Tissue& tissue) {
  const Lattice& lattice = tissue.lattice();
  std::vector<char> on_surface(at(lattice.nodeCount()), 0);
  for (const int node : tissue.surface().node) {
    if (node >= 0) on_surface[at(node)] = 1;
  }
  surface_springs_.clear();
  for (std::size_t spring = 0; spring < lattice.springs().size(); ++spring) {
    const Spring& ends = lattice.springs()[spring];
    if (tissue.state().severed[spring] == 0 && on_surface[at(ends.a)] != 0 &&
        on_surface[at(ends.b)] != 0) {
      surface_springs_.push_back(static_cast<int>(spring));
    }
  }
  springs_version_ = tissue.surfaceVersion();
}

void MarkerBuilder::addFixedNodes(const Tissue& tissue, MarkerArray& array) const {
  Marker fixed = make("fixed_nodes", 0, Marker::SPHERE_LIST);
  fixed.scale = sphereScale(tuning::kNodeDiameter * tissue.lattice().spacing());
  setColor(fixed, 0.25, 0.25, 0.30);
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    if (tissue.lattice().isFixed(node)) fixed.points.push_back(toPoint(tissue.nodePosition(node)));
  }
  add(std::move(fixed), array);
}

void MarkerBuilder::addLoadedNodes(const Pipeline& pipeline, MarkerArray& array) const {
  const Tissue& tissue = pipeline.tissue();
  Marker loaded = make("loading_patches", 0, Marker::SPHERE_LIST);
  loaded.scale = sphereScale(2.0 * tuning::kNodeDiameter * tissue.lattice().spacing());
  setColor(loaded, 1.0, 0.80, 0.10);
  const auto addNodes = [&](const std::vector<int>& nodes) {
    for (const int node : nodes) loaded.points.push_back(toPoint(tissue.nodePosition(node)));
  };
  for (std::size_t patch = 0; patch < tissue.namedPatches(); ++patch) {
    addNodes(tissue.patches()[patch].nodes);
  }
  for (const ToolReport& tool : pipeline.report().tools) addNodes(tool.nodes);
  add(std::move(loaded), array);
}

// They never move; the planes' boxes are as long as the tissue's diagonal.
void MarkerBuilder::addSupports(const Lattice& lattice, MarkerArray& array) const {
  const Box bounds = lattice.bounds();
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    const ToolShape& shape = supports_[i].shape;
    Vec3 size = shape.size;
    Vec3 center = shape.pose.translation();
    if (shape.type == ToolShape::Type::kPlane) {
      const double length = (bounds.max() - bounds.min()).norm();
      size = Vec3(length, length, tuning::kPlaneThickness * lattice.spacing());
      Vec3 in_plane = shape.pose.inverse() * Vec3(0.5 * (bounds.min() + bounds.max()));
      in_plane.z() = -0.5 * size.z();
      center = shape.pose * in_plane;
    }
    Marker support = make("supports", static_cast<int>(i), Marker::CUBE);
    const Eigen::Quaterniond turn(shape.pose.linear());
    support.pose.position = toPoint(center);
    support.pose.orientation.x = turn.x();
    support.pose.orientation.y = turn.y();
    support.pose.orientation.z = turn.z();
    support.pose.orientation.w = turn.w();
    support.scale = toVector3(size);
    setColor(support, 0.45, 0.50, 0.55);
    array.markers.push_back(std::move(support));
  }
}

void MarkerBuilder::addContacts(const Pipeline& pipeline, MarkerArray& array) const {
  const double spacing = pipeline.tissue().lattice().spacing();
  for (std::size_t tool = 0; tool < pipeline.report().tools.size(); ++tool) {
    const ToolReport& report = pipeline.report().tools[tool];
    Marker normal = make("contact_normals", static_cast<int>(tool), Marker::ARROW);
    Marker force = make("contact_forces", static_cast<int>(tool), Marker::ARROW);
    for (Marker* arrow : {&normal, &force}) {
      arrow->scale.x = tuning::kShaftDiameter * spacing;
      arrow->scale.y = 2.0 * tuning::kShaftDiameter * spacing;
      arrow->scale.z = 0.0;
    }
    setColor(normal, 0.10, 0.45, 0.85);
    setColor(force, 0.10, 0.65, 0.20);
    if (report.contacts > 0) {
      const Vec3 force_on_tissue = forceOnTissue(pipeline, tool);
      const Vec3 start = report.point - tuning::kNormalLength * spacing * report.normal;
      if (!report.normal.isZero()) normal.points = {toPoint(start), toPoint(report.point)};
      if (force_on_tissue.norm() > tuning::kSmallestForce) {
        force.points = {toPoint(report.point - force_scale_ * force_on_tissue),
                        toPoint(report.point)};
      }
    }
    add(std::move(normal), array);
    add(std::move(force), array);
  }
}

}  // namespace robot_tissue
