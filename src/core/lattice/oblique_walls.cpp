#include "lattice/oblique_walls.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace robot_tissue {
namespace {

// Least and most of what a cell keeps of its moduli (1). Wider bounds move walls of two spacings
// and more by no more than a hundredth; nodes of cells that keep little are loose. Chosen.
constexpr double kLeastKept = 1.0 / 3.0, kMostKept = 2.0;

// How far the place of a wall's strain is off where it bends along t, as a part of what it would be
// in the cells' middles: 2 sum of t_a^2 n_a^2. This is the greatest over all t along the wall, of
// normal n.
double obliqueness(const Vec3& facing) {
  const double squares = 4.0 * facing.sum();
  const double rest = squares * squares - 48.0 * std::sqrt(facing.prod());
  return std::min(1.0, 0.5 * (squares + std::sqrt(std::max(0.0, rest))));
}

// The same of the direction along the wall that is nearest to the axis.
double obliquenessAlong(const Vec3& facing, Eigen::Index axis) {
  const double one = facing[(axis + 1) % 3], other = facing[(axis + 2) % 3], both = one + other;
  return both > 0.0 ? 2.0 * (both + (one * one + other * other) / both) : 0.0;
}

class ModuliMover {
 public:
  ModuliMover(const FilledGrid& tissue, const CellCompositions& compositions)
      : tissue_(tissue), kind_of_(tissue.filled.size(), kNone) {
    std::size_t next = 0;
    for (std::size_t cell = 0; cell < kind_of_.size(); ++cell) {
      if (tissue.filled[cell] > 0.0) kind_of_[cell] = compositions.of_cell[next++];
    }
    int stride = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      stride_[axis] = stride;
      count_[axis] = tissue.grid.size()[axis] - 1;
      stride *= count_[axis];
      flow_[axis].assign(kind_of_.size(), 0.0);
    }
  }

  std::vector<double> run() {
    for (std::size_t i = 0; i < tissue_.partial.size(); ++i) {
      const double part = obliqueness(tissue_.facing[i]);
      if (!(part > 0.0)) continue;
      const auto& [cell, fill] = tissue_.partial[i];
      for (std::size_t axis = 0; axis < 3; ++axis) spread(cell, axis, fill, part);
    }
    limit();
    return factors();
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;

  // The cell so many further along the axis, if it is of the same material; else -1.
  int beside(int cell, std::size_t axis, int steps) const {
    const int along = cell / stride_[axis] % count_[axis] + steps;
    if (along < 0 || along >= count_[axis]) return -1;
    const int other = cell + steps * stride_[axis];
    return kind_of_[at(other)] == kind_of_[at(cell)] ? other : -1;
  }

  // From the cell to the next one, up (1) or down (-1) the axis.
  void move(int cell, std::size_t axis, int side, double amount) {
    if (side > 0) {
      flow_[axis][at(cell)] += amount;
    } else {
      flow_[axis][at(cell - stride_[axis])] -= amount;
    }
  }

  // By weights at the places -1, 0, 1 along the axis, or 0, 1, 2 where there is no cell on one
  // side, that have the mean place and square of what is in the cell.
  void spread(int cell, std::size_t axis, const CellFill& fill, double part) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double moved = part * fill.share, place = fill.centroid[a], square = fill.products(a, a);
    const bool has_up = beside(cell, axis, 1) >= 0, has_down = beside(cell, axis, -1) >= 0;
    for (const int side : {1, -1}) {
      const int other = beside(cell, axis, side);
      if (other < 0) continue;
      if (has_up && has_down) {
        move(cell, axis, side, 0.5 * moved * (square + side * place));
      } else {
        spreadInwards(cell, axis, side, moved * place * side, moved * square);
      }
      // A full cell does the same; between full ones that is nothing.
      if (tissue_.filled[at(other)] == 1.0) move(other, axis, -side, moved / 24.0);
    }
  }

  void spreadInwards(int cell, std::size_t axis, int side, double first, double second) {
    move(cell, axis, side, first);
    if (beside(cell, axis, 2 * side) < 0) return;
    const double back = 0.5 * (first - second);
    move(cell, axis, side, back);
    move(cell + 2 * side * stride_[axis], axis, -side, back);
  }

  template <typename Visit>
  void visitFlows(Visit visit) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t cell = 0; cell < kind_of_.size(); ++cell) {
        double& flow = flow_[axis][cell];
        if (flow == 0.0) continue;
        const std::size_t next = cell + at(stride_[axis]);
        if (flow > 0.0) visit(cell, next, flow);
        if (flow < 0.0) visit(next, cell, flow);
      }
    }
  }

  void limit() {
    std::vector<double> out(kind_of_.size(), 0.0), in(kind_of_.size(), 0.0);
    visitFlows([&](std::size_t from, std::size_t to, double flow) {
      out[from] += std::abs(flow);
      in[to] += std::abs(flow);
    });
    visitFlows([&](std::size_t from, std::size_t to, double& flow) {
      const double give = (1.0 - kLeastKept) * tissue_.filled[from] / out[from];
      const double take = (kMostKept - 1.0) * tissue_.filled[to] / in[to];
      flow *= std::min({1.0, give, take});
    });
  }

  std::vector<double> factors() {
    std::vector<double> change(kind_of_.size(), 0.0), factors;
    visitFlows([&](std::size_t from, std::size_t to, double flow) {
      change[from] -= std::abs(flow);
      change[to] += std::abs(flow);
    });
    for (std::size_t cell = 0; cell < change.size(); ++cell) {
      const double filled = tissue_.filled[cell];
      if (filled > 0.0) factors.push_back(1.0 + change[cell] / filled);
    }
    return factors;
  }

  const FilledGrid& tissue_;
  std::vector<std::uint32_t> kind_of_;       // per cell of the grid: its composition
  std::array<int, 3> stride_{}, count_{};    // of cells
  std::array<std::vector<double>, 3> flow_;  // per axis and cell: to the next one up
};

}  // namespace

// Of what is moved too much for bending along an axis: by the moments alone a half, as the other
// half is for squares within cells, which their own bending has along that axis; less, as outer
// cells keep less. At a half, walls of 2.5 spacings are 2 to 4 % too stiff along that axis.
constexpr double kTakenBack = 1.0 / 3.0;

Vec3 strainPlaces(const Vec3& facing) {
  const double moved = obliqueness(facing);
  Vec3 places;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    places[axis] = std::min(1.0, 1.0 - kTakenBack * (moved - obliquenessAlong(facing, axis)));
  }
  return places;
}

std::vector<double> moduliFactors(const FilledGrid& tissue, const CellCompositions& compositions) {
  const bool is_oblique = std::any_of(tissue.facing.begin(), tissue.facing.end(),
                                      [](const Vec3& facing) { return !facing.isZero(0.0); });
  if (!is_oblique) return {};
  return ModuliMover(tissue, compositions).run();
}

}  // namespace robot_tissue
