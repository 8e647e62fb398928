// Where the front of a cut that ends inside a block seems to be, wherever it stands between nodes:
// the table of doc/accuracy.md, "Where a cut ends". A block of 60 x 10 x 40 mm is cut from above
// and drawn apart; its force and the opening of its mouth are those of a cut of a depth in lattices
// of h/2 and h/4, whose fronts are on nodes. By method newton.
//
// `tied` is what cuts are, `closed` one that ends at the last springs it severed.
//   crack_front [RATIO ...]   (Poisson's; 0.25, 0.45 and 0.49)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "../core/elastic_fixtures.h"
#include "cutting/cut.h"
#include "tissue/front_ties.h"

using namespace robot_tissue;

namespace {

constexpr double kFar = 1.0;
constexpr double kSpacing = 0.005;
constexpr std::array<int, 3> kCells = {12, 2, 8};  // of h

struct Crack {
  double x;      // h
  double depth;  // h
  double nu;
  bool is_tied;
};

struct Answer {
  double force, opening;
};

void cutTo(ElasticBlock& block, double x, double z, bool is_tied) {
  const std::vector<Vec3> corners = {
      {x, -kFar, z}, {x, kFar, z}, {x, kFar, kFar}, {x, -kFar, kFar}};
  const std::vector<Crossing> crossings = springsAcross(block.lattice, block.state, corners);
  const SplitCells split = block.model.splitCells();
  if (is_tied) {
    const BladeSurface blade = BladeSurface::of(corners, block.lattice.spacing());
    sever(block.lattice, crossings, blade, block.state, split);
  } else {
    sever(block.lattice, crossings, block.state, split);
  }
}

Answer solve(const Crack& crack, int finer, bool is_cut = true) {
  const std::array<int, 3> n = {kCells[0] * finer, kCells[1] * finer, kCells[2] * finer};
  const double h = kSpacing / finer;
  TissueConfig config = blockOf(n[0], n[1], n[2], h);
  config.model = "elastic";
  config.material.poisson_ratio = crack.nu;
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, n[1], n[2]}));
  ElasticBlock block(config);
  std::vector<LoadingPatch> patches = {
      displaced(block.lattice.nodesIn(nodeBox(config, {n[0], 0, 0}, n)), Vec3(0.0006, 0, 0))};
  const double x = crack.x * finer, end = n[2] - crack.depth * finer;  // spacings
  if (is_cut) cutTo(block, x * h, end * h, crack.is_tied);
  LoadingPatch ties;
  ties.contacts = tiesOfFronts(block.lattice, block.state, block.model);
  if (!ties.contacts.empty()) patches.push_back(ties);
  const SolveReport report = block.solve(patches);
  if (report.status != SolveStatus::kOk) std::printf("NOT OK: ");
  const auto moved = [&](double place) {
    const int node =
        block.lattice.node(static_cast<int>(std::round(place * finer)), n[1] / 2, n[2]);
    return block.state.displacement[at(node)].x();
  };
  return {report.patches[0].force.x(), moved(8.0) - moved(4.0)};
}

// How deep a cut of the table is that answers so (h); depths step evenly from `first`.
double depthFor(double value, const std::vector<double>& table, double first, double step) {
  std::size_t i = 0;
  while (i + 2 < table.size() && (value - table[i + 1]) * (table[1] - table[0]) > 0.0) ++i;
  return first + step * (static_cast<double>(i) + (value - table[i]) / (table[i + 1] - table[i]));
}

struct Reference {
  std::vector<double> force, opening;  // of depths from 1 on by 1/4
};

Reference referenceFor(double x, double nu, int finer) {
  Reference reference;
  const double uncut = solve({x, 0.0, nu, false}, finer, false).force;
  for (int quarter = 4; quarter <= 16; quarter += 4 / finer) {
    const Answer answer = solve({x, 0.25 * quarter, nu, false}, finer);
    reference.force.push_back(answer.force / uncut);
    reference.opening.push_back(answer.opening);
  }
  return reference;
}

void compare(double x, double nu) {
  const Reference half = referenceFor(x, nu, 2), quarter = referenceFor(x, nu, 4);
  // How much the fronts of both references are off falls with their spacing.
  const auto trueDepth = [](double value, const std::vector<double>& by_half,
                            const std::vector<double>& by_quarter) {
    const double coarse = depthFor(value, by_half, 1.0, 0.5);
    const double fine = depthFor(value, by_quarter, 1.0, 0.25);
    return 2.0 * fine - coarse;
  };
  for (const bool is_tied : {false, true}) {
    for (const double beyond : {0.0, 0.25, 0.5, 0.75, 0.9}) {
      const Crack crack = {x, 2.0 + beyond, nu, is_tied};
      const Answer answer = solve(crack, 1);
      const double uncut = solve(crack, 1, false).force;
      std::printf("%.2f,%.2f,%.2f,%s,%+.3f,%+.3f\n", x - 6.0, nu, beyond,
                  is_tied ? "tied" : "closed",
                  crack.depth - trueDepth(answer.force / uncut, half.force, quarter.force),
                  crack.depth - trueDepth(answer.opening, half.opening, quarter.opening));
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<double> ratios = {0.25, 0.45, 0.49};
  if (argc > 1) ratios.clear();
  for (int i = 1; i < argc; ++i) ratios.push_back(std::atof(argv[i]));
  std::printf("off_nodes_h,nu,front_beyond_nodes_h,cure,short_by_force_h,short_by_opening_h\n");
  for (const double nu : ratios) {
    for (const double x : {6.0, 6.5}) compare(x, nu);
  }
}
