// What a change of topology costs beside an ordinary update. Not a test: nothing here passes or
// fails.
//
//   cut_updates                       the first two studies below
//   cut_updates pressing N            blocks of 2N x 2N x N cells pressed by a sphere, a cut now
//                                     and then
//   cut_updates tools CUTS [BUDGET]   so many cuts under two moving tools at 4,851 nodes; a call
//                                     may take so many ms, then it is LATE; with a bound, 600
//                                     moves more, in which pieces roll
//   cut_updates memory UPDATES        what is allocated as a tool goes round and round, and a cut
//                                     is made and taken back every four updates
//
// Times are the processor's (ms), so that work beside it counts little; budgets are the wall's.
// doc/surgery.md and doc/node_speed.md have them.
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "../random_polygons.h"
#include "contact_trial.h"
#include "timing.h"

namespace robot_tissue {
namespace {

constexpr double kWidth = 0.1, kHeight = 0.05, kRadius = 0.01;  // m

ToolGeometry sphere(const char* name) { return toolOf(name, sphereOf(kRadius), 0.3); }

Pipeline blockUnder(int cells_high, const std::vector<ToolGeometry>& tools) {
  return {blockOf(Vec3(kWidth, kWidth, kHeight), kHeight / cells_high), SolverConfig(), tools};
}

RobotPose posesAt(const std::vector<Vec3>& places) {
  RobotPose pose;
  pose.links.assign(places.size(), Pose::Identity());
  for (std::size_t i = 0; i < places.size(); ++i) pose.links[i].translation() = places[i];
  return pose;
}

// A polygon that stands on the block's top, `depth` deep and `length` long.
std::vector<Vec3> slit(const Vec3& middle, const Vec3& along, double length, double depth) {
  const Vec3 half = 0.5 * length * along.normalized(), down(0.0, 0.0, -depth), up(0.0, 0.0, 0.01);
  return {middle - half + up, middle + half + up, middle + half + down, middle - half + down};
}

struct Times {
  std::vector<double> moves, cuts;
  int not_ok = 0, late = 0;

  void note(const Tissue& tissue) {
    const SolveStatus status = tissue.lastReport().status;
    const bool is_late = status == SolveStatus::kLate || tissue.isLate();
    late += is_late ? 1 : 0;
    not_ok += status == SolveStatus::kOk || is_late ? 0 : 1;
  }

