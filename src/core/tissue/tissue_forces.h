// Forces on the tissue as it is (N, tissue frame), and how it gives way to them; it changes
// nothing. What each function tells: as of Tissue.
#pragma once

#include <optional>

#include "robot_tissue/core/narrow_contact.h"
#include "tissue/pressed_surfaces.h"
#include "tissue/tissue_data.h"

namespace robot_tissue {

class TissueForces {
 public:
  explicit TissueForces(const TissueData& data) : data_(data) {}

  Vec3 nodeForce(int node) const;
  Vec3 weight() const;
  Vec3 forceOfFixedNodes() const;
  double stiffening(int node) const;
  std::optional<RimModuli> rimModuli(int node) const;
  std::optional<RimCompliance> rimCompliance(int node, double depth) const;
  Vec3 inwardsAround(const SurfacePoint& point, const Vec3& middle) const;
  std::vector<RimSpring> springsUnder(const std::vector<SeatedNode>& nodes) const;
  std::optional<Recess> recessUnder(const NarrowPress& press) const;

 private:
  const TissueData& data_;
  mutable PressedSurfaces surfaces_;
};

}  // namespace robot_tissue
