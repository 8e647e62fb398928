// What the names of patches and sutures may be, in a scene and in a saved state.
#pragma once

#include <cstddef>

namespace robot_tissue {

constexpr std::size_t kLongestName = 64;  // bytes; none is empty

// Names are written in tables: commas, quotes and control characters are not allowed.
inline bool mayBeInName(char c) {
  return c != ',' && c != '"' && static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
}

}  // namespace robot_tissue
