// The tissue itself: the lattice, its shape, what holds its nodes together, and the surface that
// they carry. Lengths in m, forces in N, in the tissue's frame.
//
// Whoever changes displacements does so by `change`, so that `displacements` is one copy a shape.
// Whoever changes the cells calls rebuildSurface, and then whoever changed displacements `deform`:
// only then the surface is that of the shape.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "membrane/membrane_plan.h"
#include "robot_tissue/core/contact_spring.h"
#include "robot_tissue/core/tissue.h"

namespace robot_tissue {

class TissueModel;

class Body {
 public:
  // At rest. Throws InputError, as Tissue.
  explicit Body(const TissueConfig& tissue);
  ~Body();

  const Lattice& lattice() const { return lattice_; }
  const LatticeState& state() const { return state_; }
  const CellSet& cells() const { return *state_.cells; }
  const std::vector<Vec3>& displacement() const { return state_.displacement; }
  Tissue::Displacements displacements() const;
  // To change displacements or cells; the kept copy of displacements is dropped.
  LatticeState& change();
  void setAhead(std::vector<SpringAhead> ahead) { state_.ahead = std::move(ahead); }

  TissueModel& model() { return *model_; }
  const TissueModel& model() const { return *model_; }
  // The same tissue with other moduli: the model is made anew, and the earlier one given away.
  std::unique_ptr<TissueModel> remake(const TissueConfig& tissue);
  bool hasBodyLoad() const { return has_body_load_; }  // the rest shape is not in balance
  const Vec3& gravity() const { return gravity_; }     // m/s^2
  const Vec3& weight() const { return weight_; }       // of all, also of pieces that hang
  void weigh();                                        // after cells went or came

  const TissueSurface& surface() const { return surface_; }
  const std::vector<Vec3>& vertices() const { return vertices_; }  // deformed
  const Box& bounds() const { return bounds_; }                    // of them
  double volumeRatio() const;  // enclosed by the surface, over that at rest (1)
  void rebuildSurface();       // of the cells there are, with its vertices at rest
  void showRest();             // the vertices are those at rest, bit for bit
  // Where a tool's spring has its point, off where the nodes carry it (m).
  using OffPoint = Vec3 (*)(const ContactSpring&, const std::vector<Vec3>&);
  // The surface is that of the displacements, but for nodes at rims, which are where patches and
  // tools have them.
  void deform(const std::vector<LoadingPatch>& patches, OffPoint of_tools = drawnOff);
  std::vector<Vec3> shownDisplacement(const std::vector<LoadingPatch>& patches) const;

  std::vector<int> freeNodes() const;    // neither fixed nor removed
  Vec3 nodePosition(int node) const;     // deformed
  double nodeStiffness(int node) const;  // Tissue::nodeStiffness

 private:
  void planMembranes(const TissueConfig& tissue);
  std::vector<std::pair<int, Vec3>> shownAsTheirOwn(const std::vector<LoadingPatch>& patches,
                                                    OffPoint of_tools) const;

  Lattice lattice_;
  LatticeState state_;
  mutable Tissue::Displacements kept_;  // of state_; null: nobody asked since it changed
  std::unique_ptr<TissueModel> model_;  // of lattice_, which must stay where it is
  bool has_body_load_ = false;          // gravity, or a pressure
  Vec3 gravity_ = Vec3::Zero();
  Vec3 weight_ = Vec3::Zero();
  TriangleMesh mesh_;  // with edges of a spacing at most; empty: the shape is a box
  TissueSurface surface_;
  double rest_volume_ = 0.0;  // m^3
  std::vector<Vec3> vertices_;
  Box bounds_;
  std::unique_ptr<const MembranePlan> membranes_;  // null: none
};

}  // namespace robot_tissue
