// Numbers of tools, each once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace robot_tissue {

inline void addOnce(std::size_t tool, std::vector<std::size_t>& tools) {
  if (std::find(tools.begin(), tools.end(), tool) == tools.end()) tools.push_back(tool);
}

}  // namespace robot_tissue
