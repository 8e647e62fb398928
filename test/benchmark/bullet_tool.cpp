// A scene of one tool that moves on a box, solved by Bullet's deformable world instead of the
// package, for the study tool_accuracy: reads what `simulate` reads and writes the files that it
// writes. doc/baselines.md says what Bullet is given and what came of it.
//
//   bullet_tool SCENE.yaml --out DIR [--steps N] [--implicit] [--quiet]
//
// An increment is gone in N steps (32). A row is UNCONVERGED where a node is deeper in the tool
// than half a spacing: the tool went through; what has flown apart ends the run, so too.
#include <chrono>
#include <cstdlib>
#include <iostream>

#include "bullet_contact.h"
#include "command_line.h"
#include "output_folder.h"
#include "result_text.h"
#include "robot_tissue/scene/scene_parser.h"
#include "run_scene.h"
#include "simulate.h"

namespace robot_tissue {
namespace {

const MoveStep& moveOf(const Step& step) {
  const auto* move = std::get_if<MoveStep>(&step);
  if (move == nullptr || !move->increments) {
    throw InputError("steps: Bullet is given moves with a number of increments");
  }
  return *move;
}

Pose placeBetween(const Pose& from, const Pose& to, double share) {
  Pose place = to;
  place.translation() = from.translation() + share * (to.translation() - from.translation());
  return place;
}

void addRow(const BulletContact& bullet, const std::string& tool, const IncrementRow& increment,
            RunResult& result) {
  ToolRow row;
  row.step = increment.step;
  row.increment = increment.increment;
  row.tool = tool;
  row.force = bullet.forceOnTool();
  row.contacts = bullet.contacts();
  row.max_penetration = bullet.penetration();
  result.increments.push_back(increment);
  result.tools.push_back(row);
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
  Pose at = start->pose;
  BulletContact bullet(scene.tissue, scene.tools.front(), at, pace);
  const double through = 0.5 * bullet.lattice().spacing();
  RunResult result;
  for (int step = 0; step < static_cast<int>(scene.steps.size()); ++step) {
    const MoveStep& move = moveOf(scene.steps[robot_tissue::at(step)]);
    const Pose from = at;
    for (int i = 1; i <= *move.increments; ++i) {
      IncrementRow row;
      row.step = step;
      row.increment = i;
      const auto began = std::chrono::steady_clock::now();
      at = placeBetween(from, move.to.pose, static_cast<double>(i) / *move.increments);
      bullet.goTo(at);
      row.update_ms =
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began)
              .count();
      row.report.iterations = pace.steps;
      row.report.status = SolveStatus::kOk;
      const bool is_whole = bullet.isWhole();
      if (!is_whole || bullet.penetration() > through) {
        row.report.status = SolveStatus::kUnconverged;
      }
      if (!is_whole) {
        result.increments.push_back(row);
        result.remarks.push_back("the tissue has flown apart");
        return result;
      }
      addRow(bullet, move.tool, row, result);
    }
  }
  keepShape(bullet, result);
  return result;
}

int solve(const CommandLine& line) {
  if (line.scene.empty() || !line.value("--out")) {
    throw InputError("SCENE.yaml and --out are needed");
  }
  BulletPace pace;
  pace.implicit = line.has("--implicit");
  if (const auto steps = line.value("--steps")) pace.steps = std::atoi(steps->c_str());
  if (pace.steps < 1) throw InputError("--steps: must be a whole number of 1 and more");
  const Scene scene = loadScene(line.scene);
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
  try {
    return solve(readCommandLine(words, {{"--out", "--steps"}, {"--implicit", "--quiet"}}));
  } catch (const InputError& error) {
    std::cerr << "bullet_tool: " << error.what() << '\n';
    return kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "bullet_tool: " << error.what() << '\n';
    return kExitFailure;
  }
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  return robot_tissue::run(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
}
