#include "robot_tissue/scene/command_line.h"

#include <algorithm>

#include "robot_tissue/scene/map_reader.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

[[noreturn]] void refuseOption(const std::string& option, const Options& options) {
  std::vector<std::string> all = options.with_value;
  all.insert(all.end(), options.switches.begin(), options.switches.end());
  const std::string nearest = nearestWord(option, all);
  throw InputError(onOneLine(option) + ": unknown option" +
                   (nearest.empty() ? "" : ", did you mean " + nearest + "?") +
                   ", must be one of " + joined(all));
}

void takeFile(const std::string& word, const Options& options, CommandLine& line) {
  if (word.empty() || line.files.size() == options.files.size()) {
    std::string names = options.files.size() == 1 ? "one" : "";
    for (const std::string& name : options.files) names += (names.empty() ? "" : " ") + name;
    throw InputError("\"" + shortText(word) + "\": must be " + names + " only");
  }
  line.files.push_back(word);
}

}  // namespace

std::string CommandLine::file(std::size_t number) const {
  return number < files.size() ? files[number] : "";
}

std::optional<std::string> CommandLine::value(const std::string& name) const {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : std::optional<std::string>(found->second);
}

CommandLine readCommandLine(const std::vector<std::string>& words, const Options& options) {
  CommandLine line;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.empty() || word.front() != '-') {
      takeFile(word, options, line);
      continue;
    }
    const std::size_t equals = word.find('=');
    const std::string name = word == "-h" ? "--help" : word.substr(0, equals);
    const bool takes_value = contains(options.with_value, name);
    if (!takes_value && !contains(options.switches, name)) refuseOption(name, options);
    if (!seen.insert(name).second) throw InputError(name + ": stands twice, must stand once");
    if (!takes_value) {
      if (equals != std::string::npos) throw InputError(name + ": must stand without a value");
      line.switches.insert(name);
      continue;
    }
    std::string value;
    if (equals != std::string::npos) {
      value = word.substr(equals + 1);
    } else if (i + 1 < words.size()) {
      value = words[++i];
      if (value.rfind("--", 0) == 0) {  // the next option
        throw InputError(name + ": must be followed by a value, not by " + onOneLine(value));
      }
    }
    if (value.empty()) throw InputError(name + ": must be followed by a value");
    line.values[name] = value;
  }
  return line;
}

}  // namespace robot_tissue
