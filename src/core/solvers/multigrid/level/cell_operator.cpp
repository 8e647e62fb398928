#include "solvers/multigrid/level/cell_operator.h"

#include <algorithm>
#include <utility>

#include "material/viscosity.h"
#include "simd/field_kernel.h"
#include "solvers/multigrid/level/cell_strain.h"

namespace robot_tissue {
namespace {

constexpr int kNoSum = -1;

template <typename Real>
std::array<Real, 3> rounded(const Vec3& values) {
  return {static_cast<Real>(values[0]), static_cast<Real>(values[1]), static_cast<Real>(values[2])};
}

template <typename Real>
FilledCell<Real> filledCell(const LooseCell<Real>& cell, const LevelFill& fill,
                            const CellReach* reach) {
  FilledCell<Real> filled;
  static_cast<LooseCell<Real>&>(filled) = cell;
  filled.centroid = rounded<Real>(fill.law.centroid);
  filled.pairs = rounded<Real>(fill.law.pairs);
  auto next = filled.bending.begin();
  for (int row = 0; row < kSecond; ++row) {
    for (int column = 0; column <= row; ++column) {
      *next++ = static_cast<Real>(fill.law.bending(row, column));
    }
  }
  if (reach != nullptr) filled.reach = *reach;
  filled.twisting = static_cast<Real>(fill.law.twisting);
  filled.between_parts = rounded<Real>(fill.between_parts);
  filled.low = rounded<Real>(fill.law.low);
  filled.high = rounded<Real>(fill.law.high);
  return filled;
}

}  // namespace

template <typename Real>
CellOperator<Real>::CellOperator(const LevelGrid& grid, int beside,
                                 const std::vector<LevelCell>& cells, const LevelPart& part)
    : grid_(grid), count_((grid.beside + beside + kLanes - 1) / kLanes * kLanes), part_(part) {
  for (auto& values : whole) values.assign(at(count_), Real(0));
  for (auto& values : stiffness) values.assign(at(count_), Real(0));
  for (auto* values : {&shear_, &bulk_}) values->assign(at(count_), Real(0));
  makeSums(1);
  beside_places_.assign(at(count_ - grid.beside), {});
  place(cells);
  findBlocks();
}

template <typename Real>
void CellOperator<Real>::place(const std::vector<LevelCell>& cells) {
  const bool stiffens = std::any_of(cells.begin(), cells.end(),
                                    [](const LevelCell& cell) { return cell.stiffening > 0.0; });
  if (stiffens) stiffening_.assign(at(count_), Real(0));
  std::vector<int> sum_of(at(count_), kNoSum);
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
    const Real stiffening = static_cast<Real>(cell.stiffening);
    if (regular && cell.fill == nullptr) {
      if (shear > Real(0) && stiffens) {  // the mean by stiffness
        Real& mean = stiffening_[at(lowest)];
        const Real before = shear_[at(lowest)];
        mean = (before * mean + shear * stiffening) / (before + shear);
      }
      shear_[at(lowest)] += shear;
      bulk_[at(lowest)] += bulk;
      continue;
    }
    const LooseCell<Real> loose = {cell.nodes, {}, shear, bulk, stiffening};
    if (cell.fill == nullptr) {
      loose_.push_back(loose);
    } else {
      filled_.push_back(filledCell(loose, *cell.fill, cell.reach.get()));
    }
    for (const int node : cell.nodes) sum_of[at(node)] = 0;
    for (int i = 0; cell.reach != nullptr && i < kBeyond; ++i) {
      if (cell.reach->nodes[at(i)] >= 0) sum_of[at(cell.reach->nodes[at(i)])] = 0;
    }
  }
  if (!loose_.empty() || !filled_.empty()) placeSums(std::move(sum_of));
}

