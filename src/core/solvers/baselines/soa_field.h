// A shape of model `elastic` in single precision, laid out for vector instructions
// (colored_layout.h), with what may move in it (own). What lanes cannot do is done beside them in
// double precision: cells filled in part, as a cut leaves them, and nodes in contact ("odd" ones).
//
// Units: lane_kernels.h.
#pragma once

#include <cstdlib>
#include <memory>
#include <vector>

#include "loads/dof_constraints.h"
#include "material/elastic_model.h"
#include "solvers/baselines/kernels/lane_kernels.h"
#include "solvers/baselines/spare_arrays.h"

namespace robot_tissue {

class SoaField {
 public:
  // One array an axis; in each a number a slot (ColoredLayout).
  using Arrays = std::array<float*, 3>;

  // kNone: in a time step, too, the energy is that of the shape alone.
  enum class Inertia { kOfTimeSteps, kNone };

  SoaField(const Lattice& lattice, const ElasticModel& model,
           Inertia inertia = Inertia::kOfTimeSteps);

  // Takes a shape, and what is held in it, as hold.bind left it.
  void bind(const ConstrainedState& shape, const DofConstraints& hold);
  // Takes the displacements of these nodes; takeRims: the springs of rims, whose patches have
  // moved.
  void take(const LatticeState& state, const std::vector<int>& nodes);
  void takeRims(const ConstrainedState& shape);
  void takeAll(const LatticeState& state) { take(state, all_); }
  // Writes the displacements of all nodes that may move to the state; giveWatched: of those alone
  // that odd cells, odd nodes and patches by force depend on.
  void give(LatticeState& state) const { give(movable_, state); }
  void giveWatched(LatticeState& state) const { give(watched_, state); }
  // Finds the cells whose tightest corner is near to where the barrier begins: the others' kernels
  // leave it out. True: it has risen in one that was not among them.
  bool findSqueezed();
  const std::vector<int>& oddNodes() const { return odd_nodes_; }
  const std::vector<int>& oddCells() const { return odd_cells_; }

  // A sweep through the nodes that are not odd, color after color, each to its balance times
  // `relaxation`.
  void relax(float relaxation, float most);

  // One over a bound of the stiffness of each node alone that is not odd, in this shape.
  void findSoftness(float* softness) const;

  // A step of XPBD for the cells that are not odd, color after color; damping may be null.
  void project(const Arrays& mobility, const SoaDamping* damping);

  // Forces on all nodes, without contacts; the state must have been given the watched nodes.
  void findForces(const LatticeState& state);

  int size() const { return size_; }  // slots, in whole blocks
  int slotOf(int node) const { return slots_[at(node)]; }
  double unit() const { return unit_; }  // of displacements (m)
  const Arrays& moved() const { return moved_; }
  const Arrays& force() const { return force_; }
  const Arrays& free() const { return free_; }             // 1 where a component moves
  const float* compliance() const { return compliance_; }  // of each node alone, at rest
  Vec3 forceOn(int node) const;                            // N
  void addForce(int node, const Vec3& force);              // N
  double stiffnessUnit() const { return modulus_ * lattice_.spacing() / 16.0; }  // N/m
  double restStiffness(int node) const;  // mean, at rest (N/m); 0: nothing holds it
  int nodeCount() const { return static_cast<int>(movable_.size()); }
  // Writes the node's displacement to the state, held components too, as where a patch moved it.
  void giveAll(int node, LatticeState& state) const;
  // Further arrays (SpareArray), zero after bind() has met other cells.
  static constexpr int kFreeMotion = kSpareArrays;  // one more in time: InertialTerm::free_motion
  const Arrays& spare(int index) const { return spare_[at(index)]; }

 private:
  struct FreeBuffer {
    void operator()(float* buffer) const { std::free(buffer); }
  };
  void layOut(const ConstrainedState& shape);
  void allocate();
  void hold(const ConstrainedState& shape, const DofConstraints& hold);
  void findCompliance(const ConstrainedState& shape);
  void takeInertia();
  void sortOut(const ConstrainedState& shape, const DofConstraints& hold);
  std::vector<std::uint8_t> takeLaneCells();
  void takeFreeMotion();
  void watch(const ConstrainedState& shape, const DofConstraints& hold);
  void give(const std::vector<int>& nodes, LatticeState& state) const;
  SoaArrays lanes(const Arrays& free) const;
  std::vector<int> blocksWith(const std::vector<std::uint8_t>& slots, int color) const;

  const Lattice& lattice_;
  const ElasticModel& model_;
  ColoredLayout grid_;
  double unit_;
  Inertia takes_inertia_;
  const InertialTerm* inertia_ = nullptr;  // of the time step; null: none
  double rest_modulus_ = 0.0;              // Pa, the greatest
  double modulus_ = 0.0;                   // with what a time step adds
  double force_unit_ = 0.0;
  std::shared_ptr<const CellSet> cells_;
  std::vector<int> slots_;          // per node
  std::vector<int> all_;            // nodes
  std::vector<std::uint8_t> held_;  // per node: Dirichlet mask of the last bind()
  std::vector<int> loads_;          // nodes that loads acted on then
  int size_ = 0;
  std::unique_ptr<float, FreeBuffer> buffer_;
  Arrays moved_{}, load_{}, free_{}, lane_free_{}, force_{};
  std::array<Arrays, kSpareArrays + 1> spare_{};
  float* shear_ = nullptr;
  float* bulk_ = nullptr;
  float* stiffening_ = nullptr;  // null: 0 in all
  bool stiffens_ = false;
  float* compliance_ = nullptr;
  float* tightest_ = nullptr;
  std::vector<int> lane_cells_;
  std::vector<std::uint8_t> squeezed_cells_, squeezed_nodes_;  // per block
  std::vector<int> odd_cells_, odd_nodes_, watched_, movable_;
  std::array<std::vector<int>, kColors> cell_blocks_, node_blocks_;
  std::vector<SoaSprings> springs_;
  std::vector<int> springs_of_block_;  // -1 = none
  std::vector<Vec3> weight_;           // per node: of its lane cells, and InertialTerm::force (N)
  std::vector<double> lane_masses_;    // per node, in a time step: of its lane cells (kg)
  std::vector<Vec3> scratch_;          // forces (N)
};

}  // namespace robot_tissue
