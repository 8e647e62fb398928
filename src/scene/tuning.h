// The numbers of the scene gate that are no legal ranges (those: robot_tissue/scene/ranges.h), in
// one place: unit, where each comes from, and what turning it does.
#pragma once

#include <cstddef>

namespace robot_tissue::tuning {

// Memory that a scene is foreseen to take; more: scenes are refused that would fit, less: the
// system ends a program whose scene does not. Bytes a node: lattice, springs, shape and surface,
// and the shapes kept along a tool's way. Measured, with some reserve.
constexpr double kBytesPerNode = 3000.0;
// Bytes a cell of the grid around a mesh, filled or not, besides the method's; a triangle of the
// mesh; and more, one that a membrane is on. Measured, with some reserve.
constexpr double kBytesPerGridCell = 45.0;
constexpr double kBytesPerTriangle = 500.0;
constexpr double kBytesPerMembraneTriangle = 2800.0;

// Nodes of a scene, whatever the memory: cells, of which there are fewer, are numbered with 27 bits
// (CellSet::Meeting), springs with 29. More, up to 2^27: less is left for the parts of cut cells.
constexpr double kMostNodes = 1e8;

// Bytes that are kept when they are free: of one array, at most (the C library takes no more), and
// of what is at the heap's end. More: a node that drew a large tissue once holds the more memory.
constexpr int kLargestKept = 32 << 20;
constexpr int kMostKept = 128 << 20;

// Refusals.
// Letters of a value that are shown. More: longer lines. Chosen.
constexpr std::size_t kLongestValue = 60;
// Letters of an unknown key for which a nearest one is looked for. More: slow refusals of long
// keys, which are no misspellings. Chosen.
constexpr std::size_t kLongestWord = 40;

}  // namespace robot_tissue::tuning
