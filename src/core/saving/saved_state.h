// Topology and shape as bytes, and back: for files, for taking steps back, and as a fingerprint of
// a state. The format is told in doc/state_file.md.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/piece_numbers.h"
#include "loads/suture_thread.h"
#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/solve_report.h"

namespace robot_tissue {

struct SavedState {
  LatticeState lattice;
  PieceNumbers::Names pieces;
  std::vector<LoadingPatch> loads;  // the named ones
  std::vector<LoadingPatch> due;    // what those of them go to that are on their way
  std::vector<SutureThread> sutures;
  SolveReport report;       // status, residual, error estimate and answers of the loads
  bool in_balance = false;  // the shape is the one under these loads alone
};

// What a saved state is of. `lattice`: nodes, cells, what is fixed, what cuts do. `scene`: what the
// balance hangs on beside that.
struct StateFingerprint {
  std::uint64_t lattice = 0;
  std::uint64_t scene = 0;
};
std::uint64_t fingerprintOf(const Lattice& lattice, SplitCells split);

std::string encodeState(const Lattice& lattice, SplitCells split, const SavedState& state,
                        const StateFingerprint& fingerprint);

// Throws InputError, with the reason alone ("ends too early"), for bytes that are no state of this
// lattice. A state of another scene with the same lattice is not in balance.
SavedState decodeState(const Lattice& lattice, SplitCells split, std::string_view bytes,
                       const StateFingerprint& fingerprint);

// Of two states of one lattice: the same only when topology, shape and loads are, bit for bit.
std::uint64_t stateHash(std::string_view encoded);

}  // namespace robot_tissue
