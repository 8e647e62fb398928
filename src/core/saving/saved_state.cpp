#include "saving/saved_state.h"

#include <algorithm>

#include "cutting/split_cells.h"
#include "lattice/connectivity.h"
#include "saving/bytes.h"
#include "saving/saved_lattice.h"
#include "saving/saved_loads.h"
#include "saving/saved_pieces.h"
#include "saving/saved_sutures.h"

namespace robot_tissue {
namespace {

// As PNG's: a text editor, or a transfer that minds line ends, breaks it.
const std::string kMagic = {'R', 'T', 'S', 'T', '\r', '\n', '\x1a', '\n'};
// Newest that is read; the oldest that holds a state is the one that is written.
constexpr std::uint32_t kVersion = 7;
constexpr std::uint32_t kPlain = 1;
constexpr std::uint32_t kWithExtras = 2;
constexpr std::uint32_t kWithPieceNumbers = 3;
constexpr std::uint32_t kWithPartings = 4;
constexpr std::uint32_t kWithBites = 5;
constexpr std::uint32_t kWithFronts = 6;
// Bits of what later versions have more: the third from version 3 on, the fourth from 4 on, the
// fifth from 5 on, the sixth from 6 on, the seventh from 7 on.
constexpr std::uint8_t kHasRemovals = 1;
constexpr std::uint8_t kHasSutures = 2;
constexpr std::uint8_t kHasPieceNumbers = 4;
constexpr std::uint8_t kHasPartings = 8;
constexpr std::uint8_t kHasBites = 16;
constexpr std::uint8_t kHasFronts = 32;
constexpr std::uint8_t kHasDueLoads = 64;
constexpr std::size_t kHeaderBytes = 56;
constexpr std::size_t kBodyHashAt = 24;

std::string headerFor(const std::string& body, std::uint32_t version,
                      const StateFingerprint& fingerprint) {
  ByteWriter header;
  header.u32(version);
  header.u32(0);
  header.u64(body.size());
  header.u64(hashOf(body));
  header.u64(fingerprint.lattice);
  header.u64(fingerprint.scene);
  const std::string bytes = kMagic + header.bytes();
  ByteWriter check;
  check.u64(hashOf(bytes));
  return bytes + check.bytes();
}

struct Opened {
  std::string_view body;
  std::uint32_t version = 0;
  bool of_this_scene = false;
};

Opened open(std::string_view bytes, const StateFingerprint& fingerprint) {
  if (bytes.substr(0, kMagic.size()) != kMagic) refuseBytes("is no saved state");
  if (bytes.size() < kHeaderBytes) refuseBytes("ends too early");
  ByteReader header(bytes.substr(kMagic.size()));
  const std::uint32_t version = header.u32();
  if (version > kVersion) {
    throw InputError("is of version " + std::to_string(version) + "; allowed: up to " +
                     std::to_string(kVersion));
  }
  header.u32();
  const std::uint64_t size = header.u64(), body_hash = header.u64();
  const std::uint64_t lattice = header.u64(), scene = header.u64();
  if (version == 0 || header.u64() != hashOf(bytes.substr(0, kHeaderBytes - 8))) {
    failAsDamaged("the header does not fit its checksum");
  }
  const std::string_view body = bytes.substr(kHeaderBytes);
  if (body.size() < size) refuseBytes("ends too early");
  if (body.size() > size || hashOf(body) != body_hash) {
    failAsDamaged("the content does not fit its checksum");
  }
  if (lattice != fingerprint.lattice) {
    throw InputError(
        "is of another lattice; allowed: a state of the same shape, spacing, model "
        "and fixed nodes");
  }
  return {body, version, scene == fingerprint.scene};
}

std::uint8_t extrasOf(const SavedState& state) {
  std::uint8_t extras = 0;
  if (!state.lattice.taken.empty()) extras |= kHasRemovals;
  if (!state.sutures.empty()) extras |= kHasSutures;
  if (!state.pieces.areCounted()) extras |= kHasPieceNumbers;
  if (!state.lattice.parted_at.empty()) extras |= kHasPartings;
  if (haveBites(state.sutures)) extras |= kHasBites;
  if (!state.lattice.ahead.empty()) extras |= kHasFronts;
  if (!state.due.empty()) extras |= kHasDueLoads;
  return extras;
}

// The lowest version that holds these.
std::uint32_t versionOf(std::uint8_t extras) {
  if (extras == 0) return kPlain;
  if ((extras & kHasDueLoads) != 0) return kVersion;
  if ((extras & kHasFronts) != 0) return kWithFronts;
  if ((extras & kHasBites) != 0) return kWithBites;
  if ((extras & kHasPartings) != 0) return kWithPartings;
  return (extras & kHasPieceNumbers) != 0 ? kWithPieceNumbers : kWithExtras;
}

std::uint8_t takeExtras(std::uint32_t version, ByteReader& in) {
  if (version == kPlain) return 0;
  const std::uint8_t extras = in.u8();
  const unsigned all = kHasRemovals | kHasSutures | kHasPieceNumbers | kHasPartings | kHasBites |
                       kHasFronts | kHasDueLoads;
  const bool has_lost_bites = (extras & kHasBites) != 0 && (extras & kHasSutures) == 0;
  if (extras > all || versionOf(extras) != version || has_lost_bites) {
    failAsDamaged("it has nothing of its version, or more");
  }
  return extras;
}

void requireNotRemoved(const LatticeState& state, const LoadingPatch& load) {
  const auto is_gone = [&](int node) { return isRemoved(state, node); };
  const auto springs_gone = [&](const RimSpring& spring) { return is_gone(spring.node); };
  if (std::any_of(load.nodes.begin(), load.nodes.end(), is_gone) ||
      std::any_of(load.rim.begin(), load.rim.end(), springs_gone)) {
    failAsDamaged("a load is on a removed node");
  }
}

// A rim's springs are as stiff as the tissue that they were made for.
void requireNoRims(const std::vector<LoadingPatch>& loads) {
  const auto has_rim = [](const LoadingPatch& load) { return !load.rim.empty(); };
  if (std::none_of(loads.begin(), loads.end(), has_rim)) return;
  throw InputError(
      "has loads, and was saved with another material, regions, gravity, method or tolerance; "
      "allowed: a state without named loads, or of the same ones");
}

}  // namespace

std::uint64_t fingerprintOf(const Lattice& lattice, SplitCells split) {
  ByteWriter out;
  out.u8(split == SplitCells::kParted ? 1 : 0);
  out.f64(lattice.spacing());
  out.vec3(lattice.bounds().min());
  for (const int points : lattice.size()) out.index(points);
  for (const Cell& cell : lattice.cells()) {
    for (const int index : lattice.gridIndex(cell.nodes.front())) out.index(index);
    out.u32(static_cast<std::uint32_t>(millionthsOf(cell)));
  }
  for (int node = 0; node < lattice.nodeCount(); ++node) out.u8(lattice.isFixed(node) ? 1 : 0);
  return hashOf(out.bytes());
}

std::string encodeState(const Lattice& lattice, SplitCells split, const SavedState& state,
                        const StateFingerprint& fingerprint) {
  ByteWriter body;
  body.index(lattice.nodeCount());
  body.count(state.lattice.severed.size());
  putSevered(state.lattice, body);
  const std::uint8_t extras = extrasOf(state);
  if (extras != 0) body.u8(extras);
  if ((extras & kHasPartings) != 0) putPartings(state.lattice, body);
  if ((extras & kHasRemovals) != 0) putRemovals(state.lattice, body);
  if ((extras & kHasFronts) != 0) putFronts(state.lattice, body);
  putGhosts(lattice, split, state.lattice, body);
  for (const Vec3& displacement : state.lattice.displacement) body.vec3(displacement);
  putLoads(state.loads, body);
  body.u8(state.in_balance ? 1 : 0);
  putReport(state.report, body);
  if ((extras & kHasSutures) != 0) putSutures(state.sutures, body);
  if ((extras & kHasPieceNumbers) != 0) putPieces(state.pieces, body);
  if ((extras & kHasBites) != 0) putBites(state.sutures, body);
  if ((extras & kHasDueLoads) != 0) putLoads(state.due, body);
  return headerFor(body.bytes(), versionOf(extras), fingerprint) + body.bytes();
}

SavedState decodeState(const Lattice& lattice, SplitCells split, std::string_view bytes,
                       const StateFingerprint& fingerprint) {
  const Opened opened = open(bytes, fingerprint);
  ByteReader in(opened.body);
  SavedState saved;
  LatticeState& state = saved.lattice;
  const std::size_t springs = lattice.springs().size();
  if (in.u32() != at(lattice.nodeCount()) || in.u32() != springs) {
    failAsDamaged("it has other numbers of nodes and springs than its lattice");
  }
  takeSevered(springs, state, in);
  const std::uint8_t extras = takeExtras(opened.version, in);
  if ((extras & kHasPartings) != 0) takePartings(state, in);
  if ((extras & kHasRemovals) != 0) takeRemovals(lattice, state, in);
  if ((extras & kHasFronts) != 0) takeFronts(lattice, state, in);
  state.pieces = countPieces(lattice, state);
  state.cells = takeCells(lattice, split, state, in);
  takeDisplacement(lattice, state, in);
  saved.loads = takeLoads(lattice, in);
  for (const LoadingPatch& load : saved.loads) requireNotRemoved(state, load);
  if (!opened.of_this_scene) requireNoRims(saved.loads);
  // Where a blade passed, older versions did not keep: what they hold is balanced anew.
  const bool is_older = state.springs_cut > 0 && (extras & kHasPartings) == 0;
  saved.in_balance = in.u8() == 1 && opened.of_this_scene && !is_older;
  saved.report = takeReport(saved.loads.size(), in);
  if ((extras & kHasSutures) != 0) saved.sutures = takeSutures(state.cells->nodeCount(), in);
  saved.pieces = (extras & kHasPieceNumbers) != 0
                     ? takePieces(state.pieces, lattice.nodeCount(), in)
                     : PieceNumbers::counted(state.pieces);
  if ((extras & kHasBites) != 0) takeBites(saved.sutures, in);
  if ((extras & kHasDueLoads) != 0) saved.due = takeDueLoads(lattice, saved.loads, in);
  for (const LoadingPatch& load : saved.due) requireNotRemoved(state, load);
  saved.in_balance = saved.in_balance && saved.due.empty();
  if (!in.isAtEnd()) failAsDamaged("something follows its end");
  return saved;
}

std::uint64_t stateHash(std::string_view encoded) {
  return ByteReader(encoded.substr(kBodyHashAt)).u64();
}

}  // namespace robot_tissue