  void tell(const char* what, int nodes) const {
    std::printf("%s,%d,%zu,%.3g,%.3g,%.3g,%zu,%.3g,%.3g,%.3g,%d,%d\n", what, nodes, moves.size(),
                quantile(moves, 0.5), quantile(moves, 0.99), quantile(moves, 1.0), cuts.size(),
                quantile(cuts, 0.5), quantile(cuts, 0.99), quantile(cuts, 1.0), late, not_ok);
    std::fflush(stdout);
  }
};

// The sphere goes down in 0.25 mm; each fourth update is a cut, 15 mm long and 10 mm deep, beside
// it.
void cutWhilePressing(int cells_high) {
  Pipeline pipeline = blockUnder(cells_high, {sphere("sphere")});
  const Vec3 over(0.051, 0.0493, kHeight + kRadius);
  Times times;
  for (int update = 0; update < 40; ++update) {
    double start = processorMs();
    pipeline.step(posesAt({over - Vec3(0.0, 0.0, 2.5e-4 * (update + 1))}));
    if (update >= 4) times.moves.push_back(processorMs() - start);
    times.note(pipeline.tissue());
    if (update % 4 != 3) continue;
    const double turn = 0.7 * update;
    const Vec3 out(std::cos(turn), std::sin(turn), 0.0);
    const Vec3 middle = Vec3(over.x(), over.y(), kHeight) + 0.02 * out;
    start = processorMs();
    pipeline.cut(slit(middle, Vec3(-out.y(), out.x(), 0.0), 0.015, 0.01));
    times.cuts.push_back(processorMs() - start);
    times.note(pipeline.tissue());
  }
  times.tell("pressing", pipeline.tissue().lattice().nodeCount());
}

// On a circle of 10 mm each, the other way round, `depth` deep (m).
RobotPose goingRound(int update, double depth) {
  const double turn = 0.05 * update;
  const Vec3 round = 0.01 * Vec3(std::cos(turn), std::sin(turn), 0.0);
  const double z = kHeight + kRadius - depth;
  return posesAt({Vec3(0.03, 0.05, z) + round, Vec3(0.07, 0.05, z) - round});
}

// Deeper and deeper, so that the pieces that were cut off roll.
void rollPieces(Pipeline& pipeline, int updates_before) {
  Times times;
  for (int update = 0; update < 600; ++update) {
    const double start = processorMs();
    pipeline.step(goingRound(updates_before + update, 0.004 + 1e-5 * update));
    times.moves.push_back(processorMs() - start);
    times.note(pipeline.tissue());
  }
  times.cuts.push_back(0.0);
  times.tell("rolling, bounded", pipeline.tissue().lattice().nodeCount());
}

// budget: of a call (ms); 0: none.
void cutUnderTwoTools(int cuts, double budget) {
  Pipeline pipeline = blockUnder(10, {sphere("left"), sphere("right")});
  if (budget > 0.0) pipeline.setBudget(1e-3 * budget);
  RandomNumbers numbers;
  Times times;
  for (int cut = 0; cut < cuts; ++cut) {
    double start = processorMs();
    pipeline.step(goingRound(cut, std::min(2.5e-4 * cut, 0.004)));
    times.moves.push_back(processorMs() - start);
    times.note(pipeline.tissue());
    const Vec3 middle(numbers.between(0.01, 0.09), numbers.between(0.01, 0.09), kHeight);
    const double way = numbers.between(0.0, 3.14159);
    start = processorMs();
    pipeline.cut(slit(middle, Vec3(std::cos(way), std::sin(way), 0.0), 0.02, 0.012));
    times.cuts.push_back(processorMs() - start);
    times.note(pipeline.tissue());
  }
  times.tell(budget > 0.0 ? "two tools, bounded" : "two tools",
             pipeline.tissue().lattice().nodeCount());
  if (budget > 0.0) rollPieces(pipeline, cuts);
}

void watchMemory(int updates) {
  Pipeline pipeline = blockUnder(10, {sphere("sphere")});
  std::printf("updates,in_use_mb,heap_mb\n");
  for (int update = 0; update < updates; ++update) {
    const double turn = 0.05 * update;
    const Vec3 round = 0.01 * Vec3(std::cos(turn), std::sin(turn), 0.0);
    pipeline.step(posesAt({Vec3(0.05, 0.05, kHeight + kRadius - 0.003) + round}));
    if (update % 4 == 1)
      pipeline.cut(slit(Vec3(0.0525, 0.03, kHeight), Vec3::UnitY(), 0.02, 0.015));
    if (update % 4 == 3) pipeline.undo(1);
    if ((update + 1) % (updates / 10) != 0) continue;
    const struct mallinfo2 info = mallinfo2();
    std::printf("%d,%.3g,%.3g\n", update + 1, 1e-6 * static_cast<double>(info.uordblks),
                1e-6 * static_cast<double>(info.arena + info.hblkhd));
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  if (argc == 3 && std::strcmp(argv[1], "memory") == 0) {
    watchMemory(std::max(10, std::atoi(argv[2])));
    return 0;
  }
  std::printf(
      "study,nodes,moves,move_ms,move_ms_99,move_ms_worst,cuts,cut_ms,cut_ms_99,cut_ms_worst,"
      "late,not_ok\n");
  if (argc == 3 && std::strcmp(argv[1], "pressing") == 0) {
    cutWhilePressing(std::atoi(argv[2]));
  } else if (argc >= 3 && std::strcmp(argv[1], "tools") == 0) {
    cutUnderTwoTools(std::atoi(argv[2]), argc > 3 ? std::atof(argv[3]) : 0.0);
  } else if (argc == 1) {
    for (const int cells_high : {10, 20}) cutWhilePressing(cells_high);
    cutUnderTwoTools(200, 0.0);
    cutUnderTwoTools(200, 40.0);
  } else {
    std::fprintf(
        stderr,
        "usage: cut_updates [pressing CELLS_HIGH | tools CUTS [BUDGET] | memory UPDATES]\n");
    return 2;
  }
  return 0;
}
