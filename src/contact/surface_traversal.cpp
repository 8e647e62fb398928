#include "surface_traversal.h"

#include <fcl/narrowphase/detail/traversal/collision/collision_traversal_node_base.h>
#include <fcl/narrowphase/detail/traversal/traversal_recurse.h>

#include <algorithm>
#include <cmath>

#include "tuning.h"

namespace robot_tissue {
namespace {

using Traversal = fcl::detail::CollisionTraversalNodeBase<double>;

struct CenteredBox {
  Vec3 center = Vec3::Zero(), half = Vec3::Zero();  // m
};

CenteredBox centered(const TriangleBvh::Node& node) {
  return {0.5 * (node.low + node.high), 0.5 * (node.high - node.low)};
}

// Around the box as seen from another frame.
CenteredBox seenFrom(const Pose& frame_T_box, const CenteredBox& box) {
  return {frame_T_box * box.center, frame_T_box.linear().cwiseAbs() * box.half};
}

bool areApart(const CenteredBox& box, const Vec3& low, const Vec3& high, double margin) {
  return ((box.center - box.half).array() > high.array() + margin).any() ||
         ((box.center + box.half).array() < low.array() - margin).any();
}

// Of numbers that are not negative: pairs as they are ordered by the triangle, and then by the
// face.
std::uint64_t pairOf(int triangle, int face) {
  return (static_cast<std::uint64_t>(triangle) << 32U) | static_cast<std::uint64_t>(face);
}

// FCL's traversal of two trees: the first is the surface's.
class SurfaceTraversal : public Traversal {
 public:
  explicit SurfaceTraversal(const TriangleBvh& surface) : surface_(surface) {}
  bool isFirstNodeLeaf(int b) const override { return TriangleBvh::isLeaf(surface_.node(b)); }
  int getFirstLeftChild(int b) const override {
    surface_.open(b);
    return surface_.node(b).first_child;
  }
  int getFirstRightChild(int b) const override { return surface_.node(b).first_child + 1; }
  bool canStop() const override { return false; }

 protected:
  const TriangleBvh& surface_;
};

// Triangles near to one shape, which is the second tree's only node.
class BesideShape : public SurfaceTraversal {
 public:
  BesideShape(const PlacedShape& shape, const TriangleBvh& surface, double margin,
              std::vector<int>& triangles)
      : SurfaceTraversal(surface), shape_(shape), margin_(margin), triangles_(triangles) {}

  bool isSecondNodeLeaf(int) const override { return true; }
  bool firstOverSecond(int, int) const override { return true; }
  // True: nothing below is near. Boxes are compared in the tissue's frame; then the shape's
  // distance from the box's center with the radius of the ball around the box or, of a mesh, boxes
  // in its frame.
  bool BVTesting(int b, int) const override {
    const CenteredBox box = centered(surface_.node(b));
    if (areApart(box, shape_.bounds.min(), shape_.bounds.max(), margin_)) return true;
    if (!shape_.shape->isMesh()) {
      const double distance = shape_.shape->distance(shape_.shape_T_tissue * box.center).value;
      return distance > (box.half.norm() + margin_) * (1.0 + tuning::kBeyondRounding);
    }
    const Box& bounds = shape_.shape->bounds();
    return areApart(seenFrom(shape_.shape_T_tissue, box), bounds.min(), bounds.max(), margin_);
  }
  void leafTesting(int b, int) const override {
    triangles_.push_back(TriangleBvh::triangleOf(surface_.node(b)));
  }

 private:
  const PlacedShape& shape_;
  double margin_;
  std::vector<int>& triangles_;
};

// Pairs of near triangles and faces of a mesh, whose tree is the second; boxes in the mesh's frame.
class BesideMesh : public SurfaceTraversal {
 public:
  BesideMesh(const PlacedShape& mesh, const TriangleBvh& surface, double reach,
             std::vector<std::uint64_t>& pairs)
      : SurfaceTraversal(surface),
        mesh_T_tissue_(mesh.shape_T_tissue),
        faces_(mesh.shape->mesh().tree()),
        reach_(reach),
        pairs_(pairs) {}

