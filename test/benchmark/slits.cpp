// Cuts against finer lattices of one's own and against beams, all with method newton: the tables of
// doc/accuracy.md, "Cuts". Forces and shapes are compared as ratios to the uncut block on the same
// lattice, so that what the loads' edges do to a lattice falls out.
//
//   slits [FINER]   (times finer than h = 5 mm: 3)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "../core/elastic_fixtures.h"
#include "cutting/cut.h"
#include "loads/patch_rim.h"
#include "tissue/front_ties.h"

using namespace robot_tissue;

namespace {

constexpr double kFar = 1.0;
constexpr double kSpacing = 0.005;

// Where the blade passes, with its front or ended at the last springs severed, or half way between
// nodes, as a tear.
enum class Parting { kAtBlade, kClosed, kHalfWay };

const char* nameOf(Parting parting) {
  if (parting == Parting::kHalfWay) return "half way";
  return parting == Parting::kAtBlade ? "at the blade" : "at the blade, closed";
}

void cut(ElasticBlock& block, const std::vector<Vec3>& corners,
         Parting parting = Parting::kAtBlade) {
  std::vector<Crossing> crossings = springsAcross(block.lattice, block.state, corners);
  if (parting == Parting::kHalfWay) {
    for (Crossing& crossing : crossings) crossing.along = 0.5;
  }
  const SplitCells split = block.model.splitCells();
  if (parting == Parting::kAtBlade) {
    const BladeSurface blade = BladeSurface::of(corners, block.lattice.spacing());
    sever(block.lattice, crossings, blade, block.state, split);
  } else {
    sever(block.lattice, crossings, block.state, split);
  }
}

double solveFor(ElasticBlock& block, std::vector<LoadingPatch> patches, int axis) {
  const bool is_loaded = !patches.empty();
  LoadingPatch ties;
  ties.contacts = tiesOfFronts(block.lattice, block.state, block.model);
  if (!ties.contacts.empty()) patches.push_back(ties);
  const SolveReport report = block.solve(patches);
  if (report.status != SolveStatus::kOk) std::printf("NOT OK: ");
  return is_loaded ? report.patches[0].force[axis] : 0.0;
}

// Of a cantilever under its own weight at its end, over Timoshenko's (shear coefficient 5/6).
void bendHalf(int cells_in_half, double nu) {
  constexpr double kLength = 0.3, kWidth = 0.02, kBar = 0.01;
  const int high = cells_in_half, all = 2 * high + 1;
  const auto along = [&](double length) { return static_cast<int>(std::round(length / kBar)); };
  TissueConfig config = blockOf(along(kLength), along(kWidth), all, kBar);
  config.model = "elastic";
  config.material.poisson_ratio = nu;
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, along(kWidth), all}));
  config.gravity = Vec3(0.0, 0.0, -0.002);
  ElasticBlock bar(config);
  const double half = (high + 0.5) * kBar;
  cut(bar, {{-kFar, -kFar, half}, {kFar, -kFar, half}, {kFar, kFar, half}, {-kFar, kFar, half}});
  solveFor(bar, {}, 2);
  const auto& size = bar.lattice.size();
  const double moved =
      -bar.state.displacement[at(bar.lattice.node(size[0] - 1, size[1] / 2, 0))].z();
  const double e = config.material.young_modulus, shear = e / (2.0 * (1.0 + nu));
  const double load = config.material.density * 0.002;  // N/m^3
  const double bending = 1.5 * load * std::pow(kLength, 4) / (e * half * half);
  const double shearing = 0.6 * load * kLength * kLength / shear;
  std::printf("half bar of %.1f cells, nu %.2f: %.3f of theory\n", half / kBar, nu,
              moved / (bending + shearing));
}

// 60 x 20 x 40 mm, cut at x from above, 20 mm deep.
struct Slit {
  double x = 0.0;
  double nu = 0.25;
  bool is_cut = true;
  Parting parting = Parting::kAtBlade;
};

TissueConfig blockFor(const Slit& slit, int finer) {
  TissueConfig config = blockOf(12 * finer, 4 * finer, 8 * finer, kSpacing / finer);
  config.model = "elastic";
  config.material.poisson_ratio = slit.nu;
  return config;
}

void cutSlit(const Slit& slit, ElasticBlock& block) {
  if (!slit.is_cut) return;
  constexpr double kEnd = 0.02;  // a plane of nodes: there the cut is closed
  const double x = slit.x;
  cut(block, {{x, -kFar, kEnd}, {x, kFar, kEnd}, {x, kFar, kFar}, {x, -kFar, kFar}}, slit.parting);
}

