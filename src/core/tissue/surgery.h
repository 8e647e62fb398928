// What changes the tissue's topology: cuts, removals, tears, and pieces that go as nothing holds
// them any more; each with the balance after it. Points in m, in the tissue's frame.
//
// Whatever severs or removes does so while a TopologyChange lives, and ends with changeTopology, so
// that surface, pieces, loads and threads are those of the cells that are left.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "robot_tissue/core/removed_space.h"
#include "tissue/load_step_solver.h"

namespace robot_tissue {

class BladeSurface;
struct Crossing;

class Surgery {
 public:
  Surgery(const TissueConfig& tissue, TissueData& data, LoadStepSolver& solver);

  // As of Tissue.
  CutReport cut(const std::vector<Vec3>& corners);
  CutReport cutAlong(const std::vector<CutTriangle>& swept, Stroke stroke);
  RemoveReport remove(const RemovedSpace& space);
  RemoveReport drill(const CoveredSpace& space, Stroke stroke);
  SolveReport tear();
  bool isOverstretched() const;  // Tissue::isOverstretched
  bool tearOut(const std::vector<int>& nodes);
  bool mayTear() const { return !tear_strains_.empty() || data_.pieces.dropsFree(); }
  int springsTorn() const { return springs_torn_; }
  void setSpringsTorn(int springs) { springs_torn_ = springs; }

  // Other cells and springs are there: makes the surface anew and balances what they leave.
  SolveReport changeTopology(const std::vector<int>& disturbed);

 private:
  bool mayReach(const Box& bounds) const;
  SolveReport severAndBalance(const std::vector<Crossing>& crossings,
                              const BladeSurface* blade = nullptr);
  SolveReport goNearer(std::vector<SpringAhead> ahead);
  bool hasTimeForLevels(double before_ms) const;
  SolveReport leaveToNextCall(const std::vector<int>& disturbed);
  // removals.cpp
  RemoveReport takeAway(const std::vector<std::uint8_t>& within, Stroke stroke);
  std::vector<std::string> dropLostLoads();
  void centerAnew(LoadingPatch& patch) const;
  void takeOut(const std::vector<int>& pieces);
  void dropFreed(const std::vector<int>& touched);
  void dropLetGo();

  TissueData& data_;
  LoadStepSolver& solver_;
  std::vector<double> tear_strains_;  // per spring (tearStrains); empty: none tears
  int springs_torn_ = 0;              // since rest, or the state that was loaded
};

}  // namespace robot_tissue
