// The numbers of grids and meshes in one place: unit, where each comes from, and what turning it
// does. Chosen: by judgment, and kept as the tests of geometry passed; no other value was measured
// against it.
#pragma once

#include <cstddef>

namespace robot_tissue::tuning {

// Of the spacing (1): how far a box's side may be off a node or a cell's center and still hold it,
// and an extent off whole spacings. More: boxes typed with few digits hold what was meant; from a
// half on, one holds its neighbor's. Chosen.
constexpr double kBoxSlack = 1e-3;
// Spacings (1): how far a mesh reaches into a cell at least, and which share of it at least it
// fills, to make it one of the tissue. More: thin ends are lost; less: cells with next to nothing.
// Chosen.
constexpr double kCellSlack = 1e-3;
// Share of a cell (1): nearer to 0 or 1, it is that. Rounding.
constexpr double kShareRounding = 1e-9;
// Of a mesh's largest extent (1): vertices that are nearer are one. More: fine detail is joined;
// less: corners that a file rounds stay open. Chosen: single precision's digits.
constexpr double kWeld = 1e-6;
// Of a mesh's largest extent cubed (1): with less volume it is flat, and refused. More: thin sheets
// are refused; less: their inside is rounding. Chosen.
constexpr double kFlatShare = 1e-9;
// Whole parts of the shortest side, beyond those asked for, that are tried for a spacing that fits.
// More: a proposal in more refusals, later. Chosen.
constexpr double kMostTriedParts = 10000.0;

// Rays through a mesh that tell how thick it is (1): more: walls that are a small part of the
// surface are met, slower; the products of rays and triangles cost 10 ns each. Chosen.
constexpr std::size_t kMostRays = 300, kLeastRays = 30, kMostRayTests = 10000000;
// Cosine between the normals of two faces, one turned round: less, the edge of a body counts as a
// wall; more, walls of uneven thickness do not. Chosen: 45 degrees.
constexpr double kNearlyParallel = 0.7;

}  // namespace robot_tissue::tuning
