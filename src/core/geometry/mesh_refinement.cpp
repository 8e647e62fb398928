#include <algorithm>
#include <map>
#include <utility>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {
namespace {

// One round: every edge that is too long gets a vertex in its middle.
class Refinement {
 public:
  Refinement(TriangleMesh& mesh, double longest_edge)
      : mesh_(mesh), longest_squared_(longest_edge * longest_edge) {}

  // False when no edge was too long.
  bool run() {
    const std::vector<MeshTriangle> whole = std::move(mesh_.triangles);
    mesh_.triangles.clear();
    for (const MeshTriangle& triangle : whole) split(triangle);
    return !middles_.empty();
  }

 private:
  double squaredLength(int a, int b) const {
    return (mesh_.vertices[at(a)] - mesh_.vertices[at(b)]).squaredNorm();
  }
  bool isLong(int a, int b) const { return squaredLength(a, b) > longest_squared_; }

  int middle(int a, int b) {
    const auto [place, is_new] = middles_.try_emplace(std::minmax(a, b), 0);
    if (is_new) {
      place->second = static_cast<int>(mesh_.vertices.size());
      mesh_.vertices.push_back(0.5 * (mesh_.vertices[at(a)] + mesh_.vertices[at(b)]));
    }
    return place->second;
  }

  void add(int a, int b, int c) { mesh_.triangles.push_back({a, b, c}); }

  void split(const MeshTriangle& triangle) {
    // Turned so that a, b is the longest edge: the new edges are then shorter than it by a fixed
    // share, and the rounds come to an end.
    std::size_t first = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (squaredLength(triangle[i], triangle[(i + 1) % 3]) >
          squaredLength(triangle[first], triangle[(first + 1) % 3])) {
        first = i;
      }
    }
    const int a = triangle[first];
    const int b = triangle[(first + 1) % 3];
    const int c = triangle[(first + 2) % 3];
    if (!isLong(a, b)) return mesh_.triangles.push_back(triangle);
    const int ab = middle(a, b);
    const int bc = isLong(b, c) ? middle(b, c) : -1;
    const int ca = isLong(c, a) ? middle(c, a) : -1;
    if (bc >= 0 && ca >= 0) {
      add(ab, bc, ca);
      add(a, ab, ca);
      add(ab, b, bc);
      add(ca, bc, c);
      return;
    }
    splitHalf(ab, b, c, bc);
    splitHalf(ab, c, a, ca);
  }

  // The half with the edge from b to c, which has a middle when that is not -1.
  void splitHalf(int ab, int b, int c, int bc) {
    if (bc < 0) return add(ab, b, c);
    add(ab, b, bc);
    add(ab, bc, c);
  }

  TriangleMesh& mesh_;
  double longest_squared_;
  std::map<std::pair<int, int>, int> middles_;
};

}  // namespace

TriangleMesh refined(TriangleMesh mesh, double longest_edge) {
  while (Refinement(mesh, longest_edge).run()) {
  }
  return mesh;
}

}  // namespace robot_tissue
