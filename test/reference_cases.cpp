#include "reference_cases.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "robot_tissue/core/tissue.h"

namespace robot_tissue {
namespace {

const Vec3 kExtent(0.10, 0.10, 0.05);  // m
constexpr double kReferenceSpacing = 0.005;
constexpr double kReferenceUnit = 1e-8;  // m

std::ifstream openTable(const std::string& path) {
  std::ifstream file(path);
  std::string header;
  if (!std::getline(file, header)) throw std::runtime_error(path + ": not there, or empty");
  return file;
}

std::vector<std::string> cellsOf(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream line(row);
  for (std::string cell; std::getline(line, cell, ',');) cells.push_back(cell);
  return cells;
}

double fieldError(const ReferenceCase& reference, const Tissue& tissue) {
  const std::vector<Vec3> shown = tissue.shownDisplacement();
  const int stride = static_cast<int>(std::lround(kReferenceSpacing / tissue.lattice().spacing()));
  double missed = 0.0, moved = 0.0;
  std::size_t number = 0;
  const auto& size = tissue.lattice().size();
  for (int k = 0; k < size[2]; k += stride) {
    for (int j = 0; j < size[1]; j += stride) {
      for (int i = 0; i < size[0]; i += stride, ++number) {
        const Vec3& expected = reference.field.at(number);
        missed += (shown[at(tissue.lattice().node(i, j, k))] - expected).squaredNorm();
        moved += expected.squaredNorm();
      }
    }
  }
  return std::sqrt(missed / moved);
}

}  // namespace

std::vector<ReferenceCase> readReferenceCases(const std::string& package) {
  const std::string folder = package + "/test/data/reference/";
  std::ifstream table = openTable(folder + "cases.csv");
  std::vector<ReferenceCase> cases;
  for (std::string row; std::getline(table, row);) {
    const std::vector<std::string> cells = cellsOf(row);
    ReferenceCase reference;
    reference.name = cells.at(0);
    reference.poisson_ratio = std::stod(cells.at(1));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string& component = cells.at(2 + axis);
      if (component != "free") reference.displacement[axis] = std::stod(component);
    }
    reference.force = std::stod(cells.at(5));
    std::ifstream field =
        openTable(folder + reference.name + "_nu" + cells.at(1).substr(2) + ".csv");
    for (std::string node; std::getline(field, node);) {
      const std::vector<std::string> u = cellsOf(node);
      reference.field.push_back(kReferenceUnit *
                                Vec3(std::stod(u.at(0)), std::stod(u.at(1)), std::stod(u.at(2))));
    }
    cases.push_back(reference);
  }
  return cases;
}

TissueConfig referenceTissue(const ReferenceCase& reference, double spacing) {
  TissueConfig config;
  config.model = "elastic";
  config.shape.max() = kExtent;
  config.spacing = spacing;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = reference.poisson_ratio;
  config.fixed.push_back({Vec3::Zero(), Vec3(kExtent.x(), kExtent.y(), 0.0)});
  return config;
}

LoadStep referenceLoad(const ReferenceCase& reference) {
  PatchConfig patch;
  patch.name = "punch";
  const bool whole_face = reference.name == "uniaxial" || reference.name == "shear";
  const double from = whole_face ? 0.0 : 0.04, to = whole_face ? 0.10 : 0.06;
  patch.box = {Vec3(from, from, kExtent.z()), Vec3(to, to, kExtent.z())};
  patch.displacement = reference.displacement;
  LoadStep step;
  step.patches.push_back(patch);
  return step;
}

ReferenceError errorAgainst(const ReferenceCase& reference, const std::string& method,
                            double spacing) {
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = 1e-3;
  Tissue tissue(referenceTissue(reference, spacing), solver);
  SolveReport last;
  tissue.load(referenceLoad(reference),
              [&](int, int, const SolveReport& report) { last = report; });
  if (last.status != SolveStatus::kOk) throw std::runtime_error("no equilibrium was found");
  return {last.patches.front().force.norm() / reference.force - 1.0, fieldError(reference, tissue)};
}

}  // namespace robot_tissue
