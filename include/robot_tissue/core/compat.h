// What older compilers than Debian 12's lack, in one place, so that no other file asks for
// versions: ROS Noetic's are GCC 9, CMake 3.16, FCL 0.6.1, Eigen 3.3.7, yaml-cpp 0.6. Never built
// there.
#pragma once

#include <malloc.h>

#include <charconv>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

// Functions compiled for several processors, by architecture level: GCC 12 and later on x86-64.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12
#define ROBOT_TISSUE_HAS_TARGET_CLONES 1
#else
#define ROBOT_TISSUE_HAS_TARGET_CLONES 0
#endif

// __builtin_shufflevector: GCC 12 and later, and Clang.
#if defined(__clang__) || (defined(__GNUC__) && __GNUC__ >= 12)
#define ROBOT_TISSUE_HAS_SHUFFLEVECTOR 1
#else
#define ROBOT_TISSUE_HAS_SHUFFLEVECTOR 0
#endif

// std::from_chars of floating-point numbers: GCC 11 and later.
#if defined(__cpp_lib_to_chars) && __cpp_lib_to_chars >= 201611L
#define ROBOT_TISSUE_HAS_FLOAT_FROM_CHARS 1
#else
#define ROBOT_TISSUE_HAS_FLOAT_FROM_CHARS 0
#endif

// mallinfo2, whose numbers are not int: glibc 2.33 and later.
#if defined(__GLIBC__) && defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 33)
#define ROBOT_TISSUE_HAS_MALLINFO2 1
#endif
#endif

namespace robot_tissue::compat {

// Bytes that were allocated and not freed, of all threads; 0: the C library does not tell.
inline double heapInUse() {
#if defined(ROBOT_TISSUE_HAS_MALLINFO2)
  const struct mallinfo2 heap = mallinfo2();
  return static_cast<double>(heap.uordblks) + static_cast<double>(heap.hblkhd);
#elif defined(__GLIBC__)
  const struct mallinfo heap = mallinfo();  // up to 4 GB
  return static_cast<double>(static_cast<unsigned>(heap.uordblks)) +
         static_cast<double>(static_cast<unsigned>(heap.hblkhd));
#else
  return 0.0;
#endif
}

// The whole word is a number, written as in C; false: it is none, or out of range. In any locale.
inline bool parsedByStream(std::string_view word, double& value) {
  if (word.empty() || word[0] == '+') return false;
  if (word.find_first_not_of("0123456789.eE+-") != std::string_view::npos) return false;
  std::istringstream stream{std::string(word)};
  stream.imbue(std::locale::classic());
  return (stream >> std::noskipws >> value) &&
         stream.peek() == std::istringstream::traits_type::eof();
}

template <class Number>
bool parsed(std::string_view word, Number& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

#if !ROBOT_TISSUE_HAS_FLOAT_FROM_CHARS
template <>
inline bool parsed<double>(std::string_view word, double& value) {
  return parsedByStream(word, value);
}
#endif

}  // namespace robot_tissue::compat
