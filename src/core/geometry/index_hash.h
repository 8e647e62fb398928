// Of a few numbers that name something, for unordered maps (FNV-1a, Fowler, Noll and Vo 1991, a
// number at a time, its upper bits brought down at the end).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace robot_tissue {

struct IndexHash {
  template <std::size_t N>
  std::size_t operator()(const std::array<int, N>& indices) const {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const int index : indices) {
      hash ^= static_cast<std::uint32_t>(index);
      hash *= 1099511628211ULL;
    }
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

}  // namespace robot_tissue
