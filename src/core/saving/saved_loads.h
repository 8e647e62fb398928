// Loading patches, and what a solve said of them, as bytes and back. What is taken is checked: it
// throws InputError for what no scene could have made.
#pragma once

#include <vector>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/solve_report.h"
#include "saving/bytes.h"
#include "saving/checked_values.h"

namespace robot_tissue {

void putLoads(const std::vector<LoadingPatch>& loads, ByteWriter& out);
std::vector<LoadingPatch> takeLoads(const Lattice& lattice, ByteReader& in);
// Where some of these loads go.
std::vector<LoadingPatch> takeDueLoads(const Lattice& lattice,
                                       const std::vector<LoadingPatch>& loads, ByteReader& in);

void putReport(const SolveReport& report, ByteWriter& out);
SolveReport takeReport(std::size_t loads, ByteReader& in);

}  // namespace robot_tissue
