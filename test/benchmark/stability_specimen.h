// A block of tissue under a method that works alone: without Tissue, which keeps the last good
// shape and starts from rest when the last load is gone.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/lattice.h"
#include "tissue/registry.h"

namespace robot_tissue {

// Of everything that was solved for.
struct Course {
  bool finite = true;
  SolveStatus worst = SolveStatus::kOk;
  int solves = 0;
  int unconverged = 0;  // of them
  int iterations = 0;
  double error_estimate = 0.0;  // greatest
  double residual = 0.0;        // greatest
  double ms = 0.0;              // of the methods' own clocks
};

class Specimen {
 public:
  Specimen(TissueConfig tissue, const SolverConfig& solver);

  // Its nodes stay with the tissue until it is moved. With springs at its rim where it has one.
  void addPatch(const Box& box);
  // All nodes of the patch, from rest (m).
  void move(std::size_t patch, const Vec3& displacement);
  // Turned about its center (rotation vector, rad), then moved; its rim has no springs then.
  void turn(std::size_t patch, const Vec3& turn, const Vec3& displacement = Vec3::Zero());
  void cut(const std::vector<Vec3>& corners);
  void setGravity(const Vec3& gravity);  // m/s^2
  void solve();
  // Without patches and gravity, from the shape as it is: how it came there is forgotten.
  void release();
  // From the rest shape, as Tissue does when its last load is gone.
  void releaseFromRest();

  const Lattice& lattice() const { return *lattice_; }
  const LatticeState& state() const { return state_; }
  const Course& course() const { return course_; }
  int invertedCells() const { return countInvertedCells(*lattice_, state_); }
  double force(std::size_t patch) const;   // N
  double torque(std::size_t patch) const;  // about the patch's center at rest (N m)
  // Farthest that a node is from rest (m). Of a piece that nothing fixed holds: what is left of its
  // deformation, root mean square, over the tolerance of the way it went.
  double distanceFromRest() const;

 private:
  void makeMethod();
  Vec3 centerOf(std::size_t patch) const;
  std::vector<std::vector<int>> pieces() const;
  double farthestOf(const std::vector<int>& piece) const;
  double deformationOf(const std::vector<int>& piece) const;

  TissueConfig tissue_;
  SolverConfig solver_;
  std::unique_ptr<Lattice> lattice_;
  LatticeState state_;
  std::unique_ptr<TissueModel> model_;
  std::unique_ptr<SolverMethod> method_;
  std::vector<Box> boxes_;
  std::vector<LoadingPatch> patches_;
  std::vector<PatchAnswer> answers_;
  bool is_disturbed_ = false;  // by something else than patches, since it was solved for
  Course course_;
};

}  // namespace robot_tissue
