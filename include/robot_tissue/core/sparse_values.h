// Values of the few numbers out of many that were asked for: four bytes for each number, and the
// values themselves in a row that grows as they come (Briggs and Torczon 1993, "An efficient
// representation for sparse sets"). To forget them all takes no pass over the numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

template <typename Value>
class SparseValues {
 public:
  // None has a value from now on; they go from 0 to before `count`.
  void clearFor(std::size_t count) {
    slots_.resize(count);
    entries_.clear();
  }

  // Null where it has none. It stays where it is until the next add().
  Value* find(int number) {
    const std::size_t slot = slots_[at(number)];
    const bool has_value = slot < entries_.size() && entries_[slot].number == number;
    return has_value ? &entries_[slot].value : nullptr;
  }
  // Of a number that has none.
  Value& add(int number) {
    slots_[at(number)] = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back({number, Value()});
    return entries_.back().value;
  }

 private:
  struct Entry {
    int number;
    Value value;
  };

  std::vector<std::uint32_t> slots_;  // per number: where its entry is, if it has one
  std::vector<Entry> entries_;
};

}  // namespace robot_tissue
