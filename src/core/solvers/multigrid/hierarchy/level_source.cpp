#include "solvers/multigrid/hierarchy/level_source.h"

#include <algorithm>

#include "solvers/multigrid/hierarchy/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = hierarchy_tuning;

constexpr GridBox kNowhere = {{1, 1, 1}, {0, 0, 0}};

template <typename Visit>
void forAll(const std::array<int, 3>& count, Visit visit) {
  for (int k = 0; k < count[2]; ++k) {
    for (int j = 0; j < count[1]; ++j) {
      for (int i = 0; i < count[0]; ++i) visit(i, j, k);
    }
  }
}

std::array<int, 3> cellsOf(const LevelSource& source) {
  return {source.size[0] - 1, source.size[1] - 1, source.size[2] - 1};
}

void lessen(LevelSource& source) {
  for (std::vector<double>* moduli : {&source.shear, &source.bulk, &source.stiffening}) {
    for (const double modulus : *moduli) {
      if (modulus != moduli->front()) return;
    }
  }
  source.shear = {source.shear.front()};
  source.bulk = {source.bulk.front()};
  source.stiffening = {source.stiffening.front()};
}

// Cells with the mean of the moduli of eight each; those beyond the block's end count as 0.
LevelSource coarser(LevelSource& fine) {
  LevelSource coarse;
  for (std::size_t axis = 0; axis < 3; ++axis) coarse.size[axis] = fine.size[axis] / 2 + 1;
  const std::array<int, 3> cells = cellsOf(coarse), fine_cells = cellsOf(fine);
  const std::size_t count = at(cells[0] * cells[1] * cells[2]);
  coarse.shear.resize(count);
  coarse.bulk.resize(count);
  coarse.stiffening.resize(count);
  forAll(cells, [&](int i, int j, int k) {
    double shear = 0.0, bulk = 0.0, stiffening = 0.0;
    bool differ = false;
    const std::size_t first = fine.cellAt(2 * i, 2 * j, 2 * k);
    for (int part = 0; part < kCorners; ++part) {
      const int x = 2 * i + (part & 1), y = 2 * j + (part >> 1 & 1), z = 2 * k + (part >> 2 & 1);
      if (x >= fine_cells[0] || y >= fine_cells[1] || z >= fine_cells[2]) continue;
      const std::size_t cell = fine.cellAt(x, y, z);
      shear += fine.shear[cell];
      bulk += fine.bulk[cell];
      stiffening += fine.shear[cell] * fine.stiffening[cell];
      differ = differ || fine.shear[cell] != fine.shear[first] ||
               fine.bulk[cell] != fine.bulk[first] ||
               fine.stiffening[cell] != fine.stiffening[first];
    }
    coarse.shear[coarse.cellAt(i, j, k)] = shear / kCorners;
    coarse.bulk[coarse.cellAt(i, j, k)] = bulk / kCorners;
    coarse.stiffening[coarse.cellAt(i, j, k)] = stiffening > 0.0 ? stiffening / shear : 0.0;
    if (differ) {
      fine.rough = joined(fine.rough, {{2 * i, 2 * j, 2 * k}, {2 * i + 2, 2 * j + 2, 2 * k + 2}});
    }
  });
  return coarse;
}

using Held = std::vector<std::uint8_t>;  // per point, x fastest

std::size_t pointAt(const LevelSource& source, int i, int j, int k) {
  return at(i + source.size[0] * (j + source.size[1] * k));
}

// A coarse node is held if the node at its place is, or next to it where the block ends before. A
// fine node that is held though not all its carriers are, or the other way round, is rough.
Held heldOn(const LevelSource& coarse, LevelSource& fine, const Held& held) {
  Held on_coarse(at(coarse.size[0] * coarse.size[1] * coarse.size[2]), 0);
  forAll(coarse.size, [&](int i, int j, int k) {
    const std::array<int, 3> last = fine.whole().high;
    on_coarse[pointAt(coarse, i, j, k)] = held[pointAt(
        fine, std::min(2 * i, last[0]), std::min(2 * j, last[1]), std::min(2 * k, last[2]))];
  });
  forAll(fine.size, [&](int i, int j, int k) {
    bool all = true;
    for (int z = k / 2; z <= (k + 1) / 2; ++z) {
      for (int y = j / 2; y <= (j + 1) / 2; ++y) {
        for (int x = i / 2; x <= (i + 1) / 2; ++x) {
          all = all && on_coarse[pointAt(coarse, x, y, z)] != 0;
        }
      }
    }
    if (all != (held[pointAt(fine, i, j, k)] != 0)) {
      fine.rough = joined(fine.rough, {{i, j, k}, {i, j, k}});
    }
  });
  return on_coarse;
}

bool isBlock(const Lattice& lattice, const ElasticModel& model, const CellSet& cells) {
  const auto& size = lattice.size();
  const int all = (size[0] - 1) * (size[1] - 1) * (size[2] - 1);
  return cells.ghosts().empty() && static_cast<int>(cells.all().size()) == all &&
         std::all_of(cells.all().begin(), cells.all().end(), [&](const Cell& cell) {
           return cell.fill == nullptr && model.cornerWeight(cell, 0).isZero(0.0);
         });
}

}  // namespace

bool LevelSource::isThick() const {
  const auto [shortest, longest] = std::minmax_element(size.begin(), size.end());
  return *shortest > tuning::kThick && *longest - 1 <= tuning::kMostSlender * (*shortest - 1);
}

std::vector<LevelCell> LevelSource::cellsIn(const GridBox& points, const LevelGrid& grid) const {
  std::vector<LevelCell> cells;
  const std::array<int, 3> count = {points.high[0] - points.low[0], points.high[1] - points.low[1],
                                    points.high[2] - points.low[2]};
  cells.reserve(at(count[0] * count[1] * count[2]));
  forAll(count, [&](int i, int j, int k) {
    LevelCell cell;
    cell.place = {i, j, k};
    const std::size_t here = cellAt(points.low[0] + i, points.low[1] + j, points.low[2] + k);
    cell.shear = shear[here];
    cell.bulk = bulk[here];
    cell.stiffening = stiffening[here];
    for (int corner = 0; corner < kCorners; ++corner) {
      cell.nodes[at(corner)] =
          grid.index(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1));
    }
    cells.push_back(cell);
  });
  return cells;
}

std::vector<LevelSource> levelSources(const Lattice& lattice, const ElasticModel& model,
                                      const CellSet& cells, double modulus, int fewest) {
  if (!isBlock(lattice, model, cells)) return {};
  std::vector<LevelSource> sources(1);
  sources.front().size = lattice.size();
  sources.front().rough = kNowhere;
  for (const Cell& cell : cells.all()) {
    const Moduli moduli = model.cellModuli(cell);
    sources.front().shear.push_back(moduli.shear / modulus);
    sources.front().bulk.push_back(moduli.bulk / modulus);
    sources.front().stiffening.push_back(moduli.stiffening);
  }
  lessen(sources.front());
  Held held;
  for (int node = 0; node < lattice.nodeCount(); ++node) held.push_back(lattice.isFixed(node));
  while (*std::max_element(sources.back().size.begin(), sources.back().size.end()) > fewest) {
    LevelSource coarse = coarser(sources.back());
    coarse.rough = kNowhere;
    held = heldOn(coarse, sources.back(), held);
    lessen(coarse);
    sources.push_back(std::move(coarse));
  }
  return sources;
}

}  // namespace robot_tissue