// sum_of: per entry, kNoSum where it is of no loose cell.
template <typename Real>
void CellOperator<Real>::placeSums(std::vector<int> sum_of) {
  for (int node = 0; node < count_; ++node) {
    if (sum_of[at(node)] == kNoSum) continue;
    sum_of[at(node)] = static_cast<int>(loose_nodes_.size());
    loose_nodes_.push_back(node);
  }
  for (auto& sums : loose_sums_) sums.assign(loose_nodes_.size(), Real(0));
  const auto place = [&sum_of](LooseCell<Real>& cell) {
    for (std::size_t corner = 0; corner < cell.nodes.size(); ++corner) {
      cell.sums[corner] = sum_of[at(cell.nodes[corner])];
    }
  };
  std::for_each(loose_.begin(), loose_.end(), place);
  std::for_each(filled_.begin(), filled_.end(), place);
  for (FilledCell<Real>& cell : filled_) {
    for (std::size_t i = 0; i < kBeyond; ++i) {
      const int node = cell.reach.nodes[i];
      cell.sums_beyond[i] = node < 0 ? kNoSum : sum_of[at(node)];
    }
  }
}

template <typename Real>
void CellOperator<Real>::findBlocks() {
  const GridBox& covered = part_.covered;
  const auto stands = [&covered](const std::array<int, 3>& cell) {
    bool all = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      all = all && cell[axis] + 1 >= covered.low[axis] && cell[axis] <= covered.high[axis];
    }
    return all && !covered.isEmpty();
  };
  blocks_.assign(at(grid_.size[2]), {});
  covered_blocks_.assign(at(grid_.size[2]), {});
  for (int k = 0; k < grid_.size[2]; ++k) {
    for (int first = k * grid_.plane; first < (k + 1) * grid_.plane; first += kLanes) {
      CellBlock block{first, 0, 0};
      for (int lane = 0; lane < kLanes; ++lane) {
        if (!(shear_[at(first + lane)] > Real(0))) continue;
        const auto bit = static_cast<std::uint16_t>(1U << lane);
        block.cells |= bit;
        if (stands(grid_.placeOf(first + lane))) block.standing |= bit;
      }
      if (block.standing != 0) {
        covered_blocks_[at(k)].push_back({first, block.standing, block.standing});
      }
      if (block.cells == 0) continue;
      block.cells = kAllLanes;
      blocks_[at(k)].push_back(block);
    }
  }
}

template <typename Real>
void CellOperator<Real>::makeSums(int threads) {
  sums_.resize(at(threads));
  const std::size_t entries = at(grid_.plane + grid_.row + 1 + kLanes);
  for (Sums& each : sums_) {
    for (auto* sums : {&each.below, &each.lower, &each.upper}) {
      for (auto& values : *sums) values.assign(entries, Real(0));
    }
  }
}

template <typename Real>
void CellOperator<Real>::share(Workers& workers) {
  workers_ = &workers;
  makeSums(workers.count());
}

template <typename Real>
void CellOperator<Real>::findViscousForces(const Loads& loads) {
  const Real elastic = std::exchange(elastic_, Real(0));
  Numbers<Real> inertia_kept = std::exchange(inertia, {});
  findForces(loads, Find::kForces, blocks_);
  inertia = std::move(inertia_kept);
  elastic_ = elastic;
}

template <typename Real>
void CellOperator<Real>::setViscosity(double share, const Field<Real>& rate_from) {
  viscous_ = static_cast<Real>(share);
  elastic_ = Real(1) - viscous_;
  for (auto& values : inverse_) values.resize(share > 0.0 ? at(count_) : 0);
  if (!(share > 0.0)) return;
  for (int cell = 0; cell < grid_.beside; ++cell) {
    if (!(shear_[at(cell)] > Real(0))) continue;
    const std::array<Real, kNine> inverse = inverseOf(meanStrain(rate_from, nodesOf(cell)));
    for (std::size_t i = 0; i < kNine; ++i) inverse_[i][at(cell)] = inverse[i];
  }
  for (LooseCell<Real>& cell : loose_) cell.inverse = inverseOf(meanStrain(rate_from, cell.nodes));
  for (FilledCell<Real>& cell : filled_) cell.inverse = inverseOf(meanStrain(rate_from, cell));
}

template <typename Real>
std::array<int, kCorners> CellOperator<Real>::nodesOf(int cell) const {
  std::array<int, kCorners> nodes;
  for (int corner = 0; corner < kCorners; ++corner) {
    nodes[at(corner)] =
        cell + (corner & 1) + (corner >> 1 & 1) * grid_.row + (corner >> 2 & 1) * grid_.plane;
  }
  return nodes;
}

