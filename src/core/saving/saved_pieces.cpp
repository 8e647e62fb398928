#include "saving/saved_pieces.h"

#include <cstdint>
#include <vector>

#include "saving/checked_values.h"

namespace robot_tissue {
namespace {

void putAll(const std::vector<int>& numbers, ByteWriter& out) {
  out.count(numbers.size());
  for (const int number : numbers) out.index(number);
}

// None twice.
std::vector<int> takeAll(std::vector<char>& is_given, ByteReader& in) {
  std::vector<int> numbers(in.count(sizeof(std::uint32_t)));
  for (int& number : numbers) {
    const std::uint32_t taken = in.u32();
    if (taken >= is_given.size() || is_given[taken] != 0) {
      failAsDamaged("a piece's number is given twice, or was never given");
    }
    is_given[taken] = 1;
    number = static_cast<int>(taken);
  }
  return numbers;
}

}  // namespace

void putPieces(const PieceNumbers::Names& names, ByteWriter& out) {
  out.index(names.next);
  putAll(names.of_parts, out);
  putAll(names.dropped, out);
}

// Each new number is of nodes that had another one together with others: there are no more numbers
// than nodes.
PieceNumbers::Names takePieces(int pieces, int node_count, ByteReader& in) {
  const std::uint32_t next = in.u32();
  if (next > at(node_count)) failAsDamaged("it has more pieces than nodes");
  PieceNumbers::Names names;
  names.next = static_cast<int>(next);
  std::vector<char> is_given(next, 0);
  names.of_parts = takeAll(is_given, in);
  if (names.of_parts.size() != at(pieces)) {
    failAsDamaged("its pieces do not fit its severed springs");
  }
  names.dropped = takeAll(is_given, in);
  if (names.areCounted()) failAsDamaged("its pieces need no numbers");
  return names;
}

}  // namespace robot_tissue
