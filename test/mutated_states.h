// Saved states with some of their bytes changed at random, always the same ones.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include "saving/bytes.h"

namespace robot_tissue {

// Of the header (doc/state_file.md).
constexpr std::size_t kHeaderBytes = 56;
constexpr std::size_t kVersionAt = 8, kSizeAt = 16, kBodyHashAt = 24, kHeaderHashAt = 48;

inline void putNumber(std::string& bytes, std::size_t place, std::uint64_t value) {
  for (std::size_t i = 0; i < 8; ++i) bytes[place + i] = static_cast<char>(value >> 8 * i);
}

// So that the content is looked at, too.
inline std::string withChecksums(std::string bytes) {
  putNumber(bytes, kSizeAt, bytes.size() - kHeaderBytes);
  putNumber(bytes, kBodyHashAt, hashOf(std::string_view(bytes).substr(kHeaderBytes)));
  putNumber(bytes, kHeaderHashAt, hashOf(std::string_view(bytes).substr(0, kHeaderHashAt)));
  return bytes;
}

class MutatedStates {
 public:
  MutatedStates(std::string good, unsigned seed) : good_(std::move(good)), random_(seed) {}

  // Up to three bytes of the body are others, sometimes it is cut short or longer; mostly with
  // checksums that fit, so that nothing but what is read stands between the bytes and the tissue.
  std::string next() {
    std::string bytes = good_;
    for (std::size_t changes = 1 + below(3); changes > 0; --changes) {
      // Half of them where counts and indices are, before and after the displacements.
      const std::size_t place = kHeaderBytes + (below(2) == 0 ? below(400) : below(bodyOf(bytes)));
      bytes[place] = static_cast<char>(below(256));
    }
    if (below(8) == 0) bytes.resize(kHeaderBytes + below(bodyOf(bytes)));
    if (below(8) == 0)
      bytes.insert(std::min(bytes.size(), kHeaderBytes + below(300)), below(9), '\x7f');
    return below(4) == 0 ? bytes : withChecksums(bytes);
  }

 private:
  static std::size_t bodyOf(const std::string& bytes) { return bytes.size() - kHeaderBytes; }
  std::size_t below(std::size_t most) {
    return std::uniform_int_distribution<std::size_t>(0, most - 1)(random_);
  }

  std::string good_;
  std::mt19937 random_;
};

}  // namespace robot_tissue
