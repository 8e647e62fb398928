// Tissue: what becomes of pieces that nothing holds.
#include <algorithm>

#include "cutting/removal.h"
#include "material/tissue_model.h"
#include "tissue/history.h"
#include "tissue/tissue_parts.h"
#include "tissue/topology_change.h"

namespace robot_tissue {

// Of pieces that gravity pulls and nothing bears; ascending.
std::vector<int> TissueParts::hangingNodes() const {
  if (body_.gravity().isZero(0.0) || motion_.goesInTime() || motion_.isMoving()) return {};
  return pieces_.nodesOfFree();
}

// For one solve, as a patch that keeps them where they are. False: there are none.
bool TissueParts::holdHanging() {
  LoadingPatch patch;
  patch.nodes = hangingNodes();
  if (patch.nodes.empty()) return false;
  for (const int node : patch.nodes) patch.displacement.push_back(body_.displacement()[at(node)]);
  loads_.patches().push_back(std::move(patch));
  return true;
}

// What would have to hold them is no answer to a load.
void TissueParts::letHangingBe(SolveReport& report) {
  loads_.patches().pop_back();
  report.patches.resize(loads_.patches().size());
}

void TissueParts::takeOut(const std::vector<int>& pieces) {
  const std::vector<int>& piece_of = pieces_.ofNodes();
  std::vector<std::uint8_t> cells(body_.lattice().cells().size(), 0);
  for (const Cell& cell : body_.lattice().cells()) {
    unsigned bits = 0;
    for (int corner = 0; corner < kCorners; ++corner) {
      const int piece = piece_of[at(cell.nodes[at(corner)])];
      const bool goes = std::binary_search(pieces.begin(), pieces.end(), piece);
      if (goes && !isTaken(body_.state(), cell.place, corner)) bits |= 1U << corner;
    }
    cells[at(cell.place)] = static_cast<std::uint8_t>(bits);
  }
  removeCells(body_.lattice(), cells, body_.model().splitCells(), body_.change());
  body_.weigh();
  pieces_.renumberWithout(pieces);
  dropLostLoads();
}

// Within a change of the topology, before its balance. The surface, and with it the ends of
// threads, may still be that of before.
void TissueParts::dropFreed() {
  if (!pieces_.dropsFree() || body_.state().pieces == 1) return;
  if (threads_.anyWhole()) rebuildSurface();
  const std::vector<int> freed = pieces_.freed();
  if (!freed.empty()) takeOut(freed);
}

// By tools, loads or threads that hold them no longer.
void TissueParts::dropLetGo() {
  const std::vector<int> freed = pieces_.freed();
  if (freed.empty()) return;
  const TopologyChange change(*this, History::Kind::kByItself);
  takeOut(freed);
  changeTopology({});
}

}  // namespace robot_tissue
