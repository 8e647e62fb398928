#include <algorithm>
#include <array>

#include "mesh_formats.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {
namespace {

// What else a line may begin with; none of it is part of the surface of triangles.
constexpr std::array<std::string_view, 42> kOtherWords = {
    "vt",    "vn",       "vp",       "p",          "l",         "o",      "g",
    "s",     "mg",       "usemtl",   "mtllib",     "usemap",    "maplib", "lod",
    "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj", "cstype", "deg",
    "bmat",  "step",     "curv",     "curv2",      "surf",      "parm",   "trim",
    "hole",  "scrv",     "sp",       "end",        "con",       "call",   "csh",
    "ctech", "stech",    "bsp",      "bzp",        "cdc",       "cdp",    "res"};

class ObjReader {
 public:
  TriangleMesh read(std::string_view text) {
    while (!text.empty()) {
      ++line_;
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      try {
        readLine(line);
      } catch (const InputError& error) {
        throw InputError("line " + std::to_string(line_) + ": " + error.what());
      }
    }
    return std::move(mesh_);
  }

 private:
  void readLine(std::string_view line) {
    line = line.substr(0, std::min(line.find('#'), line.size()));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    const bool goes_on = !line.empty() && line.back() == '\\';
    if (goes_on) line.remove_suffix(1);
    if (goes_on || !begun_.empty()) {
      begun_.append(line).append(" ");
      if (goes_on) return;
      const std::string whole = std::move(begun_);
      begun_.clear();
      return readStatement(whole);
    }
    readStatement(line);
  }

  void readStatement(std::string_view line) {
    const std::string_view word = takeWord(line);
    if (word == "v") {
      readVertex(line);
    } else if (word == "f" || word == "fo") {
      readFace(line);
    } else if (!word.empty() &&
               std::find(kOtherWords.begin(), kOtherWords.end(), word) == kOtherWords.end()) {
      throw InputError("begins with no word of an OBJ file");
    }
  }

  // Further numbers are a weight or a color.
  void readVertex(std::string_view line) {
    Vec3 vertex;
    for (int axis = 0; axis < 3; ++axis) vertex[axis] = toReal(takeWord(line));
    mesh_.vertices.push_back(vertex);
  }

  void readFace(std::string_view line) {
    corners_.clear();
    for (auto word = takeWord(line); !word.empty(); word = takeWord(line)) {
      corners_.push_back(vertexOf(word.substr(0, std::min(word.find('/'), word.size()))));
    }
    appendPolygon(corners_, mesh_);
  }

  // From 1, or from the last one back where it is negative.
  int vertexOf(std::string_view word) const {
    const int number = toWhole(word);
    const int count = static_cast<int>(mesh_.vertices.size());
    const bool exists = number > 0 ? number <= count : number < 0 && number >= -count;
    if (exists) return number > 0 ? number - 1 : count + number;
    throw InputError("vertex " + std::to_string(number) + " of a face is none of the " +
                     std::to_string(count) + " before it");
  }

  TriangleMesh mesh_;
  std::string begun_;  // a statement that goes on in the next line
  std::vector<int> corners_;
  int line_ = 0;
};

}  // namespace

TriangleMesh readObj(const std::string& bytes) { return ObjReader().read(withoutMark(bytes)); }

}  // namespace robot_tissue
