// One load step: solves, each with a look at the contacts of the shape that it came to, until these
// are those that it was solved for, and threads that break.
//
// A solve ends in balance (kOk), without the time for it (kLate), or with a shape that is none to
// show (kUnconverged). Whatever comes of it, the numbers of shape and report are finite.
#pragma once

#include <utility>
#include <vector>

#include "tissue/tissue_data.h"

namespace robot_tissue {

class LoadStepSolver {
 public:
  explicit LoadStepSolver(TissueData& data) : data_(data) {}

  void setContactUpdate(ContactUpdate* update) { contact_update_ = update; }  // null: nobody
  void expectTouch();
  // Balances what the patches are now. `disturbed`: nodes whose balance something else changed,
  // besides those that the last solve left.
  SolveReport solve(const std::vector<int>& disturbed);
  // The surface is another one: touches are found anew where it is now.
  void renewContacts();
  // The surface is made that of the shape, and inverted cells are told of.
  void describeShape(SolveReport& report);
  bool mayShowUnsettled() const;  // Tissue::mayShowUnsettled
  void noteUnsettled();

  // While there, solves look at no contacts.
  class NoContacts {
   public:
    explicit NoContacts(LoadStepSolver& solver)
        : solver_(solver), update_(std::exchange(solver.contact_update_, nullptr)) {}
    ~NoContacts() { solver_.contact_update_ = update_; }
    NoContacts(const NoContacts&) = delete;
    NoContacts& operator=(const NoContacts&) = delete;

   private:
    LoadStepSolver& solver_;
    ContactUpdate* update_;
  };

 private:
  struct Rounds;      // of a solve and the look at the contacts after it
  struct RoundShape;  // the shape that a round came to
  enum class RoundDecision { kDone, kSolveAgain };

  SolveReport solveAndBreak(const std::vector<int>& disturbed);
  SolveReport solveOnce(const std::vector<int>& disturbed);
  SolveReport solveWithThreads(const std::vector<int>& disturbed, LatticeState& state);
  double costOfIteration() const;
  void noteWork(const SolveReport& report, double cost);
  // contact_rounds.cpp
  SolveReport solveInRounds(const std::vector<int>& disturbed);
  RoundDecision endRound(Rounds& rounds);
  RoundShape takeShape(Rounds& rounds, bool late);
  void tellWhatIsOpen(Rounds& rounds, const RoundShape& shape, bool renewed);
  void worsen(Rounds& rounds, SolveStatus status);
  void limitWays();
  bool goBack(const Rounds& rounds);

  TissueData& data_;
  ContactUpdate* contact_update_ = nullptr;
};

}  // namespace robot_tissue
