// A link as ContactFinder has it: its shapes, and what is kept of each from search to search.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "clear_points.h"
#include "collision_shape.h"
#include "known_minima.h"
#include "placed_link.h"
#include "robot_tissue/contact/contact_finder.h"
#include "shape_gap.h"
#include "surface_traversal.h"

namespace robot_tissue {

class TouchingLink {
 public:
  // Throws InputError as ContactFinder.
  TouchingLink(int tool_index, const std::string& tool_name, const LinkGeometry& geometry,
               std::vector<std::string>& warnings);

  void useShapes(std::size_t count);
  std::size_t shapesInUse() const { return in_use_; }  // the first ones

  // Of the shapes in use. Kept until it is asked for at another pose: many ask point by point.
  const PlacedLink& placedAt(const Pose& tissue_T_link) const;
  // As ContactFinder has them.
  double reach() const;
  std::vector<Vec3> corners() const;
  std::vector<Vec3> surfacePoints() const;
  std::vector<Vec3> innerPoints() const;
  double thickness() const;
  double thicknessIn(const Box& box, const Pose& tissue_T_link) const;
  std::vector<ToolIndenter> indenters() const;
  // As ContactFinder::wayOut. Of the same point again, as where a way out along a direction begins,
  // it is known.
  std::optional<WayOut> wayOutAt(const Pose& tissue_T_link, const Vec3& point, double reach) const;
  // The longest way of a point of the link from one pose to another (m): that of a corner of a box
  // around a shape.
  double longestWay(const Pose& from, const Pose& to) const;

  int tool = 0;
  std::vector<CollisionShape> shapes;
  std::vector<GapShape> gap_shapes;               // as shapes
  std::vector<std::vector<Vec3>> surface_points;  // as shapes; shape's frame (m)
  std::vector<std::vector<Vec3>> inner_points;    // likewise
  std::vector<KeptFacePairs> face_pairs;          // as shapes; of meshes
  std::vector<KnownMinima> known_minima;          // as shapes; of meshes
  std::vector<ClearPoints> clear_points;          // as shapes

 private:
  std::vector<Vec3> inLink(const std::vector<std::vector<Vec3>>& points_of_shapes) const;

  struct Asked {
    Vec3 point = Vec3::Zero();
    double reach = 0.0;
    std::optional<WayOut> out;
  };

  std::size_t in_use_ = 0;
  mutable std::optional<Pose> last_pose_;
  mutable PlacedLink last_placed_;           // at that pose
  mutable std::optional<Asked> last_asked_;  // likewise
};

}  // namespace robot_tissue
