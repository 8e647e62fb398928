// Numbers of pieces as bytes and back. What is taken is checked: it throws InputError for numbers
// that no cuts give.
#pragma once

#include "lattice/piece_numbers.h"
#include "saving/bytes.h"

namespace robot_tissue {

void putPieces(const PieceNumbers::Names& names, ByteWriter& out);
// `pieces`: how many the state has, of so many nodes of a lattice.
PieceNumbers::Names takePieces(int pieces, int node_count, ByteReader& in);

}  // namespace robot_tissue