template <typename Real>
std::array<Real, kNine> CellOperator<Real>::inverseOf(const Eigen::Matrix3d& strain) const {
  const Eigen::Matrix3d inverse = viscosity::inverseOf(strain);
  std::array<Real, kNine> numbers;
  for (std::size_t i = 0; i < kNine; ++i) {
    numbers[i] = static_cast<Real>(inverse(static_cast<int>(i / 3), static_cast<int>(i % 3)));
  }
  return numbers;
}

template <typename Real>
bool CellOperator<Real>::isShared() const {
  return workers_ != nullptr && grid_.plane * grid_.size[2] >= level_tuning::kWorthSharing;
}

template <typename Real>
void CellOperator<Real>::findForces(const Loads& loads, Find what) {
  findForces(loads, what, blocks_);
}

template <typename Real>
void CellOperator<Real>::takeFree(const Loads& loads) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    takeWhereFree(whole[axis].data(), loads.free.data(), loads.force[axis].data(), count_);
  }
  invertWhereFree(pointersTo(std::as_const(stiffness)), loads.free.data(),
                  pointersTo(loads.inverse), count_);
}

template <typename Real>
void CellOperator<Real>::findForcesOfCovered(const Loads& loads) {
  findForces(loads, Find::kForces, covered_blocks_);
}

// Each thread takes planes that lie together; the plane of cells between two threads' nodes is
// computed by both.
template <typename Real>
void CellOperator<Real>::findForces(const Loads& loads, Find what, const Blocks& blocks) {
  for (std::size_t axis = 0; hasRelief() && axis < 3; ++axis) {
    subtract(loads.displacement[axis].data(), relieved_at_[axis].data(), Real(1),
             motion_[axis].data(), count_);
  }
  if (!isShared()) {
    findPlanes(loads, what, blocks, 0, grid_.size[2], sums_.front());
  } else {
    workers_->shareAndLearn(grid_.size[2], [&](int thread, int first, int end) {
      findPlanes(loads, what, blocks, first, end, sums_[at(thread)]);
    });
  }
  finishBeside(loads, what);
}

template <typename Real>
CellGrid<Real> CellOperator<Real>::gridOf(const Loads& loads) const {
  CellGrid<Real> cells{};
  const Field<Real>& displacement = hasRelief() ? motion_ : loads.displacement;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.displacement[axis] = displacement[axis].data();
  }
  cells.shear = shear_.data();
  cells.bulk = bulk_.data();
  if (!stiffening_.empty()) cells.stiffening = stiffening_.data();
  cells.row = grid_.row;
  cells.plane = grid_.plane;
  cells.loose_stand = !part_.covered.isEmpty();
  cells.per_greatest = per_greatest;
  cells.has_viscosity = viscous_ > Real(0);
  cells.elastic = elastic_;
  cells.viscous = viscous_;
  for (std::size_t i = 0; i < kNine; ++i) cells.inverse[i] = inverse_[i].data();
  for (std::size_t i = 0; hasRelief() && i < kNine; ++i) cells.relief[i] = relief_[i].data();
  return cells;
}

// Planes of nodes first .. end - 1, each as soon as both planes of cells at it are done, while its
// sums are in the cache. Each is the sum of the same two terms wherever `first` is: any number of
// threads finds the same.
template <typename Real>
void CellOperator<Real>::findPlanes(const Loads& loads, Find what, const Blocks& blocks, int first,
                                    int end, Sums& sums) {
  if (first >= end) return;
  if (first > 0) {
    addPlane(loads, what, blocks[at(first - 1)], first - 1, sums);
  } else {
    for (auto& values : sums.upper) std::fill(values.begin(), values.end(), Real(0));
  }
  for (int plane = first; plane < end; ++plane) {
    sums.below.swap(sums.upper);
    addPlane(loads, what, blocks[at(plane)], plane, sums);
    finishPlane(loads, what, plane, sums);
  }
}

