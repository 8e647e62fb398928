#include "arguments.h"

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/command_line.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kMostSeconds = 1e9;

void requireSceneAndOut(const Arguments& parsed) {
  const std::string usage = ", must be simulate SCENE.yaml --out DIR (see --help)";
  if (parsed.scene.empty()) throw InputError("SCENE.yaml is missing" + usage);
  if (parsed.out.empty()) throw InputError("--out is missing" + usage);
}

std::optional<double> readSeconds(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  const std::optional<double> seconds = parseNumber(*text);
  if (seconds && *seconds > 0.0 && *seconds <= kMostSeconds) return seconds;
  throw InputError("--max-seconds = " + onOneLine(*text) +
                   ": must be a number above 0 and at most " + numberText(kMostSeconds));
}

}  // namespace

Arguments parseArguments(const std::vector<std::string>& arguments) {
  const CommandLine line = readCommandLine(
      arguments, {{"--out", "--method", "--tolerance", "--threads", "--max-seconds"},
                  {"--list-methods", "--list-models", "--quiet", "--help"}});
  Arguments parsed;
  parsed.scene = line.file(0);
  parsed.out = line.value("--out").value_or("");
  parsed.overrides = {line.value("--method"), line.value("--tolerance"), line.value("--threads")};
  parsed.max_seconds = readSeconds(line.value("--max-seconds"));
  parsed.list_methods = line.has("--list-methods");
  parsed.list_models = line.has("--list-models");
  parsed.quiet = line.has("--quiet");
  parsed.help = line.has("--help");
  if (!parsed.onlyPrints()) requireSceneAndOut(parsed);
  return parsed;
}

std::string helpText() {
  return R"(simulate SCENE.yaml --out DIR [options]
Runs the steps of a scene and writes what the tissue did to DIR; needs no ROS master.

  --out DIR         folder for nodes.csv, patches.csv, increments.csv, tools.csv and surface.stl,
                    for pieces.csv where tissue may part, for sutures.csv where a step sutures,
                    and for the states that steps save
  --method NAME     solver method, instead of the scene's solver.method
  --tolerance X     relative, 1e-9 to 0.5, instead of the scene's solver.tolerance
  --threads N       1 to 256, instead of the scene's solver.threads
  --max-seconds N   of the wall's clock, for the whole run: then the solve under way ends, what was
                    computed is written, the rest is not run
  --list-methods    prints the solver methods
  --list-models     prints the tissue models
  --quiet           no progress and no remarks on stderr
  --help            prints this

Exit code: 0 all increments OK; 2 bad arguments or scene, nothing written; 3 some increment not OK,
everything still written; 1 an unforeseen failure, nothing written.
)";
}

}  // namespace robot_tissue
