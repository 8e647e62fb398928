// Surgery: tissue that is removed, and pieces that go as nothing holds them any more.
#include <algorithm>
#include <cstdint>

#include "cutting/crumbs.h"
#include "cutting/removal.h"
#include "material/tissue_model.h"
#include "tissue/surgery.h"
#include "tissue/topology_change.h"

namespace robot_tissue {

RemoveReport Surgery::remove(const RemovedSpace& space) {
  const RemoveReport report =
      takeAway(cellsWithin(data_.body.lattice(), data_.body.state(), space), Stroke::kBegins);
  if (report.holds_all) {
    throw InputError("the space holds all of the tissue; allowed: one that leaves some of it");
  }
  return report;
}

RemoveReport Surgery::drill(const CoveredSpace& space, Stroke stroke) {
  const bool reaches = mayReach(space.bounds);
  return takeAway(reaches ? cellsWithin(data_.body.lattice(), data_.body.state(), space)
                          : std::vector<std::uint8_t>(),
                  stroke);
}

RemoveReport Surgery::takeAway(const std::vector<std::uint8_t>& within, Stroke stroke) {
  const Lattice& lattice = data_.body.lattice();
  const LatticeState& state = data_.body.state();
  RemoveReport report;
  report.pieces = state.pieces;
  report.solve = data_.outcome.report;
  if (within.empty()) return report;
  const std::vector<std::uint8_t> cells = withCrumbs(lattice, state, within);
  const bool leaves_some =
      std::any_of(lattice.cells().begin(), lattice.cells().end(), [&](const Cell& cell) {
        return (takenOf(state, cell.place) | cells[at(cell.place)]) < 0xff;
      });
  report.holds_all = !leaves_some;
  if (report.holds_all) return report;
  const TopologyChange change(
      data_, stroke == Stroke::kBegins ? History::Kind::kByItself : History::Kind::kStrokeGoesOn);
  const std::vector<int> touched = data_.pieces.touched();
  removeCells(lattice, cells, data_.body.model().splitCells(), data_.body.change());
  data_.body.weigh();
  report.volume = volumeOf(lattice, state, cells);
  data_.pieces.renumber();
  report.loads = dropLostLoads();
  dropFreed(touched);
  changeTopology(nodesAround(lattice, cells, state));
  report.solve = tear();
  report.pieces = state.pieces;
  return report;
}

// The force acts in the middle of the nodes that are left, which stand where they did.
void Surgery::centerAnew(LoadingPatch& patch) const {
  if (!byForce(patch) || patch.nodes.empty()) return;
  const Vec3 center = restCenter(data_.body.lattice(), patch.nodes);
  patch.place = placeAbout(center, patch);
  patch.center = center;
}

// Names of those of which nothing is left. What is left on a line of nodes goes on without turning.
std::vector<std::string> Surgery::dropLostLoads() {
  std::vector<std::string> lost =
      data_.loads.loseGoneNodes(data_.body.state(), data_.outcome.report.patches);
  data_.loads.forEach([&](LoadingPatch& patch) {
    centerAnew(patch);
    if (patch.turns && areOnALine(data_.body.lattice(), patch.nodes)) patch.turns = false;
  });
  data_.outcome.dropGone(data_.body.state());
  return lost;
}

void Surgery::takeOut(const std::vector<int>& pieces) {
  const Lattice& lattice = data_.body.lattice();
  const LatticeState& state = data_.body.state();
  const std::vector<int>& piece_of = data_.pieces.ofNodes();
  std::vector<std::uint8_t> cells(lattice.cells().size(), 0);
  for (const Cell& cell : lattice.cells()) {
    unsigned bits = 0;
    for (int corner = 0; corner < kCorners; ++corner) {
      const int piece = piece_of[at(cell.nodes[at(corner)])];
      const bool goes = std::binary_search(pieces.begin(), pieces.end(), piece);
      if (goes && !isTaken(state, cell.place, corner)) bits |= 1U << corner;
    }
    cells[at(cell.place)] = static_cast<std::uint8_t>(bits);
  }
  removeCells(lattice, cells, data_.body.model().splitCells(), data_.body.change());
  data_.body.weigh();
  data_.pieces.renumberWithout(pieces);
  dropLostLoads();
}

// Within a change of the topology, before its balance; touched: before that. The surface, and with
// it the ends of threads, may still be that of before.
void Surgery::dropFreed(const std::vector<int>& touched) {
  if (!data_.pieces.dropsFree() || data_.body.state().pieces == 1) return;
  if (data_.threads.anyWhole()) data_.rebuildSurface();
  const std::vector<int> freed = data_.pieces.freed(touched);
  if (!freed.empty()) takeOut(freed);
}

// By tools, loads or threads that hold them no longer.
void Surgery::dropLetGo() {
  if (!data_.pieces.dropsFree() || data_.body.state().pieces == 1) return;
  const std::vector<int> freed = data_.pieces.freed(data_.pieces.touched());
  if (freed.empty()) return;
  const TopologyChange change(data_, History::Kind::kByItself);
  takeOut(freed);
  changeTopology({});
}

}  // namespace robot_tissue
