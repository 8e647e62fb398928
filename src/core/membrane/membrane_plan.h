// Which triangles of a tissue's surface each membrane is on. They are chosen on the surface as it
// was made; on one that cuts have changed the membranes are on what is left of these triangles, not
// on faces that a cut opened.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "membrane/membrane.h"
#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/surface.h"

namespace robot_tissue {

class MembranePlan {
 public:
  // `as_made`: the surface before any cut; it is copied. Throws InputError for a membrane that
  // nothing of it has.
  MembranePlan(const std::vector<MembraneConfig>& membranes, const TissueSurface& as_made,
               double spacing);

  const TissueSurface& asMade() const { return as_made_; }

  // A pressure acts only where the triangles that are pressed are closed: a cut lets it out. Null:
  // nothing of the membranes is left.
  std::shared_ptr<const Membrane> on(const TissueSurface& surface) const;

 private:
  using Bin = std::array<int, 3>;

  Bin binOf(const Vec3& place) const;
  void fillBins();
  MembranePart partOn(const TissueSurface& surface, std::size_t membrane) const;
  int madeFrom(const TissueSurface& surface, int triangle) const;

  std::vector<MembraneConfig> membranes_;
  TissueSurface as_made_;
  double spacing_;
  std::vector<std::vector<std::uint8_t>> covers_;  // per membrane and triangle as made
  std::map<Bin, std::vector<int>> bins_;           // triangles by where they are, in spacings
};

}  // namespace robot_tissue
