// What cuts and removals can be taken back to (own).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lattice/piece_numbers.h"
#include "loads/suture_thread.h"
#include "robot_tissue/core/loading_patch.h"
#include "saving/saved_state.h"

namespace robot_tissue {

class History {
 public:
  // The tissue before a change of its topology.
  struct Entry {
    std::vector<bool> severed;        // per spring
    std::vector<double> parted_at;    // as LatticeState's, of the springs that are severed
    std::vector<SpringAhead> ahead;   // likewise
    std::vector<std::uint8_t> taken;  // as LatticeState's
    std::vector<SutureThread> sutures;
    std::shared_ptr<const PieceNumbers> pieces;
    std::shared_ptr<const SavedState> state;  // null: to find it anew is all that is left
  };

  // Changes of these kinds that follow each other are one: a blade's stroke goes on, and tissue
  // goes on to tear under the loads that tore it, or that are on their way.
  enum class Kind { kByItself, kStrokeGoesOn, kTear };

  // Bytes of shapes, and of topologies, that are kept (tuning.h).
  History();
  History(std::size_t most_of_shapes, std::size_t most_of_topologies)
      : most_of_shapes_(most_of_shapes), most_of_topologies_(most_of_topologies) {}

  // False: it goes on with the last one.
  bool begins(Kind kind, const std::vector<LoadingPatch>& named_loads);
  // Loads are to be others from here on: what tears then is a change of its own.
  void noteOtherLoads() { tears_go_on_ = false; }
  // The closed box of rest positions (m) that the named load was last put on by: what it holds
  // where tissue is taken back. Null: the load came with a saved state.
  void noteBox(const std::string& load, const Box& box) { boxes_[load] = box; }
  const Box* boxOf(const std::string& load) const;
  // Before the change, and after it.
  void begin(Kind kind, Entry before, const std::vector<LoadingPatch>& named_loads);
  bool isUnderWay() const { return is_under_way_; }
  void end(const std::vector<LoadingPatch>& named_loads);
  void clear();
  // Shapes of before are to be found anew, as the material is another one.
  void forgetStates();

  std::size_t size() const { return changes_.size(); }
  const Entry& before(std::size_t change) const { return changes_[change].entry; }
  // The named loads are those of before that change, as changed by it and those after it alone.
  bool hasLoadsSince(std::size_t change, const std::vector<LoadingPatch>& named_loads) const;
  void dropFrom(std::size_t change);

 private:
  struct Change {
    Entry entry;
    Kind kind = Kind::kByItself;
    std::uint64_t loads_before = 0, loads_after = 0;  // hashes
  };

  void forgetOldShapes();
  void joinOldest();
  std::size_t bytesOfTopologies() const;

  std::size_t most_of_shapes_, most_of_topologies_;
  std::vector<Change> changes_;
  std::map<std::string, Box> boxes_;  // by the name of the load
  bool is_under_way_ = false;
  bool tears_go_on_ = false;  // the next tear is one with the last change, if that is a tear
};

}  // namespace robot_tissue
