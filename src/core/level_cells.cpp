#include "robot_tissue/core/level_cells.h"

#include <algorithm>

#include "robot_tissue/core/field_kernel.h"

namespace robot_tissue {
namespace {

constexpr int kWorthSharing =
    8000;  // nodes that are visited: with fewer, threads wait more than work

}  // namespace

template <typename Real>
LevelCells<Real>::LevelCells(const LevelGrid& grid, int beside, const std::vector<LevelCell>& cells,
                             bool is_coarse)
    : grid_(grid),
      count_((grid.beside + beside + kLanes - 1) / kLanes * kLanes),
      is_coarse_(is_coarse) {
  for (auto& values : whole) values.assign(at(count_), Real(0));
  for (auto* values : {&stiffness, &shear_, &bulk_}) values->assign(at(count_), Real(0));
  makeSums(1);
  beside_places_.assign(at(count_ - grid.beside), {});
  place(cells);
  LevelBox everything;
  for (std::size_t axis = 0; axis < 3; ++axis) everything.high[axis] = grid.size[axis] - 1;
  confine(everything);
}

template <typename Real>
void LevelCells<Real>::place(const std::vector<LevelCell>& cells) {
  for (const LevelCell& cell : cells) {
    const int lowest = grid_.index(cell.place[0], cell.place[1], cell.place[2]);
    bool regular = true;
    for (int corner = 0; corner < kCorners; ++corner) {
      const std::array<int, 3> offset = {corner & 1, corner >> 1 & 1, corner >> 2 & 1};
      const int node = cell.nodes[at(corner)];
      if (node >= grid_.beside) {
        auto& there = beside_places_[at(node - grid_.beside)];
        for (std::size_t axis = 0; axis < 3; ++axis) there[axis] = cell.place[axis] + offset[axis];
      }
      regular = regular && node == lowest + grid_.index(offset[0], offset[1], offset[2]);
    }
    const Real shear = static_cast<Real>(cell.shear), bulk = static_cast<Real>(cell.bulk);
    if (regular) {
      shear_[at(lowest)] += shear;
      bulk_[at(lowest)] += bulk;
    } else {
      loose_.push_back({cell.nodes, {}, shear, bulk});
      loose_nodes_.insert(loose_nodes_.end(), cell.nodes.begin(), cell.nodes.end());
    }
  }
  std::sort(loose_nodes_.begin(), loose_nodes_.end());
  loose_nodes_.erase(std::unique(loose_nodes_.begin(), loose_nodes_.end()), loose_nodes_.end());
  for (auto& sums : loose_sums_) sums.assign(loose_nodes_.size(), Real(0));
  for (LooseCell<Real>& cell : loose_) {
    for (std::size_t corner = 0; corner < cell.nodes.size(); ++corner) {
      const auto found =
          std::lower_bound(loose_nodes_.begin(), loose_nodes_.end(), cell.nodes[corner]);
      cell.sums[corner] = static_cast<int>(found - loose_nodes_.begin());
    }
  }
}

template <typename Real>
void LevelCells<Real>::confine(const LevelBox& box) {
  box_ = box;
  spans_.clear();
  blocks_.assign(at(grid_.size[2]), {});
  const auto add = [this](int first, int end) {
    if (!spans_.empty() && spans_.back().first + spans_.back().count >= first) {
      spans_.back().count = end - spans_.back().first;
    } else {
      spans_.push_back({first, end - first});
    }
  };
  const auto& size = grid_.size;
  const int x = std::max(box.low[0] - 1, 0), y = std::max(box.low[1] - 1, 0);
  const int last_y = std::min(box.high[1] + 1, size[1] - 1);
  const bool whole_planes = y == 0 && last_y == size[1] - 1;
  rows_ = {y * grid_.row, whole_planes ? grid_.plane : (last_y + 1 - y) * grid_.row};
  for (int k = std::max(box.low[2] - 1, 0); k <= std::min(box.high[2] + 1, size[2] - 1); ++k) {
    add(k * grid_.plane + rows_.first, k * grid_.plane + rows_.first + rows_.count);
    if (k > box.high[2]) break;
    for (int first = k * grid_.plane; first < (k + 1) * grid_.plane; first += kLanes) {
      bool any = false;
      for (int cell = first; !any && cell < first + kLanes; ++cell) {
        const std::array<int, 3> place = grid_.placeOf(cell);
        any = shear_[at(cell)] > Real(0) && place[0] >= x && place[0] <= box.high[0] &&
              place[1] >= y && place[1] <= box.high[1];
      }
      if (any) blocks_[at(k)].push_back(first);
    }
  }
  add(grid_.beside, count_);
}

template <typename Real>
void LevelCells<Real>::makeSums(int threads) {
  sums_.resize(at(threads));
  const std::size_t entries = at(grid_.plane + grid_.row + 1 + kLanes);
  for (Sums& each : sums_) {
    for (auto* sums : {&each.below, &each.lower, &each.upper}) {
      for (auto& values : *sums) values.assign(entries, Real(0));
    }
  }
}

template <typename Real>
void LevelCells<Real>::share(Workers& workers) {
  workers_ = &workers;
  makeSums(workers.count());
}

// Threads take planes that lie together; the plane of cells between two shares is summed by both.
template <typename Real>
void LevelCells<Real>::findForces(const Loads& loads, bool with_steps) {
  const int first = std::max(box_.low[2] - 1, 0);
  const int planes = std::min(box_.high[2] + 2, grid_.size[2]) - first;
  if (workers_ == nullptr || rows_.count * planes < kWorthSharing) {
    findPlanes(loads, with_steps, first, first + planes, sums_.front());
  } else {
    const int threads = workers_->count();
    workers_->run([&](int part) {
      findPlanes(loads, with_steps, first + planes * part / threads,
                 first + planes * (part + 1) / threads, sums_[at(part)]);
    });
  }
  finishBeside(loads, with_steps);
}

template <typename Real>
CellGrid<Real> LevelCells<Real>::gridOf(const Loads& loads) const {
  CellGrid<Real> cells{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.displacement[axis] = loads.displacement[axis].data();
  }
  cells.shear = shear_.data();
  cells.bulk = bulk_.data();
  cells.row = grid_.row;
  cells.plane = grid_.plane;
  cells.is_coarse = is_coarse_;
  return cells;
}

// Planes of nodes first .. end - 1, each as soon as both planes of cells at it are done, while all
// is near at hand. What is found on a plane does not hang on where the planes begin.
template <typename Real>
void LevelCells<Real>::findPlanes(const Loads& loads, bool with_steps, int first, int end,
                                  Sums& sums) {
  if (first >= end) return;
  if (first > 0) {
    addPlane(loads, with_steps, first - 1, sums);
  } else {
    for (auto& values : sums.upper) std::fill(values.begin(), values.end(), Real(0));
  }
  for (int plane = first; plane < end; ++plane) {
    sums.below.swap(sums.upper);
    addPlane(loads, with_steps, plane, sums);
    finishPlane(loads, with_steps, plane, sums);
  }
}

template <typename Real>
void LevelCells<Real>::addPlane(const Loads& loads, bool with_steps, int plane, Sums& sums) const {
  const int slack = grid_.row + 1 + kLanes;
  for (auto* both : {&sums.lower, &sums.upper}) {
    for (auto& values : *both) {
      std::fill_n(values.begin() + rows_.first, rows_.count + slack, Real(0));
    }
  }
  CellGrid<Real> cells = gridOf(loads);
  cells.origin = plane * grid_.plane;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.lower[axis] = sums.lower[axis].data();
    cells.upper[axis] = sums.upper[axis].data();
  }
  if (with_steps) {
    cells.lower_stiffness = sums.lower[3].data();
    cells.upper_stiffness = sums.upper[3].data();
  }
  const std::vector<int>& blocks = blocks_[at(plane)];
  addBlocks(cells, blocks.data(), static_cast<int>(blocks.size()));
}

