// Numbers as bytes, little endian on every machine, and back. What is read is never more than is
// there.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

class ByteWriter {
 public:
  void u8(std::uint8_t value) { bytes_ += static_cast<char>(value); }
  void u32(std::uint32_t value) { put(value); }
  void u64(std::uint64_t value) { put(value); }
  void index(int value) { put(static_cast<std::uint32_t>(value)); }
  void count(std::size_t value) { put(static_cast<std::uint32_t>(value)); }
  void f64(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    put(bits);
  }
  void vec3(const Vec3& value) {
    for (const double component : value) f64(component);
  }
  void text(const std::string& value) {
    count(value.size());
    bytes_ += value;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class Number>
  void put(Number value) {
    static_assert(std::is_unsigned<Number>::value, "bytes of a number without a sign");
    for (std::size_t byte = 0; byte < sizeof(value); ++byte) {
      bytes_ += static_cast<char>(static_cast<unsigned char>(value >> (8 * byte)));
    }
  }

  std::string bytes_;
};

// Of bytes that are no state, or no longer one.
[[noreturn]] inline void refuseBytes(const std::string& problem) {
  throw InputError(problem + "; allowed: a file as it was saved, whole and unchanged");
}

// Throws InputError where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::uint8_t u8() { return get<std::uint8_t>(); }
  std::uint32_t u32() { return get<std::uint32_t>(); }
  std::uint64_t u64() { return get<std::uint64_t>(); }
  // Of things that take so many bytes each at least: so many must be left.
  std::size_t count(std::size_t bytes_each) {
    const std::size_t value = u32();
    if (value > bytes_.size() / bytes_each) failAtEnd();
    return value;
  }
  double f64() {
    const std::uint64_t bits = u64();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  Vec3 vec3() {
    Vec3 value;
    for (double& component : value) component = f64();
    return value;
  }
  std::string text() { return std::string(take(count(1))); }
  bool isAtEnd() const { return bytes_.empty(); }

 private:
  [[noreturn]] static void failAtEnd() { refuseBytes("ends too early"); }

  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) failAtEnd();
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  template <class Number>
  Number get() {
    Number value = 0;
    std::size_t byte = 0;
    for (const char each : take(sizeof(Number))) {
      value = static_cast<Number>(value | static_cast<Number>(static_cast<unsigned char>(each))
                                              << 8 * byte++);
    }
    return value;
  }

  std::string_view bytes_;
};

// FNV-1a, 64 bits: against damage and mix-ups, not against forgery.
class Hash {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) {
      value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

inline std::uint64_t hashOf(std::string_view bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

}  // namespace robot_tissue
