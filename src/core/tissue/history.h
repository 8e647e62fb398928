// What cuts and removals can be taken back to (own).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

class History {
 public:
  // The tissue before a change of its topology.
  struct Entry {
    std::vector<bool> severed;        // per spring
    std::vector<std::uint8_t> taken;  // as LatticeState's
    std::string state;                // as saved; empty: to find it anew is all that is left
  };

  // Before the change, and after it.
  void begin(const LatticeState& lattice, std::string state,
             const std::vector<LoadingPatch>& named_loads);
  void end(const std::vector<LoadingPatch>& named_loads);
  void clear();

  std::size_t size() const { return changes_.size(); }
  const Entry& before(std::size_t change) const { return changes_[change].entry; }
  // The named loads are those of before that change, as changed by it and those after it alone.
  bool hasLoadsSince(std::size_t change, const std::vector<LoadingPatch>& named_loads) const;
  void dropFrom(std::size_t change) { changes_.resize(change); }

 private:
  struct Change {
    Entry entry;
    std::uint64_t loads_before = 0, loads_after = 0;  // hashes
  };

  std::vector<Change> changes_;
};

}  // namespace robot_tissue
