#include "tissue/pressed_surfaces.h"

#include <algorithm>

#include "loads/point_loads.h"
#include "surface/mean_curvature.h"
#include "surface/nearest_point.h"

namespace robot_tissue {
namespace {

// Spacings: so far around a touch the tissue's curvature is looked at. More: smoother; less: small
// bumps count. Chosen.
constexpr double kSeenAround = 2.0;

// Spacings: so far around a touch its way inwards is looked at, wider than dents of narrow
// contacts. Chosen.
constexpr double kWiderThanDents = 3.0;

// A node with four cells, none of which is filled, or left by cuts, in part alone.
bool isInFlatSurface(const CellSet& cells, int node) {
  if (cells.isGhost(node)) return false;
  int whole = 0;
  for (const CellSet::Meeting& met : cells.meetings(node)) {
    if (cells.all()[at(met.cell)].share() < 1.0) return false;
    ++whole;
  }
  return whole == 4;
}

// Whether the full cells beside and below the node are all of the same: a ball feels a layer that
// begins a spacing below it otherwise than a half-space.
bool isUniformAround(const CellSet& cells, const TissueModel& model, int node) {
  std::optional<Moduli> all;
  const auto is_other = [&](const Cell& cell) {
    if (cell.share() < 1.0) return false;
    const Moduli moduli = model.moduliIn(cell);
    if (!all) all = moduli;
    return moduli.shear != all->shear || moduli.bulk != all->bulk;
  };
  for (const CellSet::Meeting& met : cells.meetings(node)) {
    for (const int corner : cells.all()[at(met.cell)].nodes) {
      for (const CellSet::Meeting& beside : cells.meetings(corner)) {
        if (is_other(cells.all()[at(beside.cell)])) return false;
      }
    }
  }
  return true;
}

// Of 1 N that nodes of a flat surface share (m/N).
double flatCompliance(const std::vector<NodeWeight>& shares, const Lattice& lattice,
                      const SurfaceModuli& moduli) {
  const double spacing = lattice.spacing();
  double sum = 0.0;
  for (const NodeWeight& one : shares) {
    const Vec3 place = lattice.restPosition(one.node);
    for (const NodeWeight& other : shares) {
      const double squared = (lattice.restPosition(other.node) - place).squaredNorm();
      sum += one.weight * other.weight *
             pointCompliance(moduli.poisson_ratio, squared / (spacing * spacing));
    }
  }
  return sum / (moduli.shear * spacing);
}

}  // namespace

std::optional<PressedSurface> PressedSurfaces::under(const NarrowPress& press, const Body& body,
                                                     const ElasticModel& model,
                                                     const std::vector<LoadingPatch>& patches) {
  const std::vector<NodeWeight>& shares = press.shares;
  const CellSet& cells = body.cells();
  if (shares.empty()) return std::nullopt;
  const auto moduli = LocalLattice::moduliUnder(shares, cells, model);
  PressedSurface surface;
  surface.spacing = body.lattice().spacing();
  if (!moduli) return std::nullopt;
  surface.moduli = *moduli;
  const auto is_flat = [&](const NodeWeight& share) {
    return isInFlatSurface(cells, share.node) && !axesHeldBy(patches, share.node) &&
           !isFixed(body.lattice(), cells, share.node);
  };
  const auto is_uniform = [&](const NodeWeight& share) {
    return isUniformAround(cells, model, share.node);
  };
  const bool all_flat = std::all_of(shares.begin(), shares.end(), is_flat);
  if (!all_flat) surface.curvature = curvatureAround(press.place, press.middle, body);
  if (!isNarrow(press, surface)) return std::nullopt;
  if (!all_flat) {
    return look(press, body, model, patches, surface) ? std::optional<PressedSurface>(surface)
                                                      : std::nullopt;
  }
  if (!std::all_of(shares.begin(), shares.end(), is_uniform)) return std::nullopt;
  surface.compliance = flatCompliance(shares, body.lattice(), *moduli);
  return surface;
}

// What is told hangs on the force alone, not on the ones before.
LocalLattice& PressedSurfaces::around(const NarrowPress& press, const Body& body) {
  const auto known = std::find_if(around_.begin(), around_.end(), [&](const LocalLattice& one) {
    return one.isAround(press.shares, body.state());
  });
  if (known != around_.end()) return *known;
  LocalLattice& other = around_[oldest_];
  oldest_ = (oldest_ + 1) % around_.size();
  return other;
}

bool PressedSurfaces::look(const NarrowPress& press, const Body& body, const ElasticModel& model,
                           const std::vector<LoadingPatch>& patches, PressedSurface& surface) {
  if (model.hasMembranes()) return false;
  const LatticeState& state = body.state();
  const Lattice& lattice = body.lattice();
  LocalLattice& here = around(press, body);
  if (!here.take(press.shares, press.axis, surface.moduli, patches, lattice, state, model) ||
      !here.isDeep(lattice)) {
    return false;
  }
  surface.compliance = here.compliance(press.shares);
  return surface.compliance > 0.0;  // else all of it is on what stands, or moves in one piece
}

double PressedSurfaces::curvatureAround(const SurfacePoint& point, const Vec3& middle,
                                        const Body& body) {
  const double reach = kSeenAround * body.lattice().spacing();
  const std::vector<Vec3>& rest = body.surface().rest;
  parts_.take(body.surface());
  const SmoothPart part = parts_.around(point, middle, reach);
  const Vec3 inwards = inwardsAroundDent(body.surface(), rest, part);
  return inwards.isZero(0.0) ? 0.0 : meanCurvature(rest, part.vertices, middle, -inwards, reach);
}

Vec3 PressedSurfaces::inwardsAround(const SurfacePoint& point, const Vec3& middle,
                                    const Body& body) {
  const double reach = kWiderThanDents * body.lattice().spacing();
  parts_.take(body.surface());
  const SmoothPart part = parts_.around(point, middle, reach);
  return inwardsAroundDent(body.surface(), body.vertices(), part);
}

}  // namespace robot_tissue
