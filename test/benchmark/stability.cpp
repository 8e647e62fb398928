// One rung of the stability ladder, one method, one line of CSV. scripts/study stability runs them
// all.
//   stability --list                     names and groups of the rungs
//   stability RUNG METHOD [UPDATES]      UPDATES: of the random rungs, 10,000 unless said
//   stability RUNG reference             what method `newton` measures in small increments
// Method `paper` solves model six_spring, the others `elastic`.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <random>

#include "random_visits.h"
#include "stability_rungs.h"
#include "timing.h"

namespace robot_tissue {
namespace {

constexpr double kTolerance = 0.01;
constexpr int kUpdatesOfVisit = 50;
const std::vector<std::string> kRandom = {"random_patch", "random_tools"};

struct Row {
  bool finite = true;
  SolveStatus worst = SolveStatus::kOk;  // until the load is gone
  int unconverged = 0;                   // solves
  int inverted = 0;                      // cells, under load
  double error_estimate = 0.0;
  double residual = 0.0;
  double measured = 0.0;
  SolveStatus status_released = SolveStatus::kOk;
  int inverted_released = 0;
  double left = 0.0;  // of the spacing
  int iterations = 0;
};

void print(const Row& row, double seconds) {
  std::printf("%d,%s,%d,%d,%.4g,%.4g,%.6g,%s,%d,%.4g,%d,%.2f\n", row.finite ? 1 : 0,
              toString(row.worst), row.unconverged, row.inverted, row.error_estimate, row.residual,
              row.measured, toString(row.status_released), row.inverted_released, row.left,
              row.iterations, seconds);
}

SolverConfig solverFor(const std::string& method) {
  SolverConfig solver;
  solver.method = method;
  solver.tolerance = kTolerance;
  return solver;
}

std::string modelFor(const std::string& method) {
  const std::vector<std::string> fit = methodsFor("elastic");
  return std::count(fit.begin(), fit.end(), method) > 0 ? "elastic" : "six_spring";
}

Specimen specimenOf(const Rung& rung, const std::string& method) {
  TissueConfig tissue = rung.tissue;
  tissue.model = modelFor(method);
  Specimen specimen(tissue, solverFor(method));
  for (const std::vector<Vec3>& corners : rung.cuts) specimen.cut(corners);
  for (const Box& box : rung.patches) specimen.addPatch(box);
  return specimen;
}

void climb(const Rung& rung, int increments, Specimen& specimen, Row& row) {
  for (int increment = 1; increment <= increments; ++increment) {
    rung.go(specimen, static_cast<double>(increment) / increments);
    specimen.solve();
  }
  if (rung.afterwards) rung.afterwards(specimen);
  row.measured = rung.measure(specimen);
}

Row runRung(const Rung& rung, const std::string& method) {
  Row row;
  Specimen specimen = specimenOf(rung, method);
  climb(rung, rung.increments, specimen, row);
  const Course loaded = specimen.course();
  row.worst = loaded.worst;
  row.error_estimate = loaded.error_estimate;
  row.residual = loaded.residual;
  row.unconverged = loaded.unconverged;
  row.inverted = specimen.invertedCells();
  // Turned inside out, tissue may find another shape without a force: Tissue starts from rest.
  rung.has_no_shape ? specimen.releaseFromRest() : specimen.release();
  const Course& whole = specimen.course();
  row.status_released =
      whole.unconverged > loaded.unconverged ? SolveStatus::kUnconverged : SolveStatus::kOk;
  row.finite = whole.finite;
  row.inverted_released = specimen.invertedCells();
  row.left = specimen.distanceFromRest() / rung.tissue.spacing;
  row.iterations = whole.iterations;
  return row;
}

double referenceOf(const Rung& rung) {
  if (rung.known) return *rung.known;
  if (rung.reference_increments == 0) return std::nan("");
  Specimen specimen = specimenOf(rung, "newton");
  Row row;
  climb(rung, rung.reference_increments, specimen, row);
  const bool good = specimen.course().finite && specimen.course().worst == SolveStatus::kOk;
  return good ? row.measured : std::nan("");
}

// A patch on top of a block of 726 nodes wanders by up to half a spacing an update and turns; one
// update in sixteen takes it anywhere. Let go after every 50.
Row runRandomPatch(const std::string& method, int updates) {
  std::mt19937_64 random(1);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto vector = [&](const Vec3& low, const Vec3& high) {
    const double x = uniform(low.x(), high.x()), y = uniform(low.y(), high.y());
    return Vec3(x, y, uniform(low.z(), high.z()));
  };
  const Vec3 low(-0.015, -0.015, -0.02), high(0.015, 0.015, 0.015);
  TissueConfig tissue = makeRungs().front().tissue;
  tissue.spacing = 0.01;
  tissue.model = modelFor(method);
  Specimen specimen(tissue, solverFor(method));
  Row row;
  Vec3 place = Vec3::Zero(), turn = Vec3::Zero();
  for (int update = 0; update < updates; ++update) {
    if (update % kUpdatesOfVisit == 0) {
      specimen.addPatch({Vec3(0.04, 0.04, 0.05), Vec3(0.06, 0.06, 0.05)});
      place = turn = Vec3::Zero();
    }
    const bool far = uniform(0.0, 1.0) < 1.0 / 16.0;
    const Vec3 step = vector(Vec3::Constant(-0.005), Vec3::Constant(0.005));
    place = far ? vector(low, high) : Vec3((place + step).cwiseMax(low).cwiseMin(high));
    turn = (turn + vector(Vec3::Constant(-0.1), Vec3::Constant(0.1))).eval();
    turn *= std::min(1.0, 0.7 / std::max(turn.norm(), 1e-9));
    specimen.turn(0, turn, place);
    const int unconverged = specimen.course().unconverged;
    specimen.solve();
    row.inverted += specimen.invertedCells() > 0 ? 1 : 0;
    row.unconverged += specimen.course().unconverged - unconverged;
    row.measured = std::max(row.measured, specimen.force(0));
    if (update % kUpdatesOfVisit != kUpdatesOfVisit - 1) continue;
    specimen.release();
    row.inverted_released = std::max(row.inverted_released, specimen.invertedCells());
    row.left = std::max(row.left, specimen.distanceFromRest() / tissue.spacing);
  }
  const Course& course = specimen.course();
  row.worst = course.worst;
  row.error_estimate = course.error_estimate;
  row.residual = course.residual;
  row.finite = course.finite;
  row.iterations = course.iterations;
  return row;
}

Row runRandomTools(const std::string& method, int updates) {
  RandomVisits::Trial trial;
  trial.method = method;
  trial.model = modelFor(method);
  if (trial.model != "elastic") trial.patch = ToolConfig::Patch::kRigid;
  RandomVisits visits(trial);
  Row row;
  for (int number = 0; number < updates / RandomVisits::kMotionsOfVisit; ++number) {
    const RandomVisits::Sums sums = visits.visit(number);
    row.finite = row.finite && sums.not_finite == 0;
    row.unconverged += sums.unconverged;
    row.inverted += sums.inverted;
    row.error_estimate = std::max(row.error_estimate, sums.error_estimate);
    row.measured = std::max(row.measured, sums.force);
    row.inverted_released = std::max(row.inverted_released, sums.inverted_at_leave);
    row.left = std::max(row.left, sums.left / trial.spacing);
    row.iterations += sums.load_steps;
  }
  if (row.unconverged > 0) row.worst = SolveStatus::kUnconverged;
  return row;
}

void list(const std::vector<Rung>& rungs) {
  for (const Rung& rung : rungs) {
    std::printf("%s,%s,%s,%g,%d\n", rung.name.c_str(), rung.group.c_str(), rung.unit.c_str(),
                rung.bound, rung.has_no_shape ? 1 : 0);
  }
  // Tools thrown through each other may leave no shape to be OK.
  for (const std::string& name : kRandom) {
    std::printf("%s,random,N,0,%d\n", name.c_str(), name == "random_tools" ? 1 : 0);
  }
}

int run(const std::string& name, const std::string& method, int updates) {
  const auto seconds = [] { return 1e-3 * processorMs(); };
  if (name == "random_patch") {
    const Row row = runRandomPatch(method, updates);
    print(row, seconds());
    return 0;
  }
  if (name == "random_tools") {
    const Row row = runRandomTools(method, updates);
    print(row, seconds());
    return 0;
  }
  for (const Rung& rung : makeRungs()) {
    if (rung.name != name) continue;
    if (method == "reference") {
      const double reference = referenceOf(rung);
      std::printf("%.6g,%.2f\n", reference, seconds());
    } else {
      const Row row = runRung(rung, method);
      print(row, seconds());
    }
    return 0;
  }
  throw InputError("rung '" + name + "' is unknown; allowed: those of --list");
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  try {
    if (argc == 2 && std::string(argv[1]) == "--list") {
      list(makeRungs());
      return 0;
    }
    if (argc < 3) throw InputError("usage: stability RUNG METHOD [UPDATES] | stability --list");
    return run(argv[1], argv[2], static_cast<int>(argument(argc, argv, 3, 10000.0)));
  } catch (const std::exception& error) {
    std::cerr << "stability: " << error.what() << '\n';
    return 2;
  }
}
