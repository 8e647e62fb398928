// What edges sweep, and what becomes of the world where they cut.
#pragma once

#include <vector>

#include "robot_tissue/core/tissue.h"
#include "world.h"

namespace robot_tissue {

// Adds what the edge, a polyline in its tool's frame (m), sweeps from pose to pose (tissue_T_tool);
// arcs as chords of kLongestArc at most.
void addSwept(const std::vector<Vec3>& edge, const std::vector<Pose>& path,
              std::vector<CutTriangle>& swept);

// Halves a path that is longer than kMostOfDent poses: its first and its last one stay.
void keepShort(std::vector<Pose>& path);

// Contacts begin anew, and the report counts it.
void noteCut(World& world, const CutReport& cut);

}  // namespace robot_tissue
