#include "cutting/tear.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "config/material.h"
#include "cutting/cell_division.h"
#include "cutting/crumbs.h"
#include "cutting/cut.h"

namespace robot_tissue {
namespace {

// Of the strain that a spring bears (1): less over it is rounding.
constexpr double kOver = 1e-6;
// Of the greatest (1): strains over what springs bear that count as one. More: fewer solves, but
// springs go that the first ones would have relieved; less: the front of a crack, along which the
// strain differs by some hundredths, goes in more rounds. Chosen.
constexpr double kNearlyAsFar = 0.05;
// Of its strain (1): what a spring bears in line with a severed one. The crack's front is beside
// it, and lengthens it nearly as much as the next one on its way. More: cracks widen; less: threads
// of tissue hold on. Chosen.
constexpr double kShielded = 0.5;
constexpr double kEqual = 1e-9;  // likewise; rounding

class Strains {
 public:
  Strains(const Lattice& lattice, const LatticeState& state) : lattice_(lattice), state_(state) {
    strains_.assign(state.severed.size(), 0.0);
    const double spacing = lattice.spacing();
    for (int node = 0; node < lattice.nodeCount(); ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        const int spring = lattice.springOf(node, 2 * axis + 1);
        if (spring < 0) continue;
        const int other = lattice.neighbor(node, 2 * axis + 1);
        const Vec3 way = spacing * Vec3::Unit(axis) + state.displacement[at(other)] -
                         state.displacement[at(node)];
        strains_[at(spring)] = way.norm() / spacing - 1.0;
      }
    }
  }

  // What the spring bears: its own strain; at the front of a crack the mean of it and that of a
  // severed spring beside it whose ends the cells between them still hold together; elsewhere in
  // line with a severed spring less, as the crack goes on beside it.
  double borneBy(int spring) const {
    const double own = strains_[at(spring)];
    const Spring here = lattice_.springs()[at(spring)];
    bool at_front = false;
    double borne = own;
    for (const int across : {(here.axis + 1) % 3, (here.axis + 2) % 3}) {
      for (const int side : {-1, 1}) {
        const int beside = springBeside(here, across, side);
        if (beside < 0 || state_.severed[at(beside)] == 0) continue;
        if (!isHeldBetween(here, across, side)) continue;
        at_front = true;
        borne = std::max(borne, 0.5 * (own + strains_[at(beside)]));
      }
    }
    return !at_front && isInLineWithSevered(here) ? kShielded * own : borne;
  }

 private:
  bool isInLineWithSevered(const Spring& spring) const {
    const int before = lattice_.springOf(spring.a, 2 * spring.axis);
    const int behind = lattice_.springOf(spring.b, 2 * spring.axis + 1);
    return (before >= 0 && state_.severed[at(before)] != 0) ||
           (behind >= 0 && state_.severed[at(behind)] != 0);
  }

  int springBeside(const Spring& spring, int across, int side) const {
    const int node = lattice_.neighbor(spring.a, 2 * across + (side > 0 ? 1 : 0));
    return node < 0 ? -1 : lattice_.springOf(node, 2 * spring.axis + 1);
  }

  // Whether a cell that has the spring and the one beside it has both ends of the latter in a part.
  bool isHeldBetween(const Spring& spring, int across, int side) const {
    const int along = 3 - spring.axis - across;
    for (const int back : {0, 1}) {
      std::array<int, 3> index = lattice_.gridIndex(spring.a);
      if (side < 0) --index[at(across)];
      index[at(along)] -= back;
      const int cell = lattice_.cellAt(index);
      if (cell < 0) continue;
      const int corner = (side > 0 ? 1 << across : 0) | back << along;
      const int place = lattice_.cells()[at(cell)].place;
      const Cell* part = state_.cells->owner(place, corner);
      if (part != nullptr && part->owns(corner | 1 << spring.axis)) return true;
    }
    return false;
  }

