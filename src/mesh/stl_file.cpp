#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>

#include "mesh_formats.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kTriangleBytes = 50;  // normal, corners, attribute

std::uint32_t littleEndian(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

double realAt(const char* bytes) {
  const std::uint32_t bits = littleEndian(bytes);
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof(value));
  return static_cast<double>(value);
}

void appendTriangle(const std::array<Vec3, 3>& corners, TriangleMesh& mesh) {
  requireRoomFor(1, mesh);
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

TriangleMesh readBinary(const std::string& bytes) {
  TriangleMesh mesh;
  for (std::size_t at = kHeaderBytes + 4; at < bytes.size(); at += kTriangleBytes) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 9; ++i) {
      corners[i / 3][static_cast<Eigen::Index>(i % 3)] = realAt(&bytes[at + 12 + 4 * i]);
    }
    appendTriangle(corners, mesh);
  }
  return mesh;
}

class TextReader {
 public:
  explicit TextReader(std::string_view text) : text_(text) {}

  TriangleMesh read() {
    std::string_view word = takeWord(text_);
    do {
      require(word, "solid");
      skipLine();  // its name
      for (word = takeWord(text_); is(word, "facet"); word = takeWord(text_)) readFacet();
      require(word, "endsolid");
      skipLine();
      word = takeWord(text_);
    } while (!word.empty());
    return std::move(mesh_);
  }

 private:
  static bool is(std::string_view word, std::string_view expected) {
    return std::equal(word.begin(), word.end(), expected.begin(), expected.end(),
                      [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
  }
  static void require(std::string_view word, const char* expected) {
    if (is(word, expected)) return;
    throw InputError(word.empty() ? "ends before '" + std::string(expected) + "'"
                                  : "is neither a binary STL, whose size is that of its triangles, "
                                    "nor a text: '" +
                                        std::string(expected) + "' is missing");
  }
  void take(const char* expected) { require(takeWord(text_), expected); }
  void skipLine() { text_.remove_prefix(std::min(text_.find('\n'), text_.size())); }
  Vec3 takeVector() {
    const double x = toReal(takeWord(text_));
    const double y = toReal(takeWord(text_));
    return {x, y, toReal(takeWord(text_))};
  }

  void readFacet() {
    take("normal");
    for (int i = 0; i < 3; ++i) takeWord(text_);  // not used, and often no number
    take("outer");
    take("loop");
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      take("vertex");
      corner = takeVector();
    }
    take("endloop");
    take("endfacet");
    appendTriangle(corners, mesh_);
  }

  std::string_view text_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh readStl(const std::string& bytes) {
  const bool has_count = bytes.size() >= kHeaderBytes + 4;
  const std::size_t count = has_count ? littleEndian(&bytes[kHeaderBytes]) : 0;
  if (has_count && bytes.size() == kHeaderBytes + 4 + kTriangleBytes * count) {
    return readBinary(bytes);
  }
  return TextReader(withoutMark(bytes)).read();
}

}  // namespace robot_tissue
