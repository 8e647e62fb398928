// What a narrow contact presses, of the tissue as it is: of a flat surface of whole cells by the
// table of point loads, elsewhere by the lattice around the force.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "loads/local_lattice.h"
#include "loads/narrow_contact.h"
#include "surface/smooth_part.h"
#include "tissue/body.h"

namespace robot_tissue {

class PressedSurfaces {
 public:
  // Nothing where the contact is wide or the tissue is no half-space: thin, or of several materials
  // near the force.
  std::optional<PressedSurface> under(const NarrowPress& press, const Body& body,
                                      const ElasticModel& model,
                                      const std::vector<LoadingPatch>& patches);

  // As Tissue.
  Vec3 inwardsAround(const SurfacePoint& point, const Vec3& middle, const Body& body);

 private:
  bool look(const NarrowPress& press, const Body& body, const ElasticModel& model,
            const std::vector<LoadingPatch>& patches, PressedSurface& surface);

  // Mean, at rest (1/m): > 0 where it bulges outwards.
  double curvatureAround(const SurfacePoint& point, const Vec3& middle, const Body& body);

  LocalLattice& around(const NarrowPress& press, const Body& body);

  // Around forces that were on no flat surface: in the rounds of a load step, and under several
  // tools, the node that bears most goes to and fro.
  std::array<LocalLattice, 4> around_;
  std::size_t oldest_ = 0;
  SmoothParts parts_;
};

}  // namespace robot_tissue
