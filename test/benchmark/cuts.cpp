// How bars and blocks of model elastic answer once they are cut: the tables of doc/model.md,
// "Cuts".
#include <cstdio>

#include "../core/elastic_fixtures.h"
#include "cutting/cut.h"
#include "robot_tissue/core/surface.h"
#include "tissue/front_ties.h"

using namespace robot_tissue;

namespace {

constexpr double kFar = 1.0;
constexpr double kNu = 0.45;

void cut(ElasticBlock& block, const std::vector<Vec3>& corners, SplitCells split) {
  const BladeSurface blade = BladeSurface::of(corners, block.lattice.spacing());
  sever(block.lattice, springsAcross(block.lattice, block.state, corners), blade, block.state,
        split);
}

const char* nameOf(SplitCells split) { return split == SplitCells::kParted ? "ghosts" : "lost"; }

// 300 mm long, 20 mm wide, clamped at x = 0, under its weight.
TissueConfig bar(int cells_high, double spacing, double nu) {
  const auto along = [&](double length) { return static_cast<int>(std::round(length / spacing)); };
  TissueConfig config = blockOf(along(0.3), along(0.02), cells_high, spacing);
  config.model = "elastic";
  config.material.poisson_ratio = nu;
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, along(0.02), cells_high}));
  config.gravity = Vec3(0.0, 0.0, -0.02);
  return config;
}

// Of the middle of the lower edge at the free end (m).
double deflection(ElasticBlock& block) {
  if (block.solve({}).status != SolveStatus::kOk) std::printf("NOT OK: ");
  const auto& size = block.lattice.size();
  const int node = block.lattice.node(size[0] - 1, size[1] / 2, 0);
  return -block.state.displacement[at(node)].z();
}

void bendBar(int cells_high, double nu) {
  constexpr double kSpacing = 0.01;
  ElasticBlock whole(bar(cells_high, kSpacing, nu));
  ElasticBlock fine(bar(2 * cells_high, 0.5 * kSpacing, nu));
  ElasticBlock fine_half(bar(cells_high, 0.5 * kSpacing, nu));
  const double uncut = deflection(whole), half = deflection(fine_half);
  std::printf("bar, %d cells high, nu %g; fine half / fine whole %.4f\n", cells_high, nu,
              half / deflection(fine));
  for (const SplitCells split : {SplitCells::kParted, SplitCells::kLost}) {
    ElasticBlock parted(bar(cells_high, kSpacing, nu));
    const double z = 0.5 * cells_high * kSpacing;
    cut(parted, {{-kFar, -kFar, z}, {kFar, -kFar, z}, {kFar, kFar, z}, {-kFar, kFar, z}}, split);
    const double moved = deflection(parted);
    std::printf("  %-6s / uncut %.4f, / fine half %.4f\n", nameOf(split), moved / uncut,
                moved / half);
  }
}

// Between the banks at the upper surface, on the line of symmetry (m).
double mouthOf(const ElasticBlock& block, double x) {
  const TissueSurface surface = extractSurface(block.lattice, block.state);
  std::vector<Vec3> vertices;
  deform(surface, block.state.displacement, vertices);
  double leftmost = kFar, rightmost = -kFar;
  for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
    if ((surface.rest[vertex] - Vec3(x, 0.01, 0.05)).norm() > 1e-6) continue;
    leftmost = std::min(leftmost, vertices[vertex].x());
    rightmost = std::max(rightmost, vertices[vertex].x());
  }
  return rightmost - leftmost;
}

// 110 x 20 x 50 mm, fixed at x = 0, cut in the middle 20 mm deep, then stretched by 5 %.
void stretchNotched(int cells_per_10_mm) {
  const int n = cells_per_10_mm;
  TissueConfig config = blockOf(11 * n, 2 * n, 5 * n, 0.01 / n);
  config.model = "elastic";
  config.material.poisson_ratio = kNu;
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, 2 * n, 5 * n}));
  const Box end = nodeBox(config, {11 * n, 0, 0}, {11 * n, 2 * n, 5 * n});
  const auto stretch = [&](ElasticBlock& block) {
    LoadingPatch ties;
    ties.contacts = tiesOfFronts(block.lattice, block.state, block.model);
    const auto report =
        block.solve({displaced(block.lattice.nodesIn(end), Vec3(0.0055, 0, 0)), ties});
    if (report.status != SolveStatus::kOk) std::printf("NOT OK: ");
    return report.patches[0].force.x();
  };
  ElasticBlock whole(config);
  std::printf("notch, h %.2f mm: uncut %.4f N\n", 10.0 / n, stretch(whole));
  for (const SplitCells split : {SplitCells::kParted, SplitCells::kLost}) {
    constexpr double kX = 0.055, kEnd = 0.0295;
    ElasticBlock notched(config);
    cut(notched, {{kX, -kFar, kEnd}, {kX, kFar, kEnd}, {kX, kFar, kFar}, {kX, -kFar, kFar}}, split);
    const double force = stretch(notched);
    std::printf("  %-6s %.4f N, mouth %.3f mm\n", nameOf(split), force, 1e3 * mouthOf(notched, kX));
  }
}

}  // namespace

int main() {
  for (const double nu : {0.3, 0.45}) {
    for (const int cells_high : {5, 9}) bendBar(cells_high, nu);
  }
  for (const int n : {1, 3, 5}) stretchNotched(n);
}
