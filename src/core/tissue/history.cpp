#include "tissue/history.h"

#include <algorithm>
#include <climits>
#include <utility>

#include "saving/saved_loads.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

// Of what was asked for: where a load by force has come to is the shape's.
std::uint64_t hashOfLoads(std::vector<LoadingPatch> loads) {
  for (LoadingPatch& load : loads) load.place = PatchPlace();
  ByteWriter out;
  putLoads(loads, out);
  return hashOf(out.bytes());
}

std::size_t bytesOf(const std::shared_ptr<const SavedState>& state) {
  if (!state) return 0;
  const LatticeState& lattice = state->lattice;
  return lattice.displacement.size() * sizeof(Vec3) + lattice.severed.size() +
         lattice.parted_at.size() * sizeof(double) + lattice.taken.size() +
         lattice.left.size() * sizeof(double) +
         lattice.cells->all().size() * (sizeof(Cell) + kCorners * sizeof(CellSet::Meeting));
}

}  // namespace

History::History() : History(tuning::kMostHistoryBytes, tuning::kMostTopologyBytes) {}

bool History::begins(Kind kind, const std::vector<LoadingPatch>& named_loads) {
  const bool tears_on =
      kind == Kind::kTear && tears_go_on_ && !changes_.empty() && changes_.back().kind == kind;
  const bool goes_on = !changes_.empty() && (kind == Kind::kStrokeGoesOn || tears_on);
  tears_go_on_ = kind == Kind::kTear;
  if (!goes_on) return true;
  is_under_way_ = true;
  Change& last = changes_.back();
  // The shape of before is one of other loads: what is taken back are not these.
  if (last.loads_after != hashOfLoads(named_loads)) last.entry.state.reset();
  return false;
}

void History::begin(Kind kind, Entry before, const std::vector<LoadingPatch>& named_loads) {
  is_under_way_ = true;
  Change change;
  change.kind = kind;
  change.entry = std::move(before);
  change.loads_before = hashOfLoads(named_loads);
  changes_.push_back(std::move(change));
  forgetOldShapes();
  while (changes_.size() > 2 && bytesOfTopologies() > most_of_topologies_) joinOldest();
}

// The way back to the beginning is the one that matters most; of the others the last.
void History::forgetOldShapes() {
  std::size_t bytes = 0;
  for (const Change& each : changes_) bytes += bytesOf(each.entry.state);
  for (std::size_t i = 1; i + 1 < changes_.size() && bytes > most_of_shapes_; ++i) {
    bytes -= bytesOf(changes_[i].entry.state);
    changes_[i].entry.state.reset();
  }
}

// The two oldest are one from here on, to be taken back together.
void History::joinOldest() {
  Change& first = changes_.front();
  if (first.loads_after != changes_[1].loads_before) first.entry.state.reset();
  first.loads_after = changes_[1].loads_after;
  changes_.erase(changes_.begin() + 1);
}

// Numbers of pieces are shared by changes that leave them as they are.
std::size_t History::bytesOfTopologies() const {
  std::size_t bytes = 0;
  const PieceNumbers* counted = nullptr;
  for (const Change& change : changes_) {
    const Entry& entry = change.entry;
    bytes += entry.severed.size() / CHAR_BIT + entry.parted_at.size() * sizeof(double) +
             entry.ahead.size() * sizeof(SpringAhead) + entry.taken.size() +
             entry.sutures.size() * sizeof(SutureThread);
    if (entry.pieces && entry.pieces.get() != counted) bytes += entry.pieces->bytes();
    counted = entry.pieces.get();
  }
  return bytes;
}

void History::end(const std::vector<LoadingPatch>& named_loads) {
  is_under_way_ = false;
  changes_.back().loads_after = hashOfLoads(named_loads);
}

const Box* History::boxOf(const std::string& load) const {
  const auto found = boxes_.find(load);
  return found == boxes_.end() ? nullptr : &found->second;
}

void History::clear() {
  changes_.clear();
  boxes_.clear();
  tears_go_on_ = false;
}

void History::dropFrom(std::size_t change) {
  changes_.resize(change);
  tears_go_on_ = false;
}

void History::forgetStates() {
  for (Change& change : changes_) change.entry.state.reset();
}

bool History::hasLoadsSince(std::size_t change,
                            const std::vector<LoadingPatch>& named_loads) const {
  for (std::size_t i = change; i + 1 < changes_.size(); ++i) {
    if (changes_[i].loads_after != changes_[i + 1].loads_before) return false;
  }
  return changes_.back().loads_after == hashOfLoads(named_loads);
}

}  // namespace robot_tissue
