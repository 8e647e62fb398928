// The method of Omar, Islam and Haron, "Heuristic Modeling of Deformable Object using Node-based
// Structure with Mass-spring System", sections 4.2 and 4.3, figures 3 and 4.
//
// One solve is one load step: the loading patches move first, then one pass of layers outwards,
// each node moved until its forces balance, until the next layer is no longer disturbed. The paper
// does not go back to inner layers, so the shape is an unfinished relaxation: it depends on the
// number of load steps (measured in doc/paper.md).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "material/tissue_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/solve_report.h"
#include "solvers/paper/layers.h"
#include "solvers/solve_clock.h"
#include "solvers/solver_method.h"

namespace robot_tissue {

// Where the paper is silent. The effect of each choice is measured in doc/paper.md.
struct PaperOptions {
  // A node is balanced when its net force is below this share of the greatest force on a patch
  // node. Smaller: more layers are raised, more time.
  double balance_tolerance = 0.01;
  // Longest single move of a node or a patch, in lattice spacings.
  double step_in_spacings = 0.2;
  // Passes of patch and layers in one load step. The paper makes one.
  int passes = 1;
  enum class Order { kTwoColor, kByIndex };
  // kTwoColor: even nodes before odd ones, so that springs join only nodes of different color and
  // a symmetric load gives a symmetric shape. kByIndex: x fastest, then y, then z.
  Order order = Order::kTwoColor;
  int max_moves_per_node = 20;
  int max_sweeps_per_layer = 200;
  int max_patch_moves = 1000;
  double max_ms = 0.0;  // 0 = no budget
};

class PaperMethod : public SolverMethod {
 public:
  PaperMethod(const Lattice& lattice, const TissueModel& model, const PaperOptions& options);

  SolveReport solve(std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                    LatticeState& state) override;
  void limitTime(double ms) override { options_.max_ms = ms; }
  double patchStep() const override;

 private:
  using AxisMask = std::uint8_t;  // bit a set: the node does not move along axis a by itself

  void lockNodes(const std::vector<LoadingPatch>& patches);
  void unlockNodes(const std::vector<LoadingPatch>& patches);
  void placeDisplacedPatches(const std::vector<LoadingPatch>& patches, LatticeState& state) const;
  void pushForcedPatches(const std::vector<LoadingPatch>& patches, LatticeState& state,
                         SolveReport& report) const;
  bool balancePatch(const LoadingPatch& patch, LatticeState& state, int& moves) const;
  void spreadOutwards(const std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                      LatticeState& state, SolveReport& report);
  bool balanceLayer(std::vector<int>& layer, LatticeState& state, SolveReport& report) const;
  bool balanceNode(int node, LatticeState& state) const;
  bool isDisturbed(const std::vector<int>& layer, const LatticeState& state) const;
  Vec3 freeForce(int node, const LatticeState& state) const;
  Vec3 patchForce(const LoadingPatch& patch, const LatticeState& state) const;
  Vec3 moveTowardsBalance(const Vec3& force, const Vec3& stiffness) const;
  double referenceForce(const std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                        const LatticeState& state) const;
  void describe(const std::vector<LoadingPatch>& patches, const LatticeState& state,
                SolveReport& report) const;
  bool outOfBudget() const;

  const Lattice& lattice_;
  const TissueModel& model_;
  PaperOptions options_;
  LayerWalk walk_;
  std::vector<AxisMask> locked_;  // per node
  std::vector<int> active_;       // free nodes of the raised layers of this solve
  double rounding_force_ = 0.0;   // N; smaller forces are rounding errors
  double balanced_below_ = 0.0;   // N
  double reference_force_ = 0.0;  // N
  SolveClock clock_;
};

}  // namespace robot_tissue
