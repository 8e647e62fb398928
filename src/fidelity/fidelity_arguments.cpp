#include "fidelity_arguments.h"

#include <algorithm>

#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/command_line.h"
#include "robot_tissue/scene/entry.h"
#include "robot_tissue/scene/map_reader.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

double numberOf(const CommandLine& line, const std::string& option, double otherwise,
                const Range& range) {
  const auto text = line.value(option);
  if (!text) return otherwise;
  return Entry(YAML::Node(*text), option, "").number(range);
}

std::string methodOf(const CommandLine& line, const std::string& otherwise) {
  const auto text = line.value("--method");
  if (!text) return otherwise;
  return Entry(YAML::Node(*text), "--method", "").choice(methodsFor("elastic"));
}

}  // namespace

FidelityArguments parseFidelityArguments(const std::vector<std::string>& words) {
  const CommandLine line = readCommandLine(
      words, {{"--error", "--rate", "--seconds", "--way", "--method", "--write", "--csv"},
              {"--quiet", "--help"}});
  FidelityArguments parsed;
  parsed.scene = line.file(0);
  parsed.help = line.has("--help");
  parsed.quiet = line.has("--quiet");
  parsed.write = line.value("--write").value_or("");
  parsed.csv = line.value("--csv").value_or("");
  if (parsed.help) return parsed;
  const std::string usage = ", must be fidelity SCENE.yaml --error X --rate HZ (see --help)";
  if (parsed.scene.empty()) throw InputError("SCENE.yaml is missing" + usage);
  for (const char* needed : {"--error", "--rate"}) {
    if (!line.value(needed)) throw InputError(std::string(needed) + " is missing" + usage);
  }
  parsed.error = numberOf(line, "--error", parsed.error, Range{1e-9, 1.0, ""});
  parsed.rate = numberOf(line, "--rate", parsed.rate, Range{1e-3, 1e9, "Hz"});
  parsed.seconds = numberOf(line, "--seconds", parsed.seconds, Range{1e-3, 1e6, "s"});
  parsed.way_an_update = numberOf(line, "--way", parsed.way_an_update, Range{1e-9, 1e3, "m"});
  parsed.method = methodOf(line, parsed.method);
  return parsed;
}

std::string fidelityHelp() {
  return R"(fidelity SCENE.yaml --error X --rate HZ [options]
Tries the scene on coarser and finer lattices, estimates the error of each, measures what an update
costs on this machine, and names the cheapest that meets both.

  --error X         relative error allowed of displacements and forces, 1e-9 to 1
  --rate HZ         updates a second that are wanted
  --write OUT.yaml  writes the scene with what was chosen
  --seconds N       how long measuring may take (60); what does not fit in is not tried
  --way M           what a tool or patch moves between two updates, in m (0.001), where a step of
                    the scene has no increments
  --method NAME     solver method that is tried (layered)
  --csv FILE        writes the table as CSV
  --quiet           no progress and no remarks on stderr
  --help            prints this

A scene without steps is pressed once to find out. Exit code: 0 one meets both; 3 none does, what
comes nearest is said; 2 bad arguments or scene; 1 an unforeseen failure.
)";
}

}  // namespace robot_tissue
