#include "robot_tissue/core/level_cells.h"

#include <algorithm>

namespace robot_tissue {

template <typename Real>
LevelCells<Real>::LevelCells(const LevelGrid& grid, int beside, const std::vector<LevelCell>& cells,
                             bool is_coarse)
    : grid_(grid),
      count_((grid.beside + beside + kLanes - 1) / kLanes * kLanes),
      is_coarse_(is_coarse) {
  for (Field<Real>* field : {&lower, &upper}) {
    for (auto& values : *field) values.assign(at(count_), Real(0));
  }
  for (auto* values : {&lower_stiffness, &upper_stiffness, &shear_, &bulk_}) {
    values->assign(at(count_), Real(0));
  }
  beside_places_.assign(at(count_ - grid.beside), {});
  place(cells);
  LevelBox whole;
  for (std::size_t axis = 0; axis < 3; ++axis) whole.high[axis] = grid.size[axis] - 1;
  confine(whole);
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
      loose_.push_back({cell.nodes, shear, bulk});
    }
  }
}

template <typename Real>
void LevelCells<Real>::confine(const LevelBox& box) {
  box_ = box;
  spans_.clear();
  blocks_.clear();
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
  for (int k = std::max(box.low[2] - 1, 0); k <= std::min(box.high[2] + 1, size[2] - 1); ++k) {
    const bool whole = y == 0 && last_y == size[1] - 1;
    const int end =
        grid_.index(0, last_y, k) + (whole ? grid_.plane - grid_.index(0, last_y, 0) : grid_.row);
    add(grid_.index(0, y, k), end);
    if (k > box.high[2]) break;
    for (int first = k * grid_.plane; first < (k + 1) * grid_.plane; first += kLanes) {
      bool any = false;
      for (int cell = first; !any && cell < first + kLanes; ++cell) {
        const std::array<int, 3> place = grid_.placeOf(cell);
        any = shear_[at(cell)] > Real(0) && place[0] >= x && place[0] <= box.high[0] &&
              place[1] >= y && place[1] <= box.high[1];
      }
      if (any) blocks_.push_back(first);
    }
  }
  add(grid_.beside, count_);
}

// What a block adds out of the spans is not looked at.
template <typename Real>
void LevelCells<Real>::findForces(const Field<Real>& displacement, bool with_stiffness) {
  const auto clear = [this](std::vector<Real>& values) {
    for (const Span& span : spans_) {
      std::fill_n(values.begin() + span.first, span.count, Real(0));
    }
  };
  CellGrid<Real> cells{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    clear(lower[axis]);
    clear(upper[axis]);
    cells.displacement[axis] = displacement[axis].data();
    cells.lower[axis] = lower[axis].data();
    cells.upper[axis] = upper[axis].data();
  }
  if (with_stiffness) {
    clear(lower_stiffness);
    clear(upper_stiffness);
    cells.lower_stiffness = lower_stiffness.data();
    cells.upper_stiffness = upper_stiffness.data();
  }
  cells.shear = shear_.data();
  cells.bulk = bulk_.data();
  cells.row = grid_.row;
  cells.plane = grid_.plane;
  cells.is_coarse = is_coarse_;
  addBlocks(cells, blocks_.data(), static_cast<int>(blocks_.size()));
  addLoose(cells, loose_.data(), static_cast<int>(loose_.size()));
}

template class LevelCells<float>;
template class LevelCells<double>;

}  // namespace robot_tissue