template <typename Real>
void CellOperator<Real>::addPlane(const Loads& loads, Find what,
                                  const std::vector<CellBlock>& blocks, int plane,
                                  Sums& sums) const {
  const std::size_t sums_asked = what == Find::kForcesAndStiffness ? kAllSums : kForcesAlone;
  for (auto* both : {&sums.lower, &sums.upper}) {
    for (std::size_t i = 0; i < sums_asked; ++i) {
      std::fill((*both)[i].begin(), (*both)[i].end(), Real(0));
    }
  }
  CellGrid<Real> cells = gridOf(loads);
  cells.origin = plane * grid_.plane;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.lower[axis] = sums.lower[axis].data();
    cells.upper[axis] = sums.upper[axis].data();
  }
  for (std::size_t part = kForcesAlone; part < sums_asked; ++part) {
    cells.lower_stiffness[part - kForcesAlone] = sums.lower[part].data();
    cells.upper_stiffness[part - kForcesAlone] = sums.upper[part].data();
  }
  addBlocks(cells, blocks.data(), static_cast<int>(blocks.size()));
}

template <typename Real>
void CellOperator<Real>::finishPlane(const Loads& loads, Find what, int plane, const Sums& sums) {
  const int first = plane * grid_.plane;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sumForces(sums.below[axis].data(), sums.lower[axis].data(),
              loads.right_hand_side[axis].data() + first, loads.free.data() + first,
              whole[axis].data() + first, loads.force[axis].data() + first, grid_.plane);
  }
  if (what == Find::kForcesAndStiffness) {
    for (std::size_t part = 0; part < kSymmetric; ++part) {
      sumBoth(sums.below[kForcesAlone + part].data(), sums.lower[kForcesAlone + part].data(),
              stiffness[part].data() + first, grid_.plane);
    }
  }
  if (!inertia.empty()) addInertia(loads, what, first, grid_.plane);
  if (what == Find::kForcesAndStiffness) {
    invertWhereFree(pointersTo(std::as_const(stiffness), first), loads.free.data() + first,
                    pointersTo(loads.inverse, first), grid_.plane);
  }
}

// To sums that are there.
template <typename Real>
void CellOperator<Real>::addInertia(const Loads& loads, Find what, int first, int count) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    addHolds(inertia.data() + first, loads.displacement[axis].data() + first,
             loads.free.data() + first, whole[axis].data() + first,
             loads.force[axis].data() + first, count);
  }
  if (what != Find::kForcesAndStiffness) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    addShare(inertia.data() + first, Real(1), stiffness[axis].data() + first, count);
  }
}

// Nodes beside the grid, and those on it that loose cells have.
template <typename Real>
void CellOperator<Real>::finishBeside(const Loads& loads, Find what) {
  if (loose_nodes_.empty()) return;
  for (auto& sums : loose_sums_) std::fill(sums.begin(), sums.end(), Real(0));
  CellGrid<Real> cells = gridOf(loads);
  for (std::size_t axis = 0; axis < 3; ++axis) cells.lower[axis] = loose_sums_[axis].data();
  for (std::size_t part = 0; part < kSymmetric && what == Find::kForcesAndStiffness; ++part) {
    cells.lower_stiffness[part] = loose_sums_[kForcesAlone + part].data();
  }
  addLoose(cells, loose_.data(), static_cast<int>(loose_.size()));
  addFilled(cells, filled_.data(), static_cast<int>(filled_.size()));
  for (std::size_t i = 0; i < loose_nodes_.size(); ++i) {
    const std::size_t node = at(loose_nodes_[i]);
    const bool is_free = loads.free[node] != Real(0), is_beside = loose_nodes_[i] >= grid_.beside;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (is_beside) {
        whole[axis][node] = loads.right_hand_side[axis][node];
        if (!inertia.empty()) whole[axis][node] -= inertia[node] * loads.displacement[axis][node];
      }
      whole[axis][node] += loose_sums_[axis][i];
      loads.force[axis][node] = is_free ? whole[axis][node] : Real(0);
    }
    if (what != Find::kForcesAndStiffness) continue;
    for (std::size_t part = 0; part < kSymmetric; ++part) {
      Real& here = stiffness[part][node];
      if (is_beside) here = part < 3 && !inertia.empty() ? inertia[node] : Real(0);
      here += loose_sums_[kForcesAlone + part][i];
    }
    const int first = loose_nodes_[i];
    invertWhereFree(pointersTo(std::as_const(stiffness), first), loads.free.data() + first,
                    pointersTo(loads.inverse, first), 1);
  }
}

template class CellOperator<float>;
template class CellOperator<double>;

}  // namespace robot_tissue
