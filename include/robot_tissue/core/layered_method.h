// The paper's layers and patches, iterated to the equilibrium (own; doc/model.md): smooth motions
// from coarser lattices, rough ones from a smoother on the tissue's own (LayeredCourse).
//
// error_estimate: length (L2) of the motion that the coarse lattices and each node's stiffness say
// is left, over that of the free nodes' displacement.
#pragma once

#include <memory>
#include <vector>

#include "robot_tissue/core/layered_course.h"
#include "robot_tissue/core/patch_motion.h"
#include "robot_tissue/core/solver_method.h"

namespace robot_tissue {

class LayeredMethod : public SolverMethod {
 public:
  LayeredMethod(const Lattice& lattice, const ElasticModel& model, const LayeredOptions& options);

  SolveReport solve(std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                    LatticeState& state) override;
  void beginStep(const LatticeState&) override { course_->beginStep(); }
  void limitWays(std::vector<double> longest) override;
  void forget() override { course_->forget(); }
  bool remembers() const override { return true; }
  const GridBox* visited() const override { return course_->visited(); }
  Vec3 forceLeft() override { return course_->forceLeft(); }
  bool staysFinite() const override { return true; }
  bool findsEquilibrium() const override { return true; }
  void limitTime(double ms) override { options_.max_ms = ms; }
  double patchStep() const override;

 private:
  const Lattice& lattice_;
  LayeredOptions options_;
  PatchHold hold_;
  std::unique_ptr<LayeredCourse> course_;
};

}  // namespace robot_tissue
