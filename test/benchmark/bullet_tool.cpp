// A scene of one tool that moves on a box, solved by Bullet's deformable world instead of the
// package, for the study tool_accuracy: reads what `simulate` reads and writes the files that it
// writes. doc/baselines.md says what Bullet is given and what came of it.
//
//   bullet_tool SCENE.yaml --out DIR [--steps N] [--implicit] [--quiet]
//
// An increment is gone in N steps (32). A row is UNCONVERGED where a node is deeper in the tool
// than half a spacing: the tool went through; what has flown apart ends the run, so too.
#include <iostream>

#include "bullet_contact.h"
#include "bullet_options.h"
#include "output_folder.h"
#include "result_text.h"
#include "robot_tissue/scene/command_line.h"
#include "robot_tissue/scene/scene_parser.h"
#include "run_scene.h"
#include "simulate.h"
#include "timing.h"

namespace robot_tissue {
namespace {

const MoveStep& moveOf(const Step& step) {
  const auto* move = std::get_if<MoveStep>(&step);
  if (move == nullptr || !move->increments) {
    throw InputError("steps: Bullet is given moves with a number of increments");
  }
  return *move;
}

// The increment that ends there. False: the tissue has flown apart.
bool advance(BulletContact& bullet, const Pose& there, const std::string& tool, IncrementRow row,
             RunResult& result) {
  const auto began = Clock::now();
  bullet.goTo(there);
  row.update_ms = millisecondsSince(began);
  const bool is_whole = bullet.isWhole();
  const double through = 0.5 * bullet.lattice().spacing();
  const bool is_ok = is_whole && bullet.penetration() <= through;
  row.report.status = is_ok ? SolveStatus::kOk : SolveStatus::kUnconverged;
  result.increments.push_back(row);
  if (!is_whole) return false;
  ToolRow of_tool;
  of_tool.step = row.step;
  of_tool.increment = row.increment;
  of_tool.tool = tool;
  of_tool.force = bullet.forceOnTool();
  of_tool.contacts = bullet.contacts();
  of_tool.max_penetration = bullet.penetration();
  result.tools.push_back(of_tool);
  return true;
}

void keepShape(const BulletContact& bullet, RunResult& result) {
  for (int node = 0; node < bullet.lattice().nodeCount(); ++node) {
    result.rest.push_back(bullet.lattice().restPosition(node));
    result.displacement.push_back(bullet.displacement(node));
  }
}

RunResult runTool(const Scene& scene, const BulletPace& pace) {
  if (scene.tools.size() != 1 || scene.steps.empty() || scene.tissue.mesh) {
    throw InputError("tools: Bullet is given one tool that moves, on a box");
  }
  const auto& start = moveOf(scene.steps.front()).from;
  if (!start) throw InputError("steps[0].move.from: must be given");
  Pose from = start->pose;
  BulletContact bullet(scene.tissue, scene.tools.front(), from, pace);
  RunResult result;
  for (int step = 0; step < static_cast<int>(scene.steps.size()); ++step) {
    const MoveStep& move = moveOf(scene.steps[at(step)]);
    IncrementRow row;
    row.step = step;
    row.report.iterations = pace.steps;
    for (int& i = row.increment; i <= *move.increments; ++i) {
      const Pose there = onTheWay(from, move.to.pose, static_cast<double>(i) / *move.increments);
      if (advance(bullet, there, move.tool, row, result)) continue;
      result.remarks.push_back("the tissue has flown apart");
      return result;
    }
    from = move.to.pose;
  }
  keepShape(bullet, result);
  return result;
}

int solve(const CommandLine& line) {
  if (line.file(0).empty() || !line.value("--out")) {
    throw InputError("SCENE.yaml and --out are needed");
  }
  BulletPace pace;
  pace.implicit = line.has("--implicit");
  pace.steps = wholeNumberOf(line, "--steps", pace.steps);
  const Scene scene = loadScene(line.file(0));
  OutputFolder folder(*line.value("--out"), {"nodes.csv", "increments.csv", "tools.csv"});
  const RunResult result = runTool(scene, pace);
  folder.write("nodes.csv", nodesCsv(result));
  folder.write("increments.csv", incrementsCsv(result));
  folder.write("tools.csv", toolsCsv(result));
  folder.commit();
  for (const std::string& remark : result.remarks) {
    if (!line.has("--quiet")) std::cout << remark << '\n';
  }
  return result.allOk() ? kExitOk : kExitNotAllOk;
}

int run(const std::vector<std::string>& words) {
  return exitCodeOf("bullet_tool", std::cerr, [&words] {
    return solve(readCommandLine(words, {{"--out", "--steps"}, {"--implicit", "--quiet"}}));
  });
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  return robot_tissue::run(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
}
