#include "touching_link.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "inner_points.h"
#include "link_penetration.h"
#include "robot_tissue/core/same_bits.h"
#include "shape_indenter.h"
#include "triangle_minimum.h"

namespace robot_tissue {

TouchingLink::TouchingLink(int tool_index, const std::string& tool_name,
                           const LinkGeometry& geometry, std::vector<std::string>& warnings)
    : tool(tool_index) {
  const std::string owner =
      "tool '" + tool_name + "'" + (geometry.link.empty() ? "" : ", link '" + geometry.link + "'");
  for (std::size_t i = 0; i < geometry.shapes.size(); ++i) {
    shapes.emplace_back(geometry.shapes[i], owner + ", shape " + std::to_string(i + 1), warnings);
    gap_shapes.emplace_back(shapes.back());
    surface_points.push_back(robot_tissue::surfacePoints(shapes.back()));
    inner_points.push_back(robot_tissue::innerPoints(shapes.back()));
  }
  in_use_ = shapes.size();
  face_pairs.resize(shapes.size());
  known_minima.resize(shapes.size());
  clear_points.resize(shapes.size());
}

void TouchingLink::useShapes(std::size_t count) {
  in_use_ = std::min(count, shapes.size());
  last_pose_.reset();
}

const PlacedLink& TouchingLink::placedAt(const Pose& tissue_T_link) const {
  if (last_pose_ && areSame(*last_pose_, tissue_T_link)) return last_placed_;
  last_placed_ = placed(shapes, tissue_T_link);
  if (last_placed_.size() > in_use_) last_placed_.resize(in_use_);
  last_pose_ = tissue_T_link;
  last_asked_.reset();
  return last_placed_;
}

std::optional<WayOut> TouchingLink::wayOutAt(const Pose& tissue_T_link, const Vec3& point,
                                             double reach) const {
  const PlacedLink& here = placedAt(tissue_T_link);
  if (!last_asked_ || last_asked_->point != point || last_asked_->reach != reach) {
    // A signed distance changes by no more than the way between two points.
    const double bound =
        last_asked_ && last_asked_->out
            ? boundAfter(last_asked_->out->depth_m, (point - last_asked_->point).norm())
            : kInfinity;
    last_asked_ = Asked{point, reach, wayOut(here, point, reach, bound)};
  }
  return last_asked_->out;
}

double TouchingLink::longestWay(const Pose& from, const Pose& to) const {
  const Eigen::Matrix4d way = to.matrix() - from.matrix();
  double longest = 0.0;
  for (std::size_t i = 0; i < in_use_; ++i) {
    if (shapes[i].isPlane() && !way.isZero(0.0)) return std::numeric_limits<double>::infinity();
    if (shapes[i].isPlane()) continue;
    const Pose& pose = shapes[i].poseInLink();
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 point = pose * shapes[i].bounds().corner(static_cast<Box::CornerType>(corner));
      longest = std::max(longest, (way * point.homogeneous()).norm());
    }
  }
  return longest;
}

std::vector<Vec3> TouchingLink::corners() const {
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < in_use_; ++i) {
    const CollisionShape& shape = shapes[i];
    if (shape.isPlane()) continue;
    const Box& box = shape.bounds();
    const Vec3 middle = shape.poseInLink() * Vec3(0.5 * (box.min() + box.max()));
    const Vec3 half = 0.5 * (box.max() - box.min());
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 signs((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                       (corner & 4) != 0 ? 1.0 : -1.0);
      corners.push_back(middle + shape.poseInLink().linear() * half.cwiseProduct(signs));
    }
  }
  return corners;
}

double TouchingLink::reach() const {
  double farthest = 0.0;
  for (const Vec3& corner : corners()) farthest = std::max(farthest, corner.norm());
  return farthest;
}

std::vector<Vec3> TouchingLink::inLink(
    const std::vector<std::vector<Vec3>>& points_of_shapes) const {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < in_use_; ++i) {
    for (const Vec3& point : points_of_shapes[i]) points.push_back(shapes[i].poseInLink() * point);
  }
  return points;
}

std::vector<Vec3> TouchingLink::surfacePoints() const { return inLink(surface_points); }

std::vector<Vec3> TouchingLink::innerPoints() const { return inLink(inner_points); }

double TouchingLink::thickness() const {
  double thinnest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < in_use_; ++i) {
    thinnest = std::min(thinnest, shapes[i].thickness());
  }
  return thinnest;
}

double TouchingLink::thicknessIn(const Box& box, const Pose& tissue_T_link) const {
  if (in_use_ < 2) return thickness();
  PlacedLink here = placed(shapes, tissue_T_link);
  if (here.size() > in_use_) here.resize(in_use_);
  std::optional<double> thinnest;
  for (const PlacedShape& shape : here) {
    if (!shape.bounds.intersects(box)) continue;
    thinnest = std::min(thinnest.value_or(kInfinity), shape.shape->thickness());
  }
  return thinnest.value_or(thickness());
}

std::vector<ToolIndenter> TouchingLink::indenters() const {
  std::vector<ToolIndenter> indenters;
  for (std::size_t i = 0; i < in_use_; ++i) {
    if (auto indenter = indenterOf(shapes[i])) {
      indenters.push_back({static_cast<int>(i), shapes[i].poseInLink(), std::move(indenter)});
    }
  }
  return indenters;
}

}  // namespace robot_tissue
