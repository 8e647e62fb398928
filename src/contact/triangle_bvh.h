// A tree of boxes over the triangles of a closed surface, refitted as they move: for FCL's
// traversals, and for what FCL does not tell reliably, nearest point, inside or outside.
//
// The tree is in parts of some dozen triangles. When the surface moves, the box of each part that
// moved is made anew, and those above the parts; the boxes within a part only when a search comes
// there (open), and a part is split up when the first one does. So a new surface, and a move, cost
// little more than a look at each vertex where no tool is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/triangle_point.h"
#include "robot_tissue/core/types.h"
#include "triangle_splitter.h"

namespace robot_tissue {

class TriangleBvh {
 public:
  struct Node {
    Vec3 low, high;                         // of its box (m)
    int first_child = 0;                    // the second follows it; of a leaf -1 - its triangle
    int first_triangle = 0, triangles = 0;  // places in the splitter
  };

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
  const std::vector<Vec3>& madeOf() const { return splitter_.vertices(); }
  const std::vector<Vec3>& vertices() const { return vertices_; }  // where they are now

  // For traversals: 0 is the root.
  bool isEmpty() const { return triangles_.empty(); }
  // A node is there, and its box up to date, once the nodes above it are open. It stays where it is
  // until the next one is opened.
  const Node& node(int number) const { return nodes_[at(number)]; }
  void open(int number) const {
    if (number < first_within_ && part_at_[at(number)] >= 0) openPart(part_at_[at(number)]);
  }
  static bool isLeaf(const Node& node) { return node.first_child < 0; }
  static int triangleOf(const Node& leaf) { return -leaf.first_child - 1; }
  Corners corners(int triangle) const {
    const auto& [a, b, c] = triangles_[at(triangle)];
    return {vertices_[at(a)], vertices_[at(b)], vertices_[at(c)]};
  }

 private:
  // A subtree; once it is split, its nodes below its root follow each other, parents first.
  struct Part {
    int root = 0, first = 0, end = 0;
    int first_vertex = 0, end_vertex = 0;  // in vertices_of_parts_
    bool is_stale = true;
    bool is_split = false;
  };

  struct Search {
    const Vec3& point;
    double best, enough;  // squared distances (m^2)
    Nearest found;
  };

  void searchBelow(int number, Search& search) const;
  void searchTriangle(int triangle, Search& search) const;
  int crossingsBelow(int number, const Vec3& point) const;
  void findParts();
  void addPart(int root);
  void addVertices(Part& part, std::vector<int>& part_of_last);
  bool movePart(Part& part, const std::vector<Vec3>& vertices);
  void openPart(int number) const;
  void splitNode(int number, int first_child) const;
  void splitPart(Part& part) const;
  void refit(const Part& part) const;
  void fit(int number) const;

  const std::vector<MeshTriangle> triangles_;
  std::vector<Vec3> vertices_;          // m
  std::vector<int> vertices_of_parts_;  // one after the other: a vertex may be of several
  mutable TriangleSplitter splitter_;
  mutable std::vector<Node> nodes_;  // down to the parts' roots, then those within split parts
  mutable std::vector<Part> parts_;
  int first_within_ = 0;      // the first node that is within a part
  std::vector<int> part_at_;  // per node before: the part whose root it is, or -1
  std::vector<int> above_;    // nodes above the parts, parents first
};

}  // namespace robot_tissue
