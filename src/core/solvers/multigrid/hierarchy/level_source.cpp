#include "solvers/multigrid/hierarchy/level_source.h"

#include <algorithm>
#include <utility>

#include "solvers/multigrid/hierarchy/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = hierarchy_tuning;

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
  // As new vectors: those of all cells go.
  source.shear = std::vector<double>(1, source.shear.front());
  source.bulk = std::vector<double>(1, source.bulk.front());
  source.stiffening = std::vector<double>(1, source.stiffening.front());
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

bool isBlock(const Lattice& lattice, const ElasticModel& model) {
  const auto& size = lattice.size();
  const int all = (size[0] - 1) * (size[1] - 1) * (size[2] - 1);
  return static_cast<int>(lattice.cells().size()) == all &&
         std::all_of(lattice.cells().begin(), lattice.cells().end(), [&](const Cell& cell) {
           return cell.fill == nullptr && model.cornerWeight(cell, 0).isZero(0.0);
         });
}

// Around the cells of a block that are not there, or only in part.
GridBox cutBox(const Lattice& lattice, const CellSet& cells) {
  GridBox box = kNowhere;
  const auto add = [&](int place) {
    const std::array<int, 3> low = lattice.gridIndex(lattice.cells()[at(place)].nodes[0]);
    box = joined(box, {low, {low[0] + 1, low[1] + 1, low[2] + 1}});
  };
  int next = 0;
  for (const Cell& cell : cells.all()) {
    for (; next < cell.place; ++next) add(next);
    if (cell.isPart() || cell.fill != nullptr) add(cell.place);
    next = cell.place + 1;
  }
  for (; next < static_cast<int>(lattice.cells().size()); ++next) add(next);
  return box;
}

// Beside what is cut, cells that are whole on the next coarser level, too.
constexpr int kBesideCut = 2;

ListedCells listedIn(const GridBox& box, const Lattice& lattice, const ElasticModel& model,
                     const CellSet& cells, double modulus) {
  ListedCells listed;
  listed.box = box;
  listed.grid = LevelGrid(lattice.size());
  listed.beside = static_cast<int>(cells.ghosts().size());
  const auto entry_of = [&](int node) {
    if (cells.isGhost(node)) return listed.grid.beside + node - cells.latticeNodeCount();
    const std::array<int, 3> place = lattice.gridIndex(node);
    return listed.grid.index(place[0], place[1], place[2]);
  };
  for (const Cell& cell : cells.all()) {
    const std::array<int, 3> place = lattice.gridIndex(lattice.cells()[at(cell.place)].nodes[0]);
    if (hasCell(box, place)) {
      listed.cells.push_back(levelCellOf(model, cell, modulus, place, entry_of));
    }
  }
  return listed;
}

// Of the block as if nothing was cut, those between the points that are wanted, by their place in
// the whole grid; they are placed from the origin.
template <typename Wanted>
void addUncut(const LevelSource& source, const GridBox& points, const std::array<int, 3>& origin,
              const LevelGrid& grid, Wanted isWanted, std::vector<LevelCell>& cells) {
  const std::array<int, 3> count = {points.high[0] - points.low[0], points.high[1] - points.low[1],
                                    points.high[2] - points.low[2]};
  forAll(count, [&](int i, int j, int k) {
    const std::array<int, 3> place = {points.low[0] + i, points.low[1] + j, points.low[2] + k};
    if (!isWanted(place)) return;
    LevelCell cell;
    const std::size_t here = source.cellAt(place[0], place[1], place[2]);
    cell.shear = source.shear[here];
    cell.bulk = source.bulk[here];
    cell.stiffening = source.stiffening[here];
    for (std::size_t axis = 0; axis < 3; ++axis) cell.place[axis] = place[axis] - origin[axis];
    for (int corner = 0; corner < kCorners; ++corner) {
      cell.nodes[at(corner)] =
          grid.index(cell.place[0] + (corner & 1), cell.place[1] + (corner >> 1 & 1),
                     cell.place[2] + (corner >> 2 & 1));
    }
    cells.push_back(std::move(cell));
  });
}

