// How much memory a scene takes, and how much this process may still have.
#pragma once

#include <string>

#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

// Bytes that the machine has left, or what a container (cgroup, version 1 or 2) or a limit of the
// process (ulimit -v, -d) leaves of them. `root`: where /proc and /sys are looked for.
double freeMemory(const std::string& root = "");

// Bytes that this process has in the machine's memory now.
double residentMemory();

// Bytes of it that the heap's users hold: what grows for hours is kept by somebody. Pages with
// gaps, and pages that the heap keeps for later, are in the memory of the process only. 0: not
// known.
double heapInUse();

// From now on what is freed stays with the heap, up to some megabytes, for who asks next. The
// system gives memory page by page, as each is first written to: of an array of a megabyte, asked
// for anew with each drawn frame, that takes longer than to fill it.
void keepFreeMemory();

// Whole pages of the heap that nothing is in go back to the system, also from between what stays.
void giveBackFreeMemory();

// Bytes that a lattice of so many nodes takes with its shape, surface and solver. Method "", here
// and below: what it takes with any of them.
double memoryOf(double nodes, const std::string& method);

// The most nodes whose memory is within `bytes`, and whose cells and springs can be numbered.
double mostNodes(double bytes, const std::string& method);

// About how many nodes a mesh holds.
double nodesWithin(const TriangleMesh& mesh, double spacing);

// Bytes besides those of the nodes: of membranes, and where the tissue is a mesh of the grid around
// it, also where it is empty, and of its surface when its triangles are no larger than the spacing.
double memoryAround(const TissueConfig& tissue, const std::string& method);

}  // namespace robot_tissue
