// The three formats, read strictly: a file that is not wholly what it should be is refused. All
// throw InputError whose text is a reason ("line 3: ...").
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

constexpr std::size_t kMostTriangles = 2000000;  // as many as a binary STL of 100 MB has

// Binary or text; the count of a binary one's triangles must be that of its bytes.
TriangleMesh readStl(const std::string& bytes);

// Vertices and faces; nothing of materials, textures and curves.
TriangleMesh readObj(const std::string& bytes);

// COLLADA: the geometries of its scene, placed by its nodes. Unit and up axis count for nothing.
TriangleMesh readDae(const std::string& bytes);

// What a DAE file says of itself and nobody heeds; where it says nothing, the default is as if it
// were so.
struct DaeAsset {
  double unit = 1.0;  // m
  std::string up_axis = "Z_UP";
};
DaeAsset readDaeAsset(const std::string& bytes);

// What a file says, for a message: ASCII on one line, cut short after so many characters.
std::string printable(std::string_view text, std::size_t longest);

// Throws where so many triangles more are too many.
void requireRoomFor(std::size_t triangles, const TriangleMesh& mesh);

// Appends the triangles of a polygon of three corners or more, convex or not.
void appendPolygon(const std::vector<int>& corners, TriangleMesh& mesh);

// Without the mark that some editors put before a text (UTF-8).
std::string_view withoutMark(std::string_view text);

// The next word between blanks, taken off the front of `text`; empty at its end.
std::string_view takeWord(std::string_view& text);

// A number as a whole word, in the notation of C.
double toReal(std::string_view word);
int toWhole(std::string_view word);

}  // namespace robot_tissue
