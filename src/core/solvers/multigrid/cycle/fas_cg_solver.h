// How method `layered` comes to balance, in the precision of Real. See
// core/solvers/multigrid/cycle/multigrid_solver.h.
#pragma once

#include <memory>
#include <vector>

#include "solvers/multigrid/cycle/multigrid_solver.h"
#include "solvers/multigrid/hierarchy/grid_hierarchy.h"

namespace robot_tissue {

template <typename Real>
class FasCgSolver : public MultigridSolver {
 public:
  FasCgSolver(const Lattice& lattice, const ElasticModel& model, const LayeredOptions& options)
      : lattice_(lattice), model_(model), options_(options) {
    if (options.threads > 1) workers_ = std::make_unique<Workers>(options.threads);
  }

  SolveReport run(ConstrainedState& shape, const DofConstraints& hold,
                  const std::vector<int>& disturbed, const Budget& budget) override;
  void limitWays(std::vector<NodeLimit> limits) override { limits_ = std::move(limits); }
  void beginStep() override { first_of_step_ = true; }
  Vec3 forceLeft() override;
  const GridBox* visited() const override {
    return levels_ == nullptr || levels_->isWhole() ? nullptr : &levels_->free();
  }
  void forget() override;

 private:
  static constexpr double kStill = 1e-6;  // of the spacing: off rest by less, a node is at rest

  static constexpr double kMostMissed = 0.7;  // of the tolerance, by coarse lattices alone

  // Positions, or forces that do work in a motion, of the finest lattice's open part, and
  // beyond.
  struct Vector {
    Field<Real> nodes;
    std::vector<GroupVector> groups;
    typename GridHierarchy<Real>::Beyond beyond;
  };

  // fas_cg_solver.cpp: before and after.
  void findLevels(const LatticeState& state);
  void open(const ConstrainedState& shape, const DofConstraints& hold, const GridBox& box);
  void prepare(const ConstrainedState& shape, const DofConstraints& hold);
  SolveStatus solve(ConstrainedState& shape, const DofConstraints& hold, bool changed,
                    const Budget& budget);
  void noteStep();
  bool settlePatches(ConstrainedState& shape, const DofConstraints& hold);
  SolveReport giveUp(const ConstrainedState& shape, const DofConstraints& hold);
  void answer(const ConstrainedState& shape, const DofConstraints& hold, SolveReport& report);
  double answerPatches(const ConstrainedState& shape, const DofConstraints& hold,
                       SolveReport& report) const;

  // fas_layers.cpp: which nodes are visited.
  void findSeeds(const ConstrainedState& shape, const DofConstraints& hold,
                 const std::vector<int>& disturbed);
  double firstLayers() const;
  void addSeed(int node);
  GridBox aroundSeeds() const;
  bool raiseLayers();
  int openNodes(const DofConstraints& hold) const;
  int layersRaised() const;

  // fas_error.cpp: how far it is.
  void findLeastFactor(const LatticeState& state);
  SolveStatus checkConvergence(bool changed);
  void updateErrorFactor(double trend_before);
  double allowed() const;
  double unbalanced() const;
  bool isAtRest() const;
  Vec3 netForce() const;
  Vec3 patchForce() const;
  bool isCalm() const;
  bool isBalanced() const;
  double correctionNorm() const;
  bool wentTooFar() const;

  // fas_cycle.cpp: how it goes on.
  SolveStatus iterate(bool changed, bool warm_started, const Budget& budget);
  bool warmStart();
  bool isStepGood(double local);
  void cgCycle();
  void goPlainly(const Vector& from);
  void endLate();
  void finish();
  void settleForces();
  bool lineSearch(const Vector& step, double slope, double slope_here);

  int steps() const;
  GridLevel<Real>& finest() { return levels_->finest(); }
  const GridLevel<Real>& finest() const { return levels_->finest(); }
  void keepPlace(Vector& vector) const;
  void keepForce(Vector& vector);
  void move(const Vector& step, double alpha);
  void putBack(const Vector& vector);
  double workOf(const Vector& motion);
  double nearWorkOf(const Vector& motion) const;
  double work(const Vector& force, const Vector& motion) const;
  void add(const Vector& other, double alpha, Vector& to) const;
  double squared(const Field<Real>& field) const;
  double distanceFrom(const Vector& vector) const;
  double longestSmooth() const;
  bool isSteady() const;

  const Lattice& lattice_;
  const ElasticModel& model_;
  LayeredOptions options_;
  std::unique_ptr<Workers> workers_;
  std::unique_ptr<GridHierarchy<Real>> levels_;
  std::shared_ptr<const CellSet> cells_;
  std::vector<int> loaded_;  // nodes in patches and contacts
  double free_nodes_ = 0.0;
  GridBox seeds_;                  // what the layers grow around
  double layers_ = firstLayers();  // around them
  std::vector<NodeLimit> limits_;
  std::vector<Vec3> limited_from_;  // where these nodes were when the solve began (m)
  int steps_ = 3;                   // of the smoother in a cycle without contacts
  double least_factor_ = 1.0;
  double factor_ = 1.0;  // of the length left: what cycles showed to be left

  // Of the solve under way; lengths in spacings.
  bool in_contact_ = false;
  int cycles_ = 0;
  double left_ = 0.0, left_before_ = 0.0, first_left_ = 0.0;
  double trend_ = 0.0;                      // of the length left
  double error_ = 0.0, error_after_ = 0.0;  // estimates: now, after one more cycle
  double least_ = 0.0, best_error_ = 1.0;
  int last_gain_ = 0;      // cycle that led to less left, or farther
  double farthest_ = 0.0;  // from start_
  double greatest_ = 0.0;  // unbalanced force at its start
  double held_ = 0.0;      // greatest force of a patch on a node, after the last solve
  int mark_cycle_ = 0;     // of mark_
  double mark_left_ = 0.0;
  Vector start_, before_, best_, mark_;
  Vector force_before_, cg_step_, search_direction_, earlier_force_;
  double previous_slope_ = 0.0;  // work of earlier_force_ in the cycle's own motion
  bool fresh_ = true;            // no direction yet
  bool conjugate_ = false;       // the last cycle went on with the one before

  double missed_ = 0.0;  // by coarse lattices alone, of the displacement; last solve

  Vector step_start_, last_step_;
  bool has_start_ = false, has_step_ = false, first_of_step_ = false;
  bool ended_late_ = false;  // the solve before
};

extern template class FasCgSolver<float>;
extern template class FasCgSolver<double>;

}  // namespace robot_tissue
