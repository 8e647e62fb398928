// Other states that the tissue goes to as a whole: at rest, one that was saved, one before changes
// of its topology, that of another tissue, and the same of another material. In each all of
// TissueData is of one state.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "saving/saved_state.h"
#include "tissue/load_program.h"
#include "tissue/surgery.h"
#include "tissue/suturing.h"

namespace robot_tissue {

class TissueStates {
 public:
  TissueStates(const TissueConfig& tissue, const SolverConfig& solver, TissueData& data,
               LoadStepSolver& load_step, Surgery& surgery, Suturing& suturing,
               LoadProgram& program);

  // As of Tissue.
  void reset();
  void takeOver(const TissueData& other);
  SolveReport loadState(const SavedState& saved);
  std::string savedState() const;
  std::uint64_t stateHash() const;
  std::shared_ptr<const SavedState> readState(const std::string& bytes) const;
  int undoable() const;
  SolveReport undo(int count);
  bool retune(const TissueConfig& tissue, const SolverConfig& solver);

 private:
  void take(const SavedState& saved);

  TissueData& data_;
  LoadStepSolver& solver_;
  Surgery& surgery_;
  Suturing& suturing_;
  LoadProgram& program_;
  std::uint64_t balance_fingerprint_;  // of what the balance of a shape hangs on in the scene
};

}  // namespace robot_tissue
