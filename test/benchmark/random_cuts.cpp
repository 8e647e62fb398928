// A loaded tissue cut by polygons at random (always the same ones), and all of it taken back.
// Prints a row of CSV every tenth of the way; doc/surgery.md has them. Not a test: nothing here
// passes or fails.
//
//   random_cuts SCENE.yaml CUTS SIZE > rows.csv
//
// The scene's first load stands. SIZE (m): how far corners are from the polygon's middle along each
// axis, at most.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <utility>
#include <vector>

#include "../random_polygons.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/scene/scene_parser.h"
#include "timing.h"

namespace robot_tissue {
namespace {

// Edges that one triangle runs along, or several the same way.
std::pair<int, int> openAndManifoldFaults(const TissueSurface& surface) {
  std::map<std::pair<int, int>, int> edges;
  for (const MeshTriangle& triangle : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{triangle[i], triangle[(i + 1) % 3]}];
  }
  int open = 0, crowded = 0;
  for (const auto& [edge, count] : edges) {
    const auto opposite = edges.find({edge.second, edge.first});
    open += opposite == edges.end() || opposite->second != count ? 1 : 0;
    crowded += count > 1 ? 1 : 0;
  }
  return {open, crowded};
}

void run(const Scene& scene, int cuts, double size) {
  Tissue tissue(scene.tissue, scene.solver);
  for (const Step& step : scene.steps) {
    const auto* load = std::get_if<LoadStep>(&step);
    if (load == nullptr) continue;
    tissue.load(*load);
    break;
  }
  const std::string before = tissue.savedState();
  const double volume = enclosedVolume(tissue.surface(), tissue.surface().rest);
  RandomPolygons polygons(tissue.lattice().bounds(), size);
  double sum = 0.0, longest = 0.0;
  int not_ok = 0, refused = 0;
  std::printf(
      "cuts,refused,springs,pieces,nodes_added,triangles,open_edges,crowded_edges,"
      "volume_error,finite,not_ok,mean_ms,longest_ms\n");
  for (int cut = 1; cut <= cuts; ++cut) {
    const auto start = Clock::now();
    try {
      not_ok += tissue.cut(polygons.next()).solve.status == SolveStatus::kOk ? 0 : 1;
    } catch (const InputError&) {
      ++refused;
    }
    sum += millisecondsSince(start);
    longest = std::max(longest, millisecondsSince(start));
    if (cut % std::max(1, cuts / 10) != 0) continue;
    const auto [open, crowded] = openAndManifoldFaults(tissue.surface());
    const double error = enclosedVolume(tissue.surface(), tissue.surface().rest) / volume - 1.0;
    const bool finite = std::all_of(tissue.vertices().begin(), tissue.vertices().end(),
                                    [](const Vec3& vertex) { return vertex.allFinite(); });
    std::printf("%d,%d,%d,%d,%zu,%zu,%d,%d,%.1e,%d,%d,%.4g,%.4g\n", cut, refused,
                tissue.state().springs_cut, tissue.state().pieces,
                tissue.state().cells->ghosts().size(), tissue.surface().triangles.size(), open,
                crowded, error, finite ? 1 : 0, not_ok, sum / cut, longest);
    std::fflush(stdout);
  }
  const auto start = Clock::now();
  const int undone = tissue.undoable();
  if (undone > 0) tissue.undo(undone);
  std::printf("# %d taken back in %.4g ms, %s\n", undone, millisecondsSince(start),
              tissue.savedState() == before ? "bit for bit" : "NOT bit for bit");
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: random_cuts SCENE.yaml CUTS SIZE\n");
    return 2;
  }
  robot_tissue::run(robot_tissue::loadScene(argv[1], {}), std::atoi(argv[2]), std::atof(argv[3]));
  return 0;
}
