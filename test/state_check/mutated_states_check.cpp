// Files of saved states with bytes changed at random (always the same ones), each loaded: refused
// in one line that leaves the tissue as it is, or a state that is finite. A row of CSV a model;
// exit code 1 where one is neither. scripts/nightly runs it; doc/state_file.md has what it found.
//
//   mutated_states_check FILES
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "../mutated_states.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/scene/state_file.h"

namespace robot_tissue {
namespace {

namespace fs = std::filesystem;

constexpr double kSpacing = 0.01;  // m
// Of a solve, then it is LATE: what passes may be as far from balance as bytes can say.
constexpr double kMostMs = 20.0;
const std::string kFile = "changed.tissue";

TissueConfig block(const std::string& model) {
  TissueConfig config;
  config.model = model;
  config.shape.max() = kSpacing * Vec3(6, 5, 4);
  config.spacing = kSpacing;
  config.material.young_modulus = 1e4;
  config.fixed.push_back(Box(Vec3(-1, -1, -1), Vec3(1, 1, 0)));
  if (model == "elastic") config.free_pieces = FreePieces::kDrop;
  return config;
}

SolverConfig solverFor(const std::string& model) {
  SolverConfig solver;
  solver.method = model == "elastic" ? "layered" : "paper";
  return solver;
}

// With all that a state can have: loads, cuts, what was removed, threads and a dropped piece.
std::string stateOf(Tissue& tissue, bool can_be_sutured) {
  LoadStep press;
  press.patches.resize(2);
  press.patches[0].name = "punch";
  press.patches[0].box = Box(kSpacing * Vec3(1, 1, 4), kSpacing * Vec3(2, 2, 4));
  press.patches[0].displacement = {{0.0, 0.0, -0.3 * kSpacing}};
  press.patches[1].name = "pull";
  press.patches[1].box = Box(kSpacing * Vec3(4, 3, 4), kSpacing * Vec3(5, 4, 4));
  press.patches[1].force = Vec3(0.01, 0.0, 0.02);
  tissue.load(press);
  tissue.cut({{0.033, -1, 0.015}, {0.033, 1, 0.015}, {0.033, 1, 1}, {0.033, -1, 1}});
  tissue.remove(Sphere{kSpacing * Vec3(6, 5, 4), 1.5 * kSpacing});
  tissue.cut({{-1, 0.014, 0.033}, {0.014, -1, 0.033}, {0.014, -1, 1}, {-1, 0.014, 1}});
  if (!can_be_sutured) return tissue.savedState();
  SutureConfig thread;
  thread.name = "s1";
  thread.from = kSpacing * Vec3(2.5, 4, 4);
  thread.to = kSpacing * Vec3(4.5, 2, 4);
  thread.rest_length = 2.0 * kSpacing;
  tissue.suture(thread);
  return tissue.savedState();
}

bool isFinite(const Tissue& tissue) {
  return std::all_of(tissue.vertices().begin(), tissue.vertices().end(),
                     [](const Vec3& vertex) { return vertex.allFinite(); });
}

struct Counts {
  int refused = 0, loaded = 0, faults = 0;

  void fault(int file, const std::string& what) {
    std::printf("# file %d: %s\n", file, what.c_str());
    ++faults;
  }
};

// As the node and the runner do it.
void loadChanged(Tissue& tissue, const std::string& folder, int file, Counts& counts) {
  const std::string before = tissue.savedState();
  try {
    tissue.loadState(*tissue.readState(readStateFile(folder, kFile)));
  } catch (const InputError& error) {
    const std::string line = error.what();
    ++counts.refused;
    if (line.empty() || line.find('\n') != std::string::npos) counts.fault(file, "not one line");
    if (tissue.savedState() != before) counts.fault(file, "refused, and the tissue is another");
    return;
  }
  ++counts.loaded;
  if (!isFinite(tissue)) counts.fault(file, "not finite");
}

int check(const std::string& model, int files, const std::string& folder) {
  SolverConfig solver = solverFor(model);
  Tissue unhurried(block(model), solver);  // so that the good state is in balance
  const std::string good = stateOf(unhurried, model == "elastic");
  solver.max_ms = kMostMs;
  Tissue tissue(block(model), solver);
  MutatedStates changed(good, 21);
  Counts counts;
  for (int file = 0; file < files; ++file) {
    const std::string bytes = changed.next();
    std::ofstream(fs::path(folder) / kFile, std::ios::binary) << bytes;
    const int loaded_before = counts.loaded;
    loadChanged(tissue, folder, file, counts);
    if (counts.loaded == loaded_before) continue;
    tissue.loadState(*tissue.readState(good));
    if (tissue.savedState() != good) counts.fault(file, "the good state does not come back");
  }
  std::printf("%s,%zu,%d,%d,%d,%d\n", model.c_str(), good.size(), files, counts.refused,
              counts.loaded, counts.faults);
  std::fflush(stdout);
  return counts.faults;
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  const int files = argc == 2 ? std::atoi(argv[1]) : 0;
  if (files <= 0) {
    std::fprintf(stderr, "usage: mutated_states_check FILES\n");
    return 2;
  }
  std::string folder = (fs::temp_directory_path() / "states_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) {
    std::perror("mutated_states_check");
    return 2;
  }
  std::printf("model,bytes,files,refused,loaded,faults\n");
  int faults = 0;
  for (const char* model : {"elastic", "six_spring"}) {
    faults += robot_tissue::check(model, files / 2, folder);
  }
  fs::remove_all(folder);
  return faults == 0 ? 0 : 1;
}
