// The text of a scene as a tree of values, refused before it fills the memory.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace robot_tissue {

// `source` begins messages. Throws InputError: no YAML, more than one document, or more values than
// kMostValues when every alias is followed.
YAML::Node parseYaml(const std::string& text, const std::string& source);

constexpr double kMostValues = 1e6;

}  // namespace robot_tissue
