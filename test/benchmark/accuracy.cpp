// Compares model `elastic` with the finite-element reference in test/data/reference. Prints CSV;
// doc/model.md reads it. Not a test: nothing here passes or fails.
//
//   accuracy FOLDER [SPACING ...]    spacings in m, 0.01 and 0.005 when none is given
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "robot_tissue/core/tissue.h"

namespace robot_tissue {
namespace {

constexpr int kReferenceNodes[3] = {21, 21, 11};
constexpr double kReferenceSpacing = 0.005;  // m
constexpr double kReferenceUnit = 1e-8;      // m
const Vec3 kExtent(0.10, 0.10, 0.05);

struct Case {
  std::string name;
  std::string poisson_ratio;
  std::array<std::optional<double>, 3> displacement;
  double force = 0.0;  // N
  std::vector<Vec3> field;
};

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::ifstream openCsv(const std::string& path) {
  std::ifstream file(path);
  std::string header;
  if (!std::getline(file, header)) throw std::runtime_error(path + ": cannot be read");
  return file;
}

std::vector<Case> readCases(const std::string& folder) {
  std::vector<Case> cases;
  std::ifstream list = openCsv(folder + "/cases.csv");
  for (std::string line; std::getline(list, line);) {
    const std::vector<std::string> cells = cellsOf(line);
    Case one;
    one.name = cells.at(0);
    one.poisson_ratio = cells.at(1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string& cell = cells.at(2 + axis);
      if (cell != "free") one.displacement[axis] = std::stod(cell);
    }
    one.force = std::stod(cells.at(5));
    std::ifstream field =
        openCsv(folder + "/" + one.name + "_nu" + one.poisson_ratio.substr(2) + ".csv");
    for (std::string row; std::getline(field, row);) {
      const std::vector<std::string> u = cellsOf(row);
      one.field.push_back(kReferenceUnit *
                          Vec3(std::stod(u.at(0)), std::stod(u.at(1)), std::stod(u.at(2))));
    }
    cases.push_back(one);
  }
  return cases;
}

PatchConfig patchOf(const Case& one) {
  PatchConfig patch;
  patch.name = "punch";
  const bool whole_face = one.name == "uniaxial" || one.name == "shear";
  const double from = whole_face ? 0.0 : 0.04, to = whole_face ? 0.10 : 0.06;
  patch.box = {Vec3(from, from, kExtent.z()), Vec3(to, to, kExtent.z())};
  patch.displacement = one.displacement;
  return patch;
}

bool contains(const Box& box, const Vec3& point) {
  constexpr double kSlack = 1e-9;
  return ((point - box.min).array() > -kSlack).all() && ((box.max - point).array() > -kSlack).all();
}

// The lattice's displacement at a rest position, trilinear between the nodes.
Vec3 displacementAt(const Lattice& lattice, const std::vector<Vec3>& moved, const Vec3& rest) {
  std::array<int, 3> low{};
  Vec3 share;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = rest[axis] / lattice.spacing();
    low[at(axis)] = std::min(static_cast<int>(place + 1e-9), lattice.size()[at(axis)] - 2);
    share[axis] = place - low[at(axis)];
  }
  Vec3 displacement = Vec3::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::array<int, 3> index = low;
    for (int axis = 0; axis < 3; ++axis) {
      const int bit = corner >> axis & 1;
      index[at(axis)] += bit;
      weight *= bit != 0 ? share[axis] : 1.0 - share[axis];
    }
    displacement += weight * moved[at(lattice.node(index[0], index[1], index[2]))];
  }
  return displacement;
}

// Relative L2 over the reference's nodes; nodes in the patch count where the patch is.
double fieldError(const Case& one, const Tissue& tissue) {
  const PatchConfig patch = patchOf(one);
  const std::vector<Vec3> shown = tissue.shownDisplacement();
  double missed = 0.0, moved = 0.0;
  for (std::size_t node = 0; node < one.field.size(); ++node) {
    const int n = static_cast<int>(node);
    const int row = n / kReferenceNodes[0];
    const Vec3 rest = kReferenceSpacing * Vec3(n % kReferenceNodes[0], row % kReferenceNodes[1],
                                               row / kReferenceNodes[1]);
    Vec3 displacement = displacementAt(tissue.lattice(), shown, rest);
    for (int axis = 0; axis < 3 && contains(patch.box, rest); ++axis) {
      displacement[axis] = one.displacement[at(axis)].value_or(displacement[axis]);
    }
    missed += (displacement - one.field[node]).squaredNorm();
    moved += one.field[node].squaredNorm();
  }
  return std::sqrt(missed / moved);
}

void compare(const Case& one, double spacing) {
  TissueConfig config;
  config.model = "elastic";
  config.shape.max = kExtent;
  config.spacing = spacing;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = std::stod(one.poisson_ratio);
  config.fixed.push_back({Vec3::Zero(), Vec3(kExtent.x(), kExtent.y(), 0.0)});
  SolverConfig solver;
  solver.method = "newton";
  Tissue tissue(config, solver);
  LoadStep step;
  step.patches.push_back(patchOf(one));
  SolveReport last;
  int increments = 0, iterations = 0;
  double wall_ms = 0.0;
  SolveStatus worst = SolveStatus::kOk;
  tissue.load(step, [&](int, int, const SolveReport& report) {
    last = report;
    worst = std::max(worst, report.status);
    ++increments;
    iterations += report.iterations;
    wall_ms += report.wall_ms;
  });
  const double force = last.patches.front().force.norm();
  std::printf("%s,%s,%g,%s,%d,%d,%.0f,%.2g,%.6g,%.6g,%.2f,%.2f,%.5f\n", one.name.c_str(),
              one.poisson_ratio.c_str(), spacing, toString(worst), increments, iterations, wall_ms,
              last.residual, force, one.force, 100.0 * (force / one.force - 1.0),
              100.0 * fieldError(one, tissue), last.volume_ratio);
  std::fflush(stdout);
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  if (argc < 2) {
    std::cerr << "usage: accuracy FOLDER [SPACING ...]\n";
    return 2;
  }
  try {
    std::vector<double> spacings;
    for (int i = 2; i < argc; ++i) spacings.push_back(std::stod(argv[i]));
    if (spacings.empty()) spacings = {0.01, 0.005};
    std::printf(
        "case,poisson_ratio,spacing_m,status,increments,iterations,wall_ms,residual,force_n,"
        "reference_n,force_error_percent,field_error_percent,volume_ratio\n");
    for (const double spacing : spacings) {
      for (const Case& one : readCases(argv[1])) compare(one, spacing);
    }
  } catch (const std::exception& error) {
    std::cerr << "accuracy: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
