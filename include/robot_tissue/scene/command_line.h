// Words of a command line, sorted into options, switches and files. All programs read theirs so.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace robot_tissue {

struct CommandLine {
  std::vector<std::string> files;             // words that are no options
  std::map<std::string, std::string> values;  // of the options given, never empty
  std::set<std::string> switches;             // those given

  std::string file(std::size_t number) const;  // from 0; empty where there are fewer
  bool has(const std::string& name) const { return switches.count(name) > 0; }
  std::optional<std::string> value(const std::string& name) const;
};

// What a program's command line may hold: options with a value (as "--out DIR" or "--out=DIR") and
// switches without.
struct Options {
  std::vector<std::string> with_value;
  std::vector<std::string> switches;                // -h is taken as --help
  std::vector<std::string> files = {"SCENE.yaml"};  // at most so many, and what they are called
};

// Throws InputError, one line: an unknown or repeated option, a value too few or too many, a file
// too many.
CommandLine readCommandLine(const std::vector<std::string>& words, const Options& options);

}  // namespace robot_tissue