  bool isSecondNodeLeaf(int b) const override { return TriangleBvh::isLeaf(faces_.node(b)); }
  int getSecondLeftChild(int b) const override {
    faces_.open(b);
    return faces_.node(b).first_child;
  }
  int getSecondRightChild(int b) const override { return faces_.node(b).first_child + 1; }
  bool firstOverSecond(int first, int second) const override {
    if (isSecondNodeLeaf(second)) return true;
    const TriangleBvh::Node &one = surface_.node(first), &other = faces_.node(second);
    return !isFirstNodeLeaf(first) &&
           (one.high - one.low).squaredNorm() > (other.high - other.low).squaredNorm();
  }
  bool BVTesting(int first, int second) const override {
    if (first != seen_) see(first);
    const TriangleBvh::Node& face = faces_.node(second);
    return areApart(box_, face.low, face.high, reach_) || isOffPlane(face);
  }
  void leafTesting(int first, int second) const override {
    pairs_.push_back(pairOf(TriangleBvh::triangleOf(surface_.node(first)),
                            TriangleBvh::triangleOf(faces_.node(second))));
  }

 private:
  void see(int first) const {
    seen_ = first;
    const auto& node = surface_.node(first);
    if (!TriangleBvh::isLeaf(node)) {
      box_ = seenFrom(mesh_T_tissue_, centered(node));
      normal_ = Vec3::Zero();
      return;
    }
    Corners corners = surface_.corners(TriangleBvh::triangleOf(node));
    Box box;
    for (Vec3& corner : corners) {
      corner = mesh_T_tissue_ * corner;
      box.extend(corner);
    }
    box_ = {box.center(), 0.5 * box.diagonal()};
    origin_ = corners[0];
    normal_ = (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
  }

  // All of a box is farther from the plane of the triangle than the reach. False without one.
  bool isOffPlane(const TriangleBvh::Node& face) const {
    const CenteredBox box = centered(face);
    const double height = std::abs(normal_.dot(box.center - origin_));
    const double beside = normal_.cwiseAbs().dot(box.half) + reach_;
    return height > beside * (1.0 + tuning::kBeyondRounding) + tuning::kRounding;
  }

  const Pose& mesh_T_tissue_;
  const TriangleBvh& faces_;
  double reach_;
  std::vector<std::uint64_t>& pairs_;
  mutable int seen_ = -1;    // the surface's node that was asked for last
  mutable CenteredBox box_;  // its box in the mesh's frame
  // Of a triangle its plane there; else the normal is zero.
  mutable Vec3 origin_ = Vec3::Zero(), normal_ = Vec3::Zero();
};

}  // namespace

std::vector<int> trianglesNear(const PlacedShape& shape, const TriangleBvh& surface,
                               double margin) {
  std::vector<int> triangles;
  if (surface.isEmpty()) return triangles;
  BesideShape beside(shape, surface, margin, triangles);
  fcl::detail::collisionRecurse<double>(&beside, 0, 0, nullptr);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

FacePairs::FacePairs(const PlacedShape& mesh, const TriangleBvh& surface, double margin) {
  if (surface.isEmpty() || mesh.shape->mesh().tree().isEmpty()) return;
  BesideMesh beside(mesh, surface, margin + mesh.shape->padding(), pairs_);
  fcl::detail::collisionRecurse<double>(&beside, 0, 0, nullptr);
  std::sort(pairs_.begin(), pairs_.end());
}

void FacePairs::facesNear(int triangle, std::vector<int>& faces) const {
  faces.clear();
  const std::uint64_t end = pairOf(triangle + 1, 0);
  for (auto pair = std::lower_bound(pairs_.begin(), pairs_.end(), pairOf(triangle, 0));
       pair != pairs_.end() && *pair < end; ++pair) {
    faces.push_back(static_cast<int>(*pair & 0xffffffffU));
  }
}

const FacePairs& KeptFacePairs::of(const PlacedShape& mesh, const TriangleBvh& surface,
                                   std::uint64_t tree, const std::vector<Vec3>& vertices,
                                   double margin) {
  if (tree == tree_ && holdFor(mesh.shape_T_tissue, vertices, margin)) return pairs_;
  tree_ = tree;
  reach_ = (1.0 + tuning::kPairsAhead) * margin;
  pairs_ = FacePairs(mesh, surface, reach_);
  vertices_.clear();
  for (const Vec3& vertex : vertices) vertices_.push_back(mesh.shape_T_tissue * vertex);
  return pairs_;
}

// Nothing came nearer by more than was sought in advance.
bool KeptFacePairs::holdFor(const Pose& mesh_T_tissue, const std::vector<Vec3>& vertices,
                            double margin) const {
  const double ahead = reach_ - margin;
  if (ahead < 0.0 || vertices.size() != vertices_.size()) return false;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!((mesh_T_tissue * vertices[i] - vertices_[i]).squaredNorm() <= ahead * ahead))
      return false;
  }
  return true;
}

}  // namespace robot_tissue
