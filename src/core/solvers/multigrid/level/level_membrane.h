// What membranes add on a level (own): on the finest by their law; on a coarser one by the finest's
// tangent stiffness K of their vertices, W^T K W about where the level starts, W what carries them
// there. Forces in E0 h^2, stiffness in E0 h.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "membrane/membrane.h"
#include "solvers/multigrid/level/cell_operator.h"
#include "solvers/multigrid/level/lattice_coarsening.h"

namespace robot_tissue {

template <typename Real>
class LevelMembrane {
 public:
  // Of the finest level. `entries`: per node of the tissue. Spacing (m), E0 (Pa).
  LevelMembrane(std::shared_ptr<const Membrane> membrane, const std::vector<int>& entries,
                double spacing, double modulus);
  // Of the next coarser level than `fine`. `carriers`: per entry of that, its shares in P.
  LevelMembrane(const LevelMembrane& fine, const std::vector<NodeShares>& carriers);

  const std::vector<int>& entries() const { return entries_; }  // that it acts on

  // Of a coarser level, after the finer one: nodes of that which are held in all axes do not move.
  void bind(const LevelMembrane& fine, const std::vector<std::uint8_t>& held);
  // Of the finest level: all levels are as stiff as its shape is now. Else nothing.
  void renew(const Field<Real>& displacement);
  // Of a coarser level: it has no force there.
  void startAt(const Field<Real>& displacement);

  void addForces(const Field<Real>& displacement, Field<Real>& forces) const;
  // The stiffness times a motion of the entries (E0 h^2).
  std::vector<Vec3> timesStiffness(const std::vector<Vec3>& motion) const;
  // Blocks on the diagonal of the stiffness, in the order of the entries, times what makes them at
  // least 1 / `greatest` of it in every motion.
  std::vector<Eigen::Matrix3d> diagonal(double greatest);
  void forget() { stiffest_.clear(); }  // what was found of the last shape

 private:
  std::vector<Vec3> gather(const Field<Real>& displacement) const;

  std::shared_ptr<const Membrane> membrane_;
  double spacing_, modulus_;
  std::vector<int> entries_;
  std::shared_ptr<NodeBlocks> of_vertices_;     // K (N/m), one for all levels
  VertexCarriers carriers_;                     // W
  std::vector<VertexCarriers::Shares> shares_;  // P of the finer level's entries; empty: finest
  std::vector<Vec3> start_;
  std::vector<Vec3> stiffest_;  // motion, as last found
};

extern template class LevelMembrane<float>;
extern template class LevelMembrane<double>;

}  // namespace robot_tissue
