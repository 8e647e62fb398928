// What ways of a load cost method `layered`, beside a plain press: a patch of 20 x 20 mm on 4,851
// nodes (5 mm), at most half a spacing an increment. All ways in turn, so that what else the
// machine does meets all. Prints a row of CSV a way: milliseconds of the processor an increment,
// median; that over the press's in the same round, median of the rounds; greatest error against the
// same lattice at a tolerance of 1e-5 (L2 over all nodes); increments that were not OK. Not a test.
//
//   load_ways [ROUNDS]
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "patch_trial.h"

namespace robot_tissue {
namespace {

constexpr double kStep = 0.001;      // m, an increment of a press and a drag
constexpr double kLongest = 0.0025;  // m: half a spacing, of a random one
constexpr double kDeepest = 0.006;   // m: how far random ones go from rest
constexpr int kRandom = 30;
constexpr double kStiff = 100.0;  // times as stiff

using Way = std::vector<Vec3>;

Way press() {
  Way way;
  for (int i = 1; i <= 5; ++i) way.emplace_back(0.0, 0.0, -kStep * i);
  return way;
}

Way dragAndBack() {
  Way way = press();
  for (int i = 1; i <= 5; ++i) way.emplace_back(kStep * i, 0.0, -5 * kStep);
  for (int i = 4; i >= -5; --i) way.emplace_back(kStep * i, 0.0, -5 * kStep);
  return way;
}

Way random() {
  std::mt19937 numbers(1);
  const auto number = [&numbers] {
    return 2.0 * static_cast<double>(numbers()) / 4294967295.0 - 1.0;
  };
  Way way = {Vec3::Zero()};
  while (way.size() <= kRandom) {
    const Vec3 step = kLongest * Vec3(number(), number(), number());
    const Vec3 place = way.back() + step;
    if (step.norm() <= kLongest && place.norm() <= kDeepest && place.z() <= 0.0) {
      way.push_back(place);
    }
  }
  way.erase(way.begin());
  return way;
}

struct Case {
  std::string name;
  double poisson_ratio;
  Way way;
  bool half_stiff = false;
};

TissueConfig configOf(const Case& each, const PatchJob& job) {
  TissueConfig config = blockOf(job);
  if (each.half_stiff) {
    Region region;
    region.box = config.shape;
    region.box.min().x() = 0.5 * config.shape.max().x();
    region.material = config.material;
    region.material.young_modulus *= kStiff;
    config.regions.push_back(region);
  }
  return config;
}

struct Result {
  std::vector<double> ms, ratios;  // medians, a round each
  double error = 0.0;
  int not_ok = 0;
};

double medianMs(const Case& each, const PatchJob& job, int& not_ok) {
  Tissue tissue(configOf(each, job), solverOf(job, job.tolerance));
  tissue.load(stepTo(job, -0.5 * kStep * Vec3::UnitZ()));  // what is made once is made
  std::vector<double> all;
  not_ok = 0;
  for (const Vec3& place : each.way) {
    const double before = threadMs();
    tissue.load(stepTo(job, place));
    all.push_back(threadMs() - before);
    if (tissue.lastReport().status != SolveStatus::kOk) ++not_ok;
  }
  return quantile(all, 0.5);
}

double greatestError(const Case& each, const PatchJob& job) {
  Tissue tissue(configOf(each, job), solverOf(job, job.tolerance));
  Tissue exact(configOf(each, job), solverOf(job, kExact));
  double greatest = 0.0;
  for (const Vec3& place : each.way) {
    tissue.load(stepTo(job, place));
    exact.load(stepTo(job, place));
    greatest = std::max(greatest, errorOf(tissue, exact));
  }
  return greatest;
}

void measure(int rounds) {
  std::vector<Case> cases;
  for (const double ratio : {0.25, 0.45}) {
    cases.push_back({"press", ratio, press()});
    cases.push_back({"drag and back", ratio, dragAndBack()});
    cases.push_back({"random", ratio, random()});
    cases.push_back({"press, half 100 times as stiff", ratio, press(), true});
  }
  cases.push_back({"press", 0.49, press()});
  cases.push_back({"drag and back", 0.49, dragAndBack()});
  std::vector<Result> results(cases.size());
  for (int round = 0; round < rounds; ++round) {
    double of_press = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const PatchJob job = {0.005, 1.0, cases[i].poisson_ratio, 0.01, 1};
      const double ms = medianMs(cases[i], job, results[i].not_ok);
      if (cases[i].name == "press" && cases[i].poisson_ratio < 0.49) of_press = ms;
      results[i].ms.push_back(ms);
      results[i].ratios.push_back(ms / of_press);
      if (round == 0) results[i].error = greatestError(cases[i], job);
    }
  }
  std::printf("way,nu,ms,times_of_press,greatest_error,not_ok\n");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    std::printf("\"%s\",%g,%.3g,%.3g,%.4g,%d\n", cases[i].name.c_str(), cases[i].poisson_ratio,
                quantile(results[i].ms, 0.5), quantile(results[i].ratios, 0.5), results[i].error,
                results[i].not_ok);
  }
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  robot_tissue::measure(argc > 1 ? std::atoi(argv[1]) : 9);
  return 0;
}
