// How method `layered` comes to balance, in the precision of Real. See core/layered_course.h.
#pragma once

#include <memory>
#include <vector>

#include "robot_tissue/core/lattice_levels.h"
#include "robot_tissue/core/layered_course.h"

namespace robot_tissue {

template <typename Real>
class CourseIn : public LayeredCourse {
 public:
  CourseIn(const Lattice& lattice, const ElasticModel& model, const LayeredOptions& options)
      : lattice_(lattice), model_(model), options_(options) {
    if (options.threads > 1) workers_ = std::make_unique<Workers>(options.threads);
  }

  SolveReport run(LoadedShape& shape, const PatchHold& hold, const std::vector<int>& disturbed,
                  const Budget& budget) override;
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
    typename LatticeLevels<Real>::Beyond beyond;
  };

  // course_in.cpp: before and after.
  void findLevels(const LatticeState& state);
  void open(const LoadedShape& shape, const PatchHold& hold, const GridBox& box);
  void prepare(const LoadedShape& shape, const PatchHold& hold);
  SolveStatus solve(LoadedShape& shape, const PatchHold& hold, bool changed, const Budget& budget);
  void noteStep();
  bool settlePatches(LoadedShape& shape, const PatchHold& hold);
  SolveReport giveUp(const LoadedShape& shape, const PatchHold& hold);
  void answer(const LoadedShape& shape, const PatchHold& hold, SolveReport& report);
  double answerPatches(const LoadedShape& shape, const PatchHold& hold, SolveReport& report) const;

  // course_layers.cpp: which nodes are visited.
  void findSeeds(const LoadedShape& shape, const PatchHold& hold,
                 const std::vector<int>& disturbed);
  double firstLayers() const;
  void addSeed(int node);
  GridBox aroundSeeds() const;
  bool raiseLayers();
  int openNodes(const PatchHold& hold) const;
  int layersRaised() const;

  // course_error.cpp: how far it is.
  void findLeastFactor(const LatticeState& state);
  SolveStatus look(bool changed);
  void learn(double trend_before);
  double allowed() const;
  double unbalanced() const;
  bool isAtRest() const;
  Vec3 netForce() const;
  Vec3 patchForce() const;
  bool isCalm() const;
  bool isBalanced() const;
  double lengthLeft() const;
  bool wentTooFar() const;

  // course_cycle.cpp: how it goes on.
  SolveStatus iterate(bool changed, bool carried_on, const Budget& budget);
  bool carryOn();
  bool isWayGood(double local);
  void advance();
  void goPlainly(const Vector& from);
  void endLate();
  void finish();
  void settleForces();
  bool searchAlong(const Vector& way, double slope, double slope_here);

  int steps() const;
  LatticeLevel<Real>& finest() { return levels_->finest(); }
  const LatticeLevel<Real>& finest() const { return levels_->finest(); }
  void keepPlace(Vector& vector) const;
  void keepForce(Vector& vector);
  void move(const Vector& way, double share);
  void putBack(const Vector& vector);
  double workOf(const Vector& motion);
  double nearWorkOf(const Vector& motion) const;
  double work(const Vector& force, const Vector& motion) const;
  void add(const Vector& other, double share, Vector& to) const;
  double squared(const Field<Real>& field) const;
  double distanceFrom(const Vector& vector) const;
  double longestSmooth() const;
  bool isSteady() const;

  const Lattice& lattice_;
  const ElasticModel& model_;
  LayeredOptions options_;
  std::unique_ptr<Workers> workers_;
  std::unique_ptr<LatticeLevels<Real>> levels_;
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
  Vector force_before_, way_, direction_, earlier_force_;
  double promised_ = 0.0;   // work of earlier_force_ in the cycle's own motion
  bool fresh_ = true;       // no direction yet
  bool conjugate_ = false;  // the last cycle went on with the one before

  double missed_ = 0.0;  // by coarse lattices alone, of the displacement; last solve

  Vector step_start_, last_way_;
  bool has_start_ = false, has_way_ = false, first_of_step_ = false;
  bool ended_late_ = false;  // the solve before
};

extern template class CourseIn<float>;
extern template class CourseIn<double>;

}  // namespace robot_tissue