template <typename Real>
void LevelCells<Real>::finishPlane(const Loads& loads, bool with_steps, int plane,
                                   const Sums& sums) {
  const int first = plane * grid_.plane + rows_.first;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sumForces(sums.below[axis].data() + rows_.first, sums.lower[axis].data() + rows_.first,
              loads.load[axis].data() + first, loads.free.data() + first,
              whole[axis].data() + first, loads.force[axis].data() + first, rows_.count);
  }
  if (!with_steps) return;
  invertStiffness(sums.below[3].data() + rows_.first, sums.lower[3].data() + rows_.first,
                  loads.free.data() + first, stiffness.data() + first, loads.inverse.data() + first,
                  rows_.count);
}

// Nodes beside the grid, and those on it that loose cells have.
template <typename Real>
void LevelCells<Real>::finishBeside(const Loads& loads, bool with_steps) {
  if (loose_.empty()) return;
  for (auto& sums : loose_sums_) std::fill(sums.begin(), sums.end(), Real(0));
  CellGrid<Real> cells = gridOf(loads);
  for (std::size_t axis = 0; axis < 3; ++axis) cells.lower[axis] = loose_sums_[axis].data();
  if (with_steps) cells.lower_stiffness = loose_sums_[3].data();
  addLoose(cells, loose_.data(), static_cast<int>(loose_.size()));
  for (std::size_t i = 0; i < loose_nodes_.size(); ++i) {
    const std::size_t node = at(loose_nodes_[i]);
    const bool is_free = loads.free[node] != Real(0), is_beside = loose_nodes_[i] >= grid_.beside;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (is_beside) whole[axis][node] = loads.load[axis][node];
      whole[axis][node] += loose_sums_[axis][i];
      loads.force[axis][node] = is_free ? whole[axis][node] : Real(0);
    }
    if (!with_steps) continue;
    if (is_beside) stiffness[node] = Real(0);
    stiffness[node] += loose_sums_[3][i];
    loads.inverse[node] = is_free ? Real(1) / stiffness[node] : Real(0);
  }
}

template class LevelCells<float>;
template class LevelCells<double>;

}  // namespace robot_tissue