// Lists the coarse cells for those that the finer level lists, and as many of the block's beside
// them as the next coarser level asks for.
void listCoarse(LevelSource& fine, LevelSource& coarse) {
  ListedCells& from = fine.listed;
  ListedCells& to = coarse.listed;
  from.to_coarser = coarsened(from.grid, from.cells, from.grid.beside + from.beside);
  GridBox covered = from.box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    covered.low[axis] /= 2;
    covered.high[axis] = (covered.high[axis] + 1) / 2;
  }
  to.grid = from.to_coarser.grid;
  to.beside = from.to_coarser.nodes_beside;
  to.cells = std::move(from.to_coarser.cells);
  to.box = evenAround(covered, kBesideCut, coarse.whole());
  const auto is_beside = [&](const std::array<int, 3>& place) { return !hasCell(covered, place); };
  addUncut(coarse, to.box, coarse.whole().low, to.grid, is_beside, to.cells);
  findReaches(to.cells);
}

}  // namespace

bool LevelSource::isThick() const {
  const auto [shortest, longest] = std::minmax_element(size.begin(), size.end());
  return *shortest > tuning::kThick && *longest - 1 <= tuning::kMostSlender * (*shortest - 1);
}

std::vector<LevelCell> LevelSource::cellsIn(const GridBox& points, const LevelGrid& grid) const {
  if (listed.isEmpty()) return uncutIn(points, grid);
  std::vector<LevelCell> cells;
  const auto is_uncut = [&](const std::array<int, 3>& place) {
    return !hasCell(listed.box, place);
  };
  addUncut(*this, points, points.low, grid, is_uncut, cells);
  const PartEntries in_part(listed.grid, points, grid);
  for (const LevelCell& cell : listed.cells) {
    if (hasCell(points, cell.place)) cells.push_back(in_part(cell));
  }
  return cells;
}

std::vector<LevelCell> LevelSource::uncutIn(const GridBox& points, const LevelGrid& grid) const {
  std::vector<LevelCell> cells;
  cells.reserve(at((points.high[0] - points.low[0]) * (points.high[1] - points.low[1]) *
                   (points.high[2] - points.low[2])));
  addUncut(
      *this, points, points.low, grid, [](const auto&) { return true; }, cells);
  return cells;
}

std::vector<LevelSource> levelSources(const Lattice& lattice, const ElasticModel& model,
                                      const GridBox& between, double modulus, int fewest) {
  if (!isBlock(lattice, model)) return {};
  std::vector<LevelSource> sources(1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sources.front().size[axis] = between.high[axis] - between.low[axis] + 1;
  }
  sources.front().rough = kNowhere;
  for (const Cell& cell : lattice.cells()) {
    if (!hasCell(between, lattice.gridIndex(cell.nodes[0]))) continue;
    const Moduli moduli = model.cellModuli(cell);
    sources.front().shear.push_back(moduli.shear / modulus);
    sources.front().bulk.push_back(moduli.bulk / modulus);
    sources.front().stiffening.push_back(moduli.stiffening);
  }
  lessen(sources.front());
  Held held;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    if (between.has(lattice.gridIndex(node))) held.push_back(lattice.isFixed(node));
  }
  const auto isCoarsest = [&] {
    const auto& size = sources.back().size;
    return sources.size() > 1 && *std::max_element(size.begin(), size.end()) <= fewest;
  };
  while (!isCoarsest()) {
    LevelSource coarse = coarser(sources.back());
    coarse.rough = kNowhere;
    held = heldOn(coarse, sources.back(), held);
    lessen(coarse);
    sources.push_back(std::move(coarse));
  }
  return sources;
}

void listCuts(const Lattice& lattice, const ElasticModel& model, const CellSet& cells,
              double modulus, std::vector<LevelSource>& sources) {
  for (LevelSource& source : sources) source.listed = ListedCells();
  const GridBox cut = cutBox(lattice, cells);
  if (sources.empty() || cut.isEmpty()) return;
  const GridBox box = evenAround(cut, kBesideCut, sources.front().whole());
  sources.front().listed = listedIn(box, lattice, model, cells, modulus);
  for (std::size_t level = 1; level < sources.size(); ++level) {
    listCoarse(sources[level - 1], sources[level]);
  }
}

}  // namespace robot_tissue