  const Lattice& lattice_;
  const LatticeState& state_;
  std::vector<double> strains_;
};

// What each spring bears over what it may (1); 0 where it never tears or is severed.
std::vector<double> loadsOf(const Lattice& lattice, const LatticeState& state,
                            const std::vector<double>& tear_strains) {
  const Strains strains(lattice, state);
  std::vector<double> loads(tear_strains.size(), 0.0);
  for (std::size_t spring = 0; spring < loads.size(); ++spring) {
    if (state.severed[spring] != 0 || tear_strains[spring] <= 0.0) continue;
    loads[spring] = strains.borneBy(static_cast<int>(spring)) / tear_strains[spring];
  }
  return loads;
}

// Of the tissue in the cells around the spring, what is the region's (1).
double shareAround(const Lattice& lattice, const Spring& spring, int region) {
  double all = 0.0, of_region = 0.0;
  for (const int number : cellsAround(lattice, spring)) {
    if (number < 0) continue;
    const Cell& cell = lattice.cells()[at(number)];
    all += cell.share();
    for (const MaterialShare& part : lattice.compositions()[lattice.compositionOf(cell)]) {
      if (part.region == region) of_region += part.share * cell.share();
    }
  }
  return of_region / all;
}

// Of the last region that holds the spring's middle; one of a mesh holds it with half of the tissue
// around.
const Material& materialAt(const Lattice& lattice, const TissueConfig& config,
                           const Spring& spring) {
  const Vec3 middle =
      lattice.restPosition(spring.a) + 0.5 * lattice.spacing() * Vec3::Unit(spring.axis);
  for (int region = static_cast<int>(config.regions.size()) - 1; region >= 0; --region) {
    const Region& here = config.regions[at(region)];
    const bool holds = here.mesh ? shareAround(lattice, spring, region) >= 0.5
                                 : contains(here, middle, lattice.spacing());
    if (holds) return here.material;
  }
  return config.material;
}

}  // namespace

double tearStrain(const Material& material, double spacing) {
  if (material.tear_stretch <= 0.0) return 0.0;
  const double strain = material.tear_stretch - 1.0;
  return material.tear_length > 0.0 ? strain * std::sqrt(material.tear_length / spacing) : strain;
}

std::vector<double> tearStrains(const Lattice& lattice, const TissueConfig& config) {
  const auto tears = [](const Material& material) { return material.tear_stretch > 0.0; };
  const bool any = tears(config.material) ||
                   std::any_of(config.regions.begin(), config.regions.end(),
                               [&](const Region& region) { return tears(region.material); });
  std::vector<double> strains;
  if (!any) return strains;
  for (const Spring spring : lattice.springs()) {
    strains.push_back(tearStrain(materialAt(lattice, config, spring), lattice.spacing()));
  }
  return strains;
}

std::vector<int> weakestSprings(const Lattice& lattice, const LatticeState& state,
                                const std::vector<double>& tear_strains) {
  const std::vector<double> loads = loadsOf(lattice, state, tear_strains);
  const auto greatest = std::max_element(loads.begin(), loads.end());
  if (greatest == loads.end() || !(*greatest > 1.0 + kOver)) return {};
  const double least = std::max(1.0 + kOver, (1.0 - kNearlyAsFar) * *greatest);
  const auto first = std::find_if(loads.begin(), loads.end(),
                                  [&](double load) { return load >= (1.0 - kEqual) * *greatest; });
  std::vector<int> batch = {static_cast<int>(first - loads.begin())};
  std::unordered_set<int> taken(batch.begin(), batch.end());
  for (std::size_t next = 0; next < batch.size(); ++next) {
    const Spring spring = lattice.springs()[at(batch[next])];
    const std::size_t u = at((spring.axis + 1) % 3), v = at((spring.axis + 2) % 3);
    for (int beside = 0; beside < 9; ++beside) {
      std::array<int, 3> index = lattice.gridIndex(spring.a);
      index[u] += beside % 3 - 1;
      index[v] += beside / 3 - 1;
      const int node = lattice.node(index[0], index[1], index[2]);
      const int other = node < 0 ? -1 : lattice.springOf(node, 2 * spring.axis + 1);
      if (other < 0 || !(loads[at(other)] >= least)) continue;
      if (taken.insert(other).second) batch.push_back(other);
    }
  }
  std::sort(batch.begin(), batch.end());
  return batch;
}

std::vector<Crossing> tearingNext(const Lattice& lattice, const LatticeState& state,
                                  const std::vector<double>& tear_strains) {
  std::vector<int> weakest = weakestSprings(lattice, state, tear_strains);
  std::vector<Crossing> torn = sparingCrumbs(lattice, state, halfWay(weakest));
  if (torn.empty() == weakest.empty()) return torn;
  std::vector<double> strains = tear_strains;
  while (torn.empty() && !weakest.empty()) {
    for (const int spring : weakest) strains[at(spring)] = 0.0;
    weakest = weakestSprings(lattice, state, strains);
    torn = sparingCrumbs(lattice, state, halfWay(weakest));
  }
  return torn;
}

}  // namespace robot_tissue
