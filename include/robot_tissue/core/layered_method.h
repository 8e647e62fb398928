// The paper's layers and patches, iterated to the equilibrium (own; doc/model.md).
//
// One cycle: a sweep outwards from the patches, layer after layer, each node moved to where its
// forces balance (one Newton step in its 3x3 block); a smooth motion of all layers from a lattice
// of twice the spacing (CoarseLattice); the same sweep inwards. Cycles are strung together by
// conjugate gradients. Layers are raised as far as the smooth motion is more than a share of the
// tolerance; the others are not visited.
//
// error_estimate: length (L2) of the motion that the coarse lattice and each node's stiffness say
// is left, over that of the free nodes' displacement.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "robot_tissue/core/cell_layers.h"
#include "robot_tissue/core/coarse_lattice.h"
#include "robot_tissue/core/energy_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/patch_motion.h"
#include "robot_tissue/core/solver_method.h"

namespace robot_tissue {

struct LayeredOptions {
  double tolerance = 0.01;  // of error_estimate
  double max_ms = 0.0;      // 0 = no budget; the cycle under way is finished, at least one is made
  int max_cycles = 300;
  int slow = 12;             // cycles after which the coarse lattice is fitted to the shape
  int patience = 40;         // cycles without a better shape
  double patch_step = 0.5;   // longest motion of a patch in one solve, in spacings
  double node_step = 0.5;    // of a node in one visit, likewise
  double line_step = 2.0;    // of a node in one cycle, likewise
  double layer_share = 0.1;  // of the tolerance: motion below which no further layer is raised
};

class LayeredMethod : public SolverMethod {
 public:
  LayeredMethod(const Lattice& lattice, const EnergyModel& model, const LayeredOptions& options);

  SolveReport solve(std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                    LatticeState& state) override;
  void beginStep(const LatticeState& state) override;
  void forget() override;
  bool findsEquilibrium() const override { return true; }
  double patchStep() const override;

 private:
  // Before a cycle: the shape, and lengthLeft (m).
  struct Past {
    std::vector<Vec3> displacement;
    double left = 0.0;
  };

  // Which way the last cycle went, for the next one.
  struct Search {
    Motion direction;
    Motion force;           // before the cycle
    double promised = 0.0;  // work of that force in the cycle's own motion (J)
    bool fresh = true;
    int plain = 0;  // cycles to come that only sweep
  };

  // A solve on its way.
  struct Course {
    Motion forces;  // unbalanced
    Search search;
    std::vector<Past> past;  // the last cycles, oldest first
    int cycles = 0;
    double error = 0.0;   // error_estimate
    double first = -1.0;  // lengthLeft when it began (m)
    bool blown_up = false;
    LoadedShape best;
    double least = std::numeric_limits<double>::infinity();  // lengthLeft of the best (m)
    double best_error = 1.0;
    int best_cycle = 0;
  };

  void findDisturbed(const LoadedShape& shape, const std::vector<int>& disturbed);
  void layOut(const LoadedShape& shape);
  bool raiseLayers(const Motion& smooth, double length);

  Motion forcesOf(const LoadedShape& shape) const;
  Motion smoothMotion(const Motion& forces, const LoadedShape& shape) const;
  double localLength(const Motion& forces) const;
  double lengthLeft(const Motion& forces, const Motion& smooth) const;
  void calibrate(const std::vector<Past>& past, const LoadedShape& shape, double left);
  double distance(const LoadedShape& shape, const std::vector<Vec3>& from) const;
  double relative(double left, const LoadedShape& shape) const;

  SolveStatus iterate(LoadedShape& shape, SolveReport& report);
  SolveStatus look(const LoadedShape& shape, Course& course);
  bool carryOn(LoadedShape& shape, Motion& forces) const;
  bool advance(LoadedShape& shape, Motion& forces, Search& search) const;
  bool goAlong(const Motion& direction, double slope, LoadedShape& shape, Motion& forces) const;
  Motion cycle(const LoadedShape& shape) const;
  void sweep(LoadedShape& shape, bool outwards, Motion& moved) const;
  void balanceNode(LoadedShape& shape, int node) const;
  void balancePatches(LoadedShape& shape, Motion& moved) const;
  void measurePatches(const LoadedShape& shape);
  void move(LoadedShape& shape, const Motion& motion, double share) const;
  double dot(const Motion& left, const Motion& right) const;
  void add(const Motion& step, double share, Motion& direction) const;
  double greatest(const Motion& forces) const;
  double displacementLength(const LoadedShape& shape) const;
  double longest(const Motion& motion) const;
  LatticeState balancedAhead(const LoadedShape& shape, const Motion& forces) const;
  void describe(const LoadedShape& shape, const Motion& forces, SolveReport& report);
  double elapsedMs() const;
  bool outOfBudget() const;

  const Lattice& lattice_;
  const EnergyModel& model_;
  LayeredOptions options_;
  PatchHold hold_;
  CoarseLattice coarse_;
  CellLayers layers_;
  std::vector<double> stiffness_;         // per node, at rest (N/m)
  std::vector<Eigen::MatrixXd> answers_;  // per patch by force: its stiffness, nodes held
  double factor_ = 1.0;                   // of lengthLeft: what cycles showed to be left
  double greatest_ = 0.0;                 // unbalanced node force at the start (N)
  std::vector<int> pending_;              // nodes that may be out of balance, ascending
  std::vector<int> patch_nodes_;          // of the last solve: hard or in a rim
  std::vector<Past> past_;                // of the last solve, if it ran out of time
  bool goes_on_ = false;                  // the solve under way is where that one stopped
  std::vector<Vec3> step_start_;          // displacement when the load step began (m)
  std::vector<Vec3> last_way_;            // of all nodes in the last load step (m)
  bool first_of_step_ = false;            // the next solve is
  std::vector<Vec3> left_;                // displacement that the last solve left
  std::shared_ptr<const CellSet> left_cells_;
  std::chrono::steady_clock::time_point started_;
};

}  // namespace robot_tissue
