// Numbers in a row that begins where a vector of any processor may begin: what lies across two
// lines of the cache is read twice.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace robot_tissue {

template <typename Value>
struct LineAllocator {
  using value_type = Value;
  static constexpr std::align_val_t kLine{64};

  LineAllocator() = default;
  template <typename Other>
  LineAllocator(const LineAllocator<Other>& /*unused*/) {}

  Value* allocate(std::size_t count) {
    return static_cast<Value*>(::operator new(count * sizeof(Value), kLine));
  }
  void deallocate(Value* values, std::size_t /*unused*/) { ::operator delete(values, kLine); }
  friend bool operator==(const LineAllocator& /*unused*/, const LineAllocator& /*unused*/) {
    return true;
  }
  friend bool operator!=(const LineAllocator& /*unused*/, const LineAllocator& /*unused*/) {
    return false;
  }
};

template <typename Real>
using Numbers = std::vector<Real, LineAllocator<Real>>;

}  // namespace robot_tissue
