// FCL's tree of boxes over the triangles of a closed surface, refitted as they move, and what FCL
// does not tell reliably of it: nearest point, inside or outside.
//
// The tree is in parts of some dozen triangles. When the surface moves, the box of each part that
// moved is made anew, and those above the parts; the boxes within a part only when a search comes
// there (open). So a move costs a comparison of each vertex with where it was, and no more where no
// tool is.
#pragma once

#include <fcl/geometry/bvh/BVH_model.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/triangle_point.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class TriangleBvh {
 public:
  using Model = fcl::BVHModel<fcl::AABBd>;
  using Node = fcl::BVNode<fcl::AABBd>;

  struct Nearest {
    int triangle = -1;
    Vec3 weights = Vec3::Zero();  // of its corners; 0 for those of the other edge or vertex
    Vec3 point = Vec3::Zero();
    double distance = 0.0;
  };

  // All vertices finite. No triangles: nothing is near, and all is outside.
  TriangleBvh(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles);

  // The same triangles with their vertices elsewhere. Those with a corner that is not finite are
  // left out. False: none has moved.
  bool moveTo(const std::vector<Vec3>& vertices);

  // Nearest point of the surface, among those nearer than `reach`. As soon as one is found that is
  // not farther than `enough`, that one.
  std::optional<Nearest> nearest(const Vec3& point, double reach, double enough = 0.0) const;

  // Whether the surface goes around the point more often outwards than inwards: right also where it
  // crosses or touches itself. Counts the triangles that a ray meets; neighbors take the same side
  // of their edge (after Woop, Benthin, Wald 2013), so that none slips between them.
  bool isInside(const Vec3& point) const;

  TriangleBvh(const TriangleBvh&) = delete;
  TriangleBvh& operator=(const TriangleBvh&) = delete;

  Box bounds() const;  // empty (min > max) without triangles
  const std::vector<MeshTriangle>& triangles() const { return triangles_; }

  // For FCL's traversals: numbers of nodes as FCL's, 0 the root.
  bool isEmpty() const { return nodes_ == nullptr; }
  const std::shared_ptr<Model>& model() const { return model_; }
  // A node's box is up to date once the nodes above it are open.
  const Node& node(int number) const { return nodes_[number]; }
  void open(int number) const {
    const int part = part_at_[at(number)];
    if (part >= 0 && parts_[at(part)].is_stale) refit(parts_[at(part)]);
  }
  static bool isLeaf(const Node& node) { return node.first_child < 0; }
  static int triangleOf(const Node& leaf) { return -leaf.first_child - 1; }
  // Places of a triangle's corners; up to date once the nodes above its leaf are open.
  const Corners& corners(int triangle) const { return corners_[at(triangle)]; }

 private:
  // A subtree; below its root its nodes follow each other, parents first. It has its own copies of
  // the vertices: places from one slot to another.
  struct Part {
    int root = 0, first = 0, end = 0;
    int first_slot = 0, end_slot = 0;
    bool is_stale = true;
  };

  struct Search {
    const Vec3& point;
    double best, enough;  // squared distances (m^2)
    Nearest found;
  };

  void searchBelow(int number, Search& search) const;
  void searchTriangle(int triangle, Search& search) const;
  int crossingsBelow(int number, const Vec3& point) const;
  void findParts(std::size_t vertex_count);
  int addPart(int root, std::vector<int>& last_slots);
  void addSlots(Part& part, std::vector<int>& last_slots);
  bool movePart(Part& part, const std::vector<Vec3>& vertices);
  void refit(Part& part) const;
  void fit(int number) const;

  std::vector<MeshTriangle> triangles_;
  std::vector<int> vertices_;        // per slot: the vertex whose place it keeps
  std::vector<Vec3> places_;         // per slot: where that is (m)
  std::vector<MeshTriangle> slots_;  // per triangle: those of its corners
  std::shared_ptr<Model> model_;
  Node* nodes_ = nullptr;                 // the model's
  mutable std::vector<Corners> corners_;  // per triangle
  mutable std::vector<Part> parts_;
  std::vector<int> part_at_;  // per node: the part whose root it is, or -1
  std::vector<int> above_;    // nodes above the parts, parents first
};

}  // namespace robot_tissue
