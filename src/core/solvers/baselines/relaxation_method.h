// What methods `vbd`, `xpbd` and `explicit` have in common (own; doc/baselines.md): the elastic
// energy is brought to its minimum by many cheap iterations over all nodes, in single precision.
//
// error_estimate: how far the shape still goes, over the L2 of the free nodes' displacement. The
// way of the last iterations, and the share by which such ways became shorter, taken as a geometric
// series.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "loads/dof_constraints.h"
#include "material/elastic_model.h"
#include "robot_tissue/core/solve_report.h"
#include "solvers/solve_clock.h"
#include "solvers/solver_method.h"

namespace robot_tissue {

class SoaField;

struct RelaxationOptions {
  double tolerance = 0.01;  // of error_estimate
  double max_ms = 0.0;      // 0 = no budget; the iteration under way is finished, one is made
  int max_iterations = 20000;
  double patch_step = 0.5;  // longest motion of a patch in one solve, in spacings
};

class RelaxationMethod : public SolverMethod {
 public:
  // How a time step is solved: as the least energy of its end, or in shorter steps of its own.
  enum class TimeSteps { kSolved, kGoneThrough };

  RelaxationMethod(const Lattice& lattice, const ElasticModel& model,
                   const RelaxationOptions& options, TimeSteps time_steps = TimeSteps::kSolved);
  ~RelaxationMethod() override;

  SolveReport solve(std::vector<LoadingPatch>& patches, const std::vector<int>& disturbed,
                    LatticeState& state) final;
  void forget() override;
  bool remembers() const override { return true; }
  bool findsEquilibrium() const override { return true; }
  bool goesThroughTimeSteps() const override { return time_steps_ == TimeSteps::kGoneThrough; }
  void limitTime(double ms) override { options_.max_ms = ms; }
  void limitIterations(int most) override { most_iterations_ = most; }
  double patchStep() const override;

 protected:
  // Called at the start of a solve with care 0; and when forces grew or stopped falling, from the
  // best shape so far, with 1, 2 ...: each is to take smaller or safer steps.
  virtual void begin(int care) = 0;
  virtual void iterate() = 0;
  // For methods whose iterations end off the equilibrium. In: how far the shape still goes (m);
  // out: that and how far from the equilibrium it ends. Whether that is near enough. May change the
  // steps.
  virtual bool settles(double& /*to_go*/) { return true; }
  // Whether the iterations go to where all forces balance: then forces that stop falling mean that
  // something is wrong.
  virtual bool balances() const { return true; }
  // Iterations from one look at the way gone to the next.
  virtual int stride() const = 0;
  // Share of an error that an iteration leaves in the end.
  virtual double shrinkage() const = 0;

  // kGoneThrough: from the shape at the step's start to that at its end; how many steps were made.
  virtual SolveStatus goThrough(int& /*steps*/) { return SolveStatus::kUnconverged; }
  bool isLate() const { return clock_.isOver(options_.max_ms); }
  int mostIterations() const { return std::min(options_.max_iterations, most_iterations_); }

  // Cells from what holds the tissue to what is farthest from it; in a time step, as far as it
  // is felt within it.
  double depth() const { return depth_ * std::sqrt(shear_wave_ / wave_); }
  double poissonRatio() const { return robot_tissue::poissonRatio(mean_); }
  // Stiffness against the slowest motion, over that of nodes alone: of a shear wave of four times
  // the depth, or what the solve has shown, if that is less.
  double slowestWave() const { return std::min(wave_, seen_wave_); }

  // Of the free nodes' displacement, L2 (m).
  double movedLength() const;

  // Forces of the field, contacts included, and on patches by force.
  void findForces();
  // Newton's step of a patch by force, the nodes around it held; forces as found last.
  Motion::OfPatch patchAnswer(std::size_t patch) const;
  void movePatchBy(std::size_t patch, const Motion::OfPatch& motion);

  const Lattice& lattice_;
  const ElasticModel& model_;
  RelaxationOptions options_;
  DofConstraints hold_;
  std::unique_ptr<SoaField> field_;
  ConstrainedState shape_;  // displacements: of watched nodes alone, until the end
  std::vector<Motion::OfPatch> patch_forces_;

 private:
  struct Course;
  enum class WaveLook { kFirst, kAgain };  // of a solve: the first one has none to compare with

  SolveStatus run(Course& course);
  bool look(Course& course);
  double lengthToGo(const std::vector<double>& ways) const;
  void findDepth();
  std::vector<int> heldNodes() const;
  void findWave();
  double wayByForces() const;
  void lookAtWave(WaveLook look);
  double wayFromMark();
  double correctionNorm() const;
  double relative(double length) const;
  bool isRounding(double length) const;
  void keep(Course& course) const;
  void goBack(const Course& course);
  void measurePatches();
  void describe(const Course& course, SolveReport& report);

  int most_iterations_ = std::numeric_limits<int>::max();
  std::vector<Eigen::MatrixXd> answers_;  // per patch by force: its stiffness, nodes held
  std::vector<Vec3> scratch_;             // forces (N)
  std::vector<Vec3> left_;                // displacement that the last solve left (m)
  Moduli mean_;
  double soft_shear_ = 0.0;  // harmonic mean (Pa)
  double depth_ = 1.0;
  double shear_wave_ = 1.0;
  double wave_ = 1.0;          // with the inertia of a time step
  double mean_density_ = 0.0;  // kg/m^3
  TimeSteps time_steps_;
  double seen_wave_ = 1.0;
  std::shared_ptr<const CellSet> depth_of_;
  std::vector<int> depth_from_;  // nodes
  double left_length_ = 0.0;     // its correctionNorm (m)
  double left_error_ = 1.0;
  SolveClock clock_;
};

}  // namespace robot_tissue
