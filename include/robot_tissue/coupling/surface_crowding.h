// How many vertices of the surface hang on a node: one on a block's face, tens where a mesh is
// finer than the lattice.
//
// There many touches push the same few nodes. Were each as stiff as one alone, all together would
// be as many times stiffer than the tissue, and hard to solve for; so they share the stiffness.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "robot_tissue/core/surface.h"

namespace robot_tissue {

class SurfaceCrowding {
 public:
  // Looks at a surface that is not the last one. Nodes: with ghosts.
  void take(const TissueSurface& surface, std::size_t nodes);
  // By how much a touch of a point with these carriers is softer than one alone (1), at least 1.
  double under(const std::vector<NodeWeight>& carriers) const;

 private:
  std::uint64_t revision_ = 0;  // of the surface; 0: none yet
  // Per node: sum of its weights. Shared by all that is kept of touches.
  std::shared_ptr<const std::vector<double>> vertices_;
};

}  // namespace robot_tissue