struct Answer {
  double force = 0.0;
  std::vector<Vec3> shape;  // of the nodes of h = 5 mm, m
};

std::vector<Vec3> coarseNodesOf(const ElasticBlock& block, int finer) {
  std::vector<Vec3> shape;
  for (int node = 0; node < block.lattice.nodeCount(); ++node) {
    const auto index = block.lattice.gridIndex(node);
    const bool is_coarse =
        std::all_of(index.begin(), index.end(), [&](int i) { return i % finer == 0; });
    if (is_coarse) shape.push_back(block.state.displacement[at(node)]);
  }
  return shape;
}

// Held at x = 0, drawn by 1 % at the other end.
Answer drawn(const Slit& slit, int finer) {
  TissueConfig config = blockFor(slit, finer);
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, 4 * finer, 8 * finer}));
  ElasticBlock block(config);
  cutSlit(slit, block);
  const Box end = nodeBox(config, {12 * finer, 0, 0}, {12 * finer, 4 * finer, 8 * finer});
  const double force =
      solveFor(block, {displaced(block.lattice.nodesIn(end), Vec3(0.0006, 0, 0))}, 0);
  return {force, coarseNodesOf(block, finer)};
}

// Held below, a lip pushed sidewards away from the slit by 0.5 mm, by the outer 10 mm of its upper
// face: with rims, as what a line of nodes, or an edge without them, meets hangs on the lattice.
Answer pushed(const Slit& slit, int finer, bool is_right) {
  TissueConfig config = blockFor(slit, finer);
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {12 * finer, 4 * finer, 0}));
  ElasticBlock block(config);
  cutSlit(slit, block);
  const int from = (is_right ? 10 : 0) * finer, to = from + 2 * finer;
  const Box strip = nodeBox(config, {from, 0, 8 * finer}, {to, 4 * finer, 8 * finer});
  const Vec3 way(is_right ? 0.0005 : -0.0005, 0.0, 0.0);
  LoadingPatch patch = displaced(block.lattice.nodesIn(strip), way);
  patch.rim = rimOf(block.lattice, block.model, block.state, strip, patch.nodes);
  for (RimSpring& spring : patch.rim) spring.anchor = way;
  const double force = solveFor(block, {patch}, 0);
  return {std::abs(force), coarseNodesOf(block, finer)};
}

double apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double difference = 0.0, all = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += (a[i] - b[i]).squaredNorm();
    all += b[i].squaredNorm();
  }
  return std::sqrt(difference / all);
}

struct Cut {
  Slit slit;
  Answer drawn;
  double drawn_uncut = 0.0, left = 0.0, right = 0.0;  // lips over the uncut block

  Cut(const Slit& of, int finer) : slit(of) {
    Slit whole = of;
    whole.is_cut = false;
    drawn = ::drawn(slit, finer);
    drawn_uncut = drawn.force / ::drawn(whole, finer).force;
    left = pushed(slit, finer, false).force / pushed(whole, finer, false).force;
    right = pushed(slit, finer, true).force / pushed(whole, finer, true).force;
  }
};

double percentOff(double value, double reference) { return 100.0 * (value / reference - 1.0); }

void compare(double offset, double nu, int finer) {
  Slit slit;
  slit.x = 0.03 + offset * kSpacing;
  slit.nu = nu;
  const Cut fine(slit, finer);
  for (const Parting parting : {Parting::kAtBlade, Parting::kClosed, Parting::kHalfWay}) {
    slit.parting = parting;
    const Cut coarse(slit, 1);
    std::printf("| %.2f | %.2f | %s | %+.1f | %.1f | %+.1f, %+.1f | %.4f |\n", offset, nu,
                nameOf(parting), percentOff(coarse.drawn_uncut, fine.drawn_uncut),
                100.0 * apart(coarse.drawn.shape, fine.drawn.shape),
                percentOff(coarse.left, fine.left), percentOff(coarse.right, fine.right),
                coarse.right / coarse.left);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int finer = argc > 1 ? std::atoi(argv[1]) : 3;
  for (const double nu : {0.3, 0.45}) {
    for (const int cells : {1, 2, 4}) bendHalf(cells, nu);
  }
  std::printf(
      "| off nodes (h) | nu | parted | drawn: force, %% | field, %% | lips: left, right, %% | "
      "right / left |\n");
  for (const double nu : {0.25, 0.45, 0.49}) {
    for (const double offset : {0.0, 0.25, 0.5}) compare(offset, nu, finer);
  }
  return 0;
}
