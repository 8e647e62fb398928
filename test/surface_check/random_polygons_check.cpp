// Loaded tissue cut by polygons at random (always the same ones), its surface looked at by a
// library ten times on the way (sound_surface.h), and all of it taken back. A row of CSV a look;
// exit code 1 where a surface is not sound, a number not finite, or what comes back is not what
// was, bit for bit. scripts/nightly runs it; doc/surgery.md has what it found.
//
//   random_polygons_check block|liver CUTS
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <variant>

#include "../random_polygons.h"
#include "robot_tissue/scene/scene_parser.h"
#include "sound_surface.h"

namespace robot_tissue {
namespace {

constexpr int kLooks = 10;
// What is looked at is the topology: the shape need not be balanced well.
constexpr double kTolerance = 0.05;
constexpr double kMostMs = 50.0;  // of a solve, then it is LATE
// m: vertices on the other side's triangles are off them by rounding, some units in the last place
// of 0.1 m, and more on facets that are steep in the grid.
constexpr double kRounding = 1e-12;
// Of the spacing (1): where many blades cross, tips of a mesh's wounds stand out of its skin by so
// much at most (doc/surgery.md).
constexpr double kTip = 0.15;

struct Trial {
  Scene scene;
  double size = 0.0;  // m: how far a polygon's corners are from its middle along each axis, at most
  double depth = kRounding;  // m: how far triangles may cross
};

LoadStep pressed(const char* name, const Box& box, const Vec3& way) {
  PatchConfig patch;
  patch.name = name;
  patch.box = box;
  patch.displacement = {{way.x(), way.y(), way.z()}};
  LoadStep step;
  step.patches.push_back(patch);
  return step;
}

Trial block() {
  Trial trial;
  trial.scene.tissue.shape.max() = Vec3(0.1, 0.1, 0.05);
  trial.scene.tissue.spacing = 0.005;
  trial.scene.tissue.material.young_modulus = 1e4;
  trial.scene.tissue.fixed.push_back(Box(Vec3(-1, -1, -1), Vec3(1, 1, 0)));
  const Box punch(Vec3(0.04, 0.04, 0.05), Vec3(0.06, 0.06, 0.05));
  trial.scene.steps = {pressed("punch", punch, Vec3(0, 0, -0.003))};
  trial.size = 0.03;
  return trial;
}

// With the load that the scene begins with.
Trial liver() {
  Trial trial{loadScene(std::string(ROBOT_TISSUE_SOURCE_DIR) + "/config/liver.yaml", {}), 0.06};
  trial.depth = kTip * trial.scene.tissue.spacing;
  return trial;
}

bool isFinite(const Tissue& tissue) {
  return std::all_of(tissue.vertices().begin(), tissue.vertices().end(),
                     [](const Vec3& vertex) { return vertex.allFinite(); });
}

int takeBackAll(Tissue& tissue, const std::string& before) {
  const int changes = tissue.undoable();
  if (changes > 0) tissue.undo(changes);
  const bool is_same = tissue.savedState() == before;
  std::printf("# %d taken back, %s\n", changes, is_same ? "bit for bit" : "NOT bit for bit");
  return is_same ? 0 : 1;
}

int check(Trial trial, int cuts) {
  trial.scene.solver.tolerance = kTolerance;
  trial.scene.solver.max_ms = kMostMs;
  Tissue tissue(trial.scene.tissue, trial.scene.solver);
  tissue.load(std::get<LoadStep>(trial.scene.steps.front()));
  const std::string before = tissue.savedState();
  const double volume = volumeOf(tissue);
  RandomPolygons polygons(tissue.lattice().bounds(), trial.size);
  int late = 0, not_ok = 0, faults = 0;
  std::printf("cuts,springs,pieces,triangles,late,not_ok,finite,fault\n");
  for (int cut = 1; cut <= cuts; ++cut) {
    const SolveStatus status = tissue.cut(polygons.next()).solve.status;
    late += status == SolveStatus::kLate ? 1 : 0;
    not_ok += status == SolveStatus::kLate || status == SolveStatus::kOk ? 0 : 1;
    if (cut % std::max(1, cuts / kLooks) != 0) continue;
    const bool is_finite = isFinite(tissue);
    const std::string fault = faultOf(tissue, volume, trial.depth);
    faults += fault.empty() && is_finite ? 0 : 1;
    std::printf("%d,%d,%d,%zu,%d,%d,%d,%s\n", cut, tissue.state().springs_cut,
                tissue.state().pieces, tissue.surface().triangles.size(), late, not_ok,
                is_finite ? 1 : 0, fault.empty() ? "none" : fault.c_str());
    std::fflush(stdout);
  }
  return faults + takeBackAll(tissue, before) == 0 ? 0 : 1;
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  const int cuts = argc == 3 ? std::atoi(argv[2]) : 0;
  const bool is_block = cuts > 0 && std::strcmp(argv[1], "block") == 0;
  if (!is_block && (cuts <= 0 || std::strcmp(argv[1], "liver") != 0)) {
    std::fprintf(stderr, "usage: random_polygons_check block|liver CUTS\n");
    return 2;
  }
  return robot_tissue::check(is_block ? robot_tissue::block() : robot_tissue::liver(), cuts);
}
