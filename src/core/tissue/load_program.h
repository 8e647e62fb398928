// What acts on the tissue, one after the other: named loads that come and go, the tools' patches,
// and the way from rest to the loads that stand. Lengths in m, forces in N, in the tissue's frame.
#pragma once

#include <string>
#include <vector>

#include "tissue/load_stepping.h"
#include "tissue/suturing.h"
#include "tissue/tissue_forces.h"

namespace robot_tissue {

class LoadProgram {
 public:
  LoadProgram(TissueData& data, const TissueForces& forces, LoadStepSolver& solver,
              Surgery& surgery, Suturing& suturing)
      : data_(data),
        forces_(forces),
        solver_(solver),
        surgery_(surgery),
        suturing_(suturing),
        stepping_(data, solver, surgery) {}

  // As of Tissue.
  void load(const LoadStep& step, const Tissue::OnIncrement& on_increment, int most_increments);
  void loadOn(const Tissue::OnIncrement& on_increment);
  SolveReport release(const std::vector<std::string>& names);
  SolveReport follow(std::vector<LoadingPatch> tool_patches, const std::vector<int>& disturbed,
                     Bedding bedding);
  SolveReport settle();
  // Cells are there again: the loads' springs are those of loads that are put on now.
  void joinAnew();

 private:
  SolveReport comeBackFromTools();
  SolveReport solveFromRest();
  void relax(const std::vector<int>& but_for);
  SolveReport settleFromRest();
  SolveReport endComingBack(SolveReport report);
  LoadingPatch makePatch(const PatchConfig& config) const;
  std::vector<int> nodesLeftIn(const Box& box) const;
  std::vector<RimSpring> springsAround(const Box& box, const std::vector<int>& nodes) const;
  void joinAnew(const Box& box, LoadingPatch& patch) const;
  std::vector<LoadRamp> rampsTo(const std::vector<LoadingPatch>& targets) const;
  bool comesToBalanceBefore(const std::vector<LoadingPatch>& targets);
  void placeStarts(std::vector<LoadRamp>& ramps);
  void layNewNodes(const LoadingPatch& standing, LoadingPatch& start) const;
  LoadRamp makeRamp(const LoadingPatch& target, const LoadingPatch* standing) const;
  Vec3 patchForce(const LoadingPatch& patch) const;

  TissueData& data_;
  const TissueForces& forces_;
  LoadStepSolver& solver_;
  Surgery& surgery_;
  Suturing& suturing_;
  LoadStepping stepping_;
};

}  // namespace robot_tissue
