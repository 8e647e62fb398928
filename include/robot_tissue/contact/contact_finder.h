// Finds where the tools touch the deformed surface.
// In: tool poses (tissue frame), deformed surface vertices (m, tissue frame).
// Shapes and their trees are built once, in the constructor; meshes touch as they are, concave
// parts too. Depths are signed distances by closed formulas and, of a mesh, to its nearest triangle
// (own); the deepest point of a triangle by cutting planes (Kelley 1960), to 0.5 % of its longest
// edge or 2 % of the shape's thickness, whichever is less, 1e-5 m at least; of a mesh that is not
// convex, a local one. A link whose pose is not finite and rigid touches nothing. Keeps scratch:
// not for several threads at once.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/narrow_contact.h"
#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/surface.h"

namespace robot_tissue {

// How far a point is from leaving a shape, and which way.
struct WayOut {
  double depth_m = 0.0;        // > 0: inside the padded shape; < 0: that far from it
  Vec3 normal = Vec3::Zero();  // unit, away from the shape; zero when every way is as good
};

// A flat face of a link at a point of its plane: where its sharp edges are from there.
struct FlatFace {
  Vec3 normal = Vec3::Zero();   // unit, out of the link
  double height_m = 0.0;        // of the point over the face; < 0: in the link
  int shape = 0;                // number in the link
  double roundness_m = 0.0;     // radius of the edges
  std::vector<FaceEdge> edges;  // those within reach, each of another side, the nearest first
};

class ContactFinder {
 public:
  // Throws InputError: a mesh that cannot be loaded, is not closed or has no volume, a measure that
  // is not > 0, a padding < 0.
  explicit ContactFinder(const std::vector<ToolGeometry>& tools);
  ~ContactFinder();
  ContactFinder(ContactFinder&&) noexcept;
  ContactFinder& operator=(ContactFinder&&) noexcept;

  std::size_t linkCount() const;
  // From now on only the first `count` shapes of the link are there, all at first.
  void useShapes(std::size_t link, std::size_t count);
  // Farthest that a point of the link is from the link's origin (m); 0 without shapes, and for a
  // plane.
  double reach(std::size_t link) const;
  // Points with all of the link between them: corners of boxes around its shapes; link frame (m).
  // None of a plane.
  std::vector<Vec3> corners(std::size_t link) const;
  // Points of the surface of the link's shapes, corners, edges and rims among them; link frame (m).
  // None of a plane.
  std::vector<Vec3> surfacePoints(std::size_t link) const;
  // A point deep inside each of the link's shapes, of a mesh in parts inside each part; link frame
  // (m). None of a plane.
  std::vector<Vec3> innerPoints(std::size_t link) const;
  // Smallest width of the link's thinnest shape (m); infinite without shapes.
  double thickness(std::size_t link) const;
  // The same of the shape that a contact is with.
  double thickness(const Contact& contact) const;
  // The same of those of its shapes that come into a box (tissue frame) at a pose, of all where
  // none does.
  double thicknessIn(const Box& box, std::size_t link, const Pose& tissue_T_link) const;
  // Of each of its shapes.
  std::vector<double> thicknesses(std::size_t link) const;
  // Of its shapes but for planes, padding included.
  std::vector<ToolIndenter> indenters(std::size_t link) const;
  // Axis-aligned box around the link's shapes in the tissue's frame (m); empty (min > max) without,
  // infinite with a plane.
  Box bounds(std::size_t link, const Pose& tissue_T_link) const;

  // One line each.
  const std::vector<std::string>& warnings() const;

  // From here on find() follows the deepest places of triangles that went only a little beside a
  // mesh since it looked for them; it does not look for these anew.
  void followPlaces();

  // As if nothing had been searched for yet.
  void forget();
  // What is kept of the last searches: the next answers hang on it by less than their accuracy.
  struct Kept;
  std::shared_ptr<const Kept> kept() const;
  // As it was then, of a surface that was there then.
  void restore(const Kept& kept, const TissueSurface& surface,
               const std::vector<Vec3>& vertices) const;

  // Contacts with depth > -margin (m), in order of links, then triangles: of each vertex, and of
  // each triangle the deepest point when that is neither a vertex nor, by more than a hair, less
  // deep than one of them. A point of an edge is found once.
  // Throws InputError when the pose has not one entry a link or the surface not one vertex each.
  ContactSet find(const RobotPose& pose, const TissueSurface& surface,
                  const std::vector<Vec3>& vertices, double margin) const;
  // Likewise, but as long as the surface is that of the last find() with this margin, and no point
  // of a link has gone farther than `way` (m) since, at the places of then: depths and normals are
  // those of now.
  ContactSet findAgain(const RobotPose& pose, const TissueSurface& surface,
                       const std::vector<Vec3>& vertices, double margin, double way) const;

  // Of a point (m, tissue frame) and a link; nothing when it is farther than `reach` from it.
  std::optional<WayOut> wayOut(std::size_t link, const Pose& tissue_T_link, const Vec3& point,
                               double reach) const;

  // The same for a point from which there is one way out, in a unit direction: seen from where that
  // way is `clear` (m) off the link, so that the normal does not jump at the link's edges. The
  // depth is that of the point below the plane found there. Nothing when it is farther than `reach`
  // from the link, or the way is longer than `farthest` (m).
  std::optional<WayOut> wayOutAlong(std::size_t link, const Pose& tissue_T_link, const Vec3& point,
                                    const Vec3& direction, double clear, double reach,
                                    double farthest) const;

  // Whether the link has flat faces with sharp edges: boxes, cylinders' ends, and faces of meshes
  // that end where the mesh folds outwards by 40 degrees and more.
  bool hasFlatFaces(std::size_t link) const;
  // Whether a shape of it is a mesh: its contacts are dear.
  bool hasMesh(std::size_t link) const;
  // The face that looks along `facing` (unit, tissue frame), by 35 degrees at most, and has an edge
  // within `reach` (m) of the point along the face, over it or beyond it; of several the nearest.
  // Faces of several shapes in one plane are one, with no edge where they meet.
  std::optional<FlatFace> flatFace(std::size_t link, const Pose& tissue_T_link, const Vec3& facing,
                                   const Vec3& point, double reach) const;

  // Whether the surface goes around the point (m, tissue frame). Throws InputError as find.
  bool isInside(const Vec3& point, const TissueSurface& surface,
                const std::vector<Vec3>& vertices) const;

  // Of each of these links the deepest point inside the surface, or of the surface inside the link
  // (m); 0 when they do not overlap: points of the surface as in find, and corners, edges and rims
  // of the link. With a bulge, how far the surface is off its triangles there (m, tissue frame), to
  // first order in it. Throws InputError as find.
  using Bulge = std::function<Vec3(std::size_t link, const SurfacePoint& point)>;
  std::vector<double> penetrations(const std::vector<std::size_t>& links, const RobotPose& pose,
                                   const TissueSurface& surface, const std::vector<Vec3>& vertices,
                                   const Bulge& bulge = {}) const;

  // Distance between two links (m), e.g. jaws; 0 when they overlap, infinite when one has no shapes
  // or no rigid pose. A gap that is wider than `reach` (m) may be told less, but wider than that.
  double gap(std::size_t link, std::size_t other, const RobotPose& pose,
             double reach = std::numeric_limits<double>::infinity()) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace robot_tissue
