// The patches that act on the tissue: named loads, then the tools' patches; and named loads that
// had no time to come to where they go. Lengths in m, forces in N, in the tissue's frame.
//
// The order is that of SolveReport::patches. No two named loads have one name, or one node.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/solve_report.h"

namespace robot_tissue {

// Or at one place: nothing keeps a patch of these nodes from turning.
bool areOnALine(const Lattice& lattice, const std::vector<int>& nodes);
Vec3 restCenter(const Lattice& lattice, const std::vector<int>& nodes);  // their mean (m)
// Where the patch by force stands, told of another center at rest (m).
PatchPlace placeAbout(const Vec3& center, const LoadingPatch& patch);

class StandingLoads {
 public:
  const std::vector<LoadingPatch>& patches() const { return patches_; }
  // For a solve, which moves those by force, and may have others behind them while it lasts.
  std::vector<LoadingPatch>& patches() { return patches_; }
  std::size_t named() const { return named_; }  // how many of them, from the first on
  bool isUntouched() const { return patches_.size() == named_; }
  std::vector<LoadingPatch> namedLoads() const;
  std::optional<std::size_t> numberOf(const std::string& name) const;  // of a named load
  const LoadingPatch* find(const std::string& name) const;             // null: there is none
  // What the named load met, of a report of a solve of these; zero when there is none of that name.
  PatchAnswer answerOf(const std::string& name, const SolveReport& report) const;
  // One of the tools that touch has no patch among these.
  bool isOneLeftBy(const std::vector<LoadingPatch>& of_tools) const;

  // In the place of the named load of that name, or behind all of these. Its number.
  std::size_t place(const LoadingPatch& patch);
  void putToolPatches(std::vector<LoadingPatch> of_tools);  // in the place of the earlier ones
  void remove(std::size_t number);                          // a named load, with what is due of it
  // These alone stand, and go to what is due.
  void take(std::vector<LoadingPatch> named_loads, std::vector<LoadingPatch> due = {});
  void restore(const std::vector<LoadingPatch>& patches, std::size_t named);
  // Puts them before what stands.
  void putBack(const std::vector<LoadingPatch>& before, std::size_t named);
  // Drops nodes that are gone, and named loads that have no other, with their answers. The names of
  // those.
  std::vector<std::string> loseGoneNodes(const LatticeState& state,
                                         std::vector<PatchAnswer>& answers);
  // The springs to nodes that a cut has parted from their patches.
  void loseParted(const CellSet& cells);
  void forEach(const std::function<void(LoadingPatch&)>& change);  // those that are due, too

  // Targets of named loads that had no time to come there.
  bool isLoading() const { return !due_.empty(); }
  // What was due of that name before stays so: the patch was on its way there.
  void makeDue(const LoadingPatch& target);
  void dropDue(const std::string& name);
  const std::vector<LoadingPatch>& due() const { return due_; }
  std::vector<LoadingPatch> takeDue() { return std::exchange(due_, {}); }

  // The shape is on its way from rest to these loads, which stood before: what it bears there it
  // never bore, so nothing breaks or tears of it.
  void beginComingBack() { are_coming_back_ = true; }
  void endComingBack() { are_coming_back_ = false; }
  bool areComingBack() const { return are_coming_back_; }

 private:
  std::vector<LoadingPatch> patches_;
  std::size_t named_ = 0;
  std::vector<LoadingPatch> due_;
  bool are_coming_back_ = false;
};

}  // namespace robot_tissue
