// The paper's springs: F = -k x along each spring (section 4.3), one to each of six neighbors.
// It resists stretch of the springs only: rows and columns shear for nothing (doc/paper.md).
#pragma once

#include <vector>

#include "material/tissue_model.h"
#include "robot_tissue/core/lattice.h"

namespace robot_tissue {

class SixSpringModel : public TissueModel {
 public:
  // gravity in m/s^2; the lattice must outlive the model. Of the materials that it has now.
  SixSpringModel(const Lattice& lattice, const Vec3& gravity);

  Vec3 nodeForce(const LatticeState& state, int node) const override;
  Vec3 nodeStiffness(const LatticeState& state, int node) const override;
  Vec3 weight(const LatticeState& state) const override;

 private:
  Vec3 nodeWeight(const LatticeState& state, int node) const;
  Vec3 springForce(const LatticeState& state, int node, int direction) const;

  const Lattice& lattice_;
  Vec3 gravity_;
  std::vector<double> stiffness_;  // per spring (N/m)
  std::vector<double> mass_;       // per node of the lattice (kg)
};

}  // namespace robot_tissue
