// Membranes on a surface: sheets that stretch in their plane, bend where triangles meet, and are
// pushed from inside (doc/model.md, "Membranes"). Their energy hangs on where the surface's
// vertices are, and these on the nodes that carry them: it is one of the nodes' displacements.
#pragma once

#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include "membrane/hinge.h"
#include "membrane/node_blocks.h"
#include "membrane/pressed_triangle.h"
#include "membrane/sheet_kernel.h"
#include "membrane/sheet_law.h"
#include "membrane/stretched_triangle.h"
#include "membrane/vertex_carriers.h"
#include "robot_tissue/core/surface.h"

namespace robot_tissue {

// A membrane, and where it is on a surface.
struct MembranePart {
  SheetLaw law;
  std::vector<int> triangles;
  std::vector<int> pressed;  // of these, those that enclose what the pressure is in: closed
  double pressure = 0.0;     // along the triangles' normals (Pa)
};

class Membrane {
 public:
  Membrane(const TissueSurface& surface, const std::vector<MembranePart>& parts);

  // That carry it, ascending. What follows is by their order here; displacements in m.
  const std::vector<int>& nodes() const { return nodes_; }
  // Of these in displacements of all nodes.
  std::vector<Vec3> ofNodes(const std::vector<Vec3>& displacement) const;

  double energy(const std::vector<Vec3>& moved) const;  // zero at rest but for pressure (J)
  std::vector<Vec3> forces(const std::vector<Vec3>& moved) const;     // on the nodes (N)
  Vec3 force(const std::vector<Vec3>& displacement, int node) const;  // of all nodes; on this one
  double pressureNorm(const std::vector<Vec3>& moved) const;  // L2 of a pressure's forces (N)

  // Of the vertices, by the nodes' order here.
  const VertexCarriers& carriers() const { return carriers_; }
  // Of the vertices: zero, with the places that `findStiffness` fills with the energy's second
  // derivative K by where they are (N/m). By the nodes it is W^T K W.
  NodeBlocks stiffnessPattern() const { return pattern_; }
  void findStiffness(const std::vector<Vec3>& moved, Curvature curvature,
                     NodeBlocks& of_vertices) const;
  // Mean over the axes of that against moving the node alone, at rest (N/m); 0 beside membranes.
  double restStiffness(int node) const;

 private:
  struct Element {
    std::variant<StretchedTriangle, Hinge, PressedTriangle> law;
    std::array<int, 4> vertices;  // the last one of hinges alone
  };
  void take(const TissueSurface& surface, const std::vector<MembranePart>& parts);
  void addSheet(const TissueSurface& surface, const MembranePart& part);
  void addHinges(const TissueSurface& surface, const MembranePart& part);
  void bindNodes(const TissueSurface& surface);
  void makePattern();
  void bindKernel();
  void addPressure(const std::vector<Vec3>& places, std::vector<Vec3>& on_vertices) const;
  std::vector<Vec3> placesOf(const std::vector<Vec3>& moved) const;  // of vertices (m)

  std::vector<Element> elements_;
  SheetKernel sheet_;                   // of those that have no pressure
  std::vector<int> pressed_;            // of the elements
  std::vector<Vec3> rest_;              // of vertices (m)
  std::vector<int> vertex_of_surface_;  // per vertex here: that of the surface
  std::vector<int> nodes_;
  std::vector<std::vector<int>> elements_at_;  // per node
  VertexCarriers carriers_;
  NodeBlocks pattern_;
  std::vector<int> places_;  // in it: of each element's pairs of vertices
  std::vector<double> rest_stiffness_;
  std::vector<Vec3> rounding_;  // of forces at rest, on vertices, pressure left out (N)
};

}  // namespace robot_tissue
