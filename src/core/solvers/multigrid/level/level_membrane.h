// What membranes add on a level (own): on the finest by their law; on a coarser one by the finest's
// tangent stiffness K, P^T K P about where the level starts. Forces in E0 h^2, stiffness in E0 h.
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
  // Of the finest level. `entries`: of the membrane's nodes, in their order. Spacing (m), E0 (Pa).
  LevelMembrane(std::shared_ptr<const Membrane> membrane, std::vector<int> entries, double spacing,
                double modulus);
  // Of the next coarser level than `fine`. `carriers`: per entry of that, its shares in P.
  LevelMembrane(const LevelMembrane& fine, const std::vector<NodeShares>& carriers);

  const std::vector<int>& entries() const { return entries_; }  // that it acts on

  // Stiffness as the shape is now; of a coarser level, as the finer one's is now, of which nodes
  // held in these axes do not move.
  void renew(const Field<Real>& displacement);
  void renew(const LevelMembrane& fine, const std::vector<std::uint8_t>& held);
  // Of a coarser level: it has no force there.
  void startAt(const Field<Real>& displacement);

  void addForces(const Field<Real>& displacement, Field<Real>& forces) const;
  // Blocks on the diagonal of the stiffness, in the order of the entries, times what makes them at
  // least 1 / `greatest` of it in every motion.
  std::vector<Eigen::Matrix3d> diagonal(double greatest);

 private:
  // Of a block of the finer level's stiffness in one of this level's.
  struct Part {
    int to = 0;
    double weight = 0.0;
  };

  std::vector<Vec3> gather(const Field<Real>& displacement) const;

  std::shared_ptr<const Membrane> membrane_;  // null: a coarser level
  double spacing_ = 1.0, modulus_ = 1.0;
  std::vector<int> entries_;
  NodeBlocks stiffness_;
  std::vector<int> first_part_;  // per block of the finer level
  std::vector<Part> parts_;
  std::vector<Vec3> start_;
  std::vector<Vec3> stiffest_;  // motion, as last found
};

extern template class LevelMembrane<float>;
extern template class LevelMembrane<double>;

}  // namespace robot_tissue
