// As std::shared_ptr<const Value>, in the room of one pointer: every cell has two, and nearly all
// of them are null.
#pragma once

#include <atomic>
#include <cstddef>
#include <utility>

namespace robot_tissue {

template <typename Value>
class SharedConst {
 public:
  SharedConst() = default;
  explicit SharedConst(const Value& value) : counted_(new Counted{{1}, value}) {}
  SharedConst(const SharedConst& other) noexcept : counted_(other.counted_) {
    if (counted_ != nullptr) counted_->owners.fetch_add(1, std::memory_order_relaxed);
  }
  SharedConst(SharedConst&& other) noexcept : counted_(std::exchange(other.counted_, nullptr)) {}
  SharedConst& operator=(SharedConst other) noexcept {
    std::swap(counted_, other.counted_);
    return *this;
  }
  ~SharedConst() { reset(); }

  void reset() {
    Counted* const left = std::exchange(counted_, nullptr);
    if (left != nullptr && left->owners.fetch_sub(1, std::memory_order_acq_rel) == 1) delete left;
  }
  const Value* get() const { return counted_ == nullptr ? nullptr : &counted_->value; }
  const Value& operator*() const { return counted_->value; }
  const Value* operator->() const { return &counted_->value; }
  bool operator==(std::nullptr_t) const { return counted_ == nullptr; }
  bool operator!=(std::nullptr_t) const { return counted_ != nullptr; }

 private:
  struct Counted {
    std::atomic<int> owners;
    Value value;
  };

  Counted* counted_ = nullptr;
};

}  // namespace robot_tissue
