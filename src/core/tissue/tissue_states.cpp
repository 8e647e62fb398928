#include "tissue/tissue_states.h"

#include <algorithm>
#include <string>
#include <utility>

#include "cutting/removal.h"
#include "cutting/split_cells.h"
#include "lattice/connectivity.h"
#include "material/tissue_model.h"
#include "saving/bytes.h"
#include "saving/saved_state.h"
#include "tissue/partings.h"
#include "tissue/registry.h"

namespace robot_tissue {
namespace {

void add(const Material& material, ByteWriter& out) {
  out.f64(material.young_modulus);
  out.f64(material.poisson_ratio);
  out.f64(material.density);
  out.f64(material.spring_stiffness.value_or(-1.0));
  if (material.law == Material::Law::kFung) out.f64(material.stiffening);
}

void add(const Region& region, ByteWriter& out) {
  out.vec3(region.box.min());
  out.vec3(region.box.max());
  if (region.mesh) {
    for (const Vec3& vertex : region.mesh->vertices) out.vec3(vertex);
    for (const MeshTriangle& triangle : region.mesh->triangles) {
      for (const int corner : triangle) out.index(corner);
    }
  }
  add(region.material, out);
}

void add(const MembraneConfig& membrane, ByteWriter& out) {
  out.f64(membrane.thickness);
  out.f64(membrane.young_modulus);
  out.f64(membrane.poisson_ratio);
  out.f64(membrane.pressure);
  out.u32(static_cast<std::uint32_t>(membrane.side));
  for (const Box& box : membrane.boxes) {
    out.vec3(box.min());
    out.vec3(box.max());
  }
}

// Rim springs are as stiff as the shear modulus at their nodes (loads/patch_rim.h); exact where all
// cells at a node have one Poisson's ratio.
void scaleRim(const LatticeState& state, const TissueModel& earlier, const TissueModel& now,
              LoadingPatch& patch) {
  for (RimSpring& spring : patch.rim) {
    const double before = earlier.moduliAt(state, spring.node).shear;
    if (before > 0.0) spring.stiffness *= now.moduliAt(state, spring.node).shear / before;
  }
}

std::uint64_t balanceFingerprint(const TissueConfig& tissue, const SolverConfig& solver) {
  ByteWriter out;
  out.text(tissue.model);
  add(tissue.material, out);
  for (const Region& region : tissue.regions) add(region, out);
  for (const MembraneConfig& membrane : tissue.membranes) add(membrane, out);
  out.vec3(tissue.gravity);
  if (tissue.time) out.f64(tissue.time->damping_time);
  out.text(solver.method);
  out.f64(solver.tolerance);
  return hashOf(out.bytes());
}

// The lattice as an entry of the history has it, with the shape it has now.
LatticeState asBefore(const Lattice& lattice, const History::Entry& entry, SplitCells split,
                      const LatticeState& now) {
  LatticeState state = lattice.restState();
  state.severed.assign(entry.severed.begin(), entry.severed.end());
  state.springs_cut = static_cast<int>(std::count(state.severed.begin(), state.severed.end(), 1));
  takePartings(entry.parted_at, state);
  state.ahead = entry.ahead;
  state.taken = entry.taken;
  if (!state.taken.empty()) noteTaken(lattice, state);
  state.pieces = countPieces(lattice, state);
  if (!isAsMade(state)) state.cells = cellsLeft(lattice, state, split);
  state.displacement = carriedOver(*now.cells, now.displacement, *state.cells);
  if (now.taken != state.taken) moveWithNeighbors(lattice, now, state);
  return state;
}

}  // namespace

TissueStates::TissueStates(const TissueConfig& tissue, const SolverConfig& solver, TissueData& data,
                           LoadStepSolver& load_step, Surgery& surgery, Suturing& suturing,
                           LoadProgram& program)
    : data_(data),
      solver_(load_step),
      surgery_(surgery),
      suturing_(suturing),
      program_(program),
      balance_fingerprint_(balanceFingerprint(tissue, solver)) {}

void TissueStates::reset() {
  Body& body = data_.body;
  const bool was_cut = !isAsMade(body.state());
  data_.motion.stop();
  data_.endAside();
  data_.bounds.patience().forget();
  data_.methods.forget();
  body.change() = body.lattice().restState();
  data_.threads.clear();
  data_.loads.take({});
  data_.outcome = SolveOutcome();
  surgery_.setSpringsTorn(0);
  data_.history.clear();
  if (was_cut) {
    body.weigh();
    data_.rebuildSurface();
  }
  data_.pieces.take(std::make_shared<const PieceNumbers>(body.lattice(), body.state()));
  body.showRest();
  data_.motion.wakeUnderBodyLoad();
}

// Nothing of what was there stays, nor of what the method learned of it.
void TissueStates::take(const SavedState& saved) {
  Body& body = data_.body;
  data_.motion.stop();
  data_.endAside();
  data_.methods.forget();
  data_.outcome = SolveOutcome();
  surgery_.setSpringsTorn(0);
  body.change() = saved.lattice;
  data_.loads.take(saved.loads, saved.due);
  data_.history.clear();
  body.weigh();
  data_.threads.clear();
  data_.rebuildSurface();
  data_.threads.take(saved.sutures);
  data_.pieces.take(
      std::make_shared<const PieceNumbers>(body.lattice(), body.state(), saved.pieces));
  data_.outcome.report = saved.report;
  data_.deformSurface();
}

void TissueStates::takeOver(const TissueData& other) {
  SavedState now = other.saved();
  now.due.clear();
  take(now);
  data_.outcome.report = SolveReport();
  data_.outcome.report.patches.resize(data_.loads.patches().size());
  data_.motion.wakeUnderBodyLoad();
}

SolveReport TissueStates::loadState(const SavedState& saved) {
  SolveOutcome& outcome = data_.outcome;
  take(saved);
  if (!saved.in_balance) {
    // Supports are met before anything moves, so that what lies on them sticks at first.
    solver_.renewContacts();
    solver_.solve(data_.body.freeNodes());
    if (data_.loads.isLoading()) outcome.worsen(SolveStatus::kLate);
    return outcome.report;
  }
  outcome.report.inverted_cells = countInvertedCells(data_.body.lattice(), data_.body.state());
  outcome.report.volume_ratio = data_.body.volumeRatio();
  return outcome.report;
}

std::string TissueStates::savedState() const {
  const Lattice& lattice = data_.body.lattice();
  const SplitCells split = data_.body.model().splitCells();
  return encodeState(lattice, split, data_.saved(),
                     {fingerprintOf(lattice, split), balance_fingerprint_});
}

std::uint64_t TissueStates::stateHash() const { return robot_tissue::stateHash(savedState()); }

std::shared_ptr<const SavedState> TissueStates::readState(const std::string& bytes) const {
  const Lattice& lattice = data_.body.lattice();
  const SplitCells split = data_.body.model().splitCells();
  return std::make_shared<const SavedState>(
      decodeState(lattice, split, bytes, {fingerprintOf(lattice, split), balance_fingerprint_}));
}

int TissueStates::undoable() const { return static_cast<int>(data_.history.size()); }

SolveReport TissueStates::undo(int count) {
  Body& body = data_.body;
  if (count < 1 || count > undoable()) {
    throw InputError("count: " + std::to_string(count) + " to take back; allowed: " +
                     (undoable() == 0 ? "none, as nothing was cut, removed, torn or sutured since "
                                        "the tissue was made, reset or loaded"
                                      : "1 to " + std::to_string(undoable())));
  }
  const std::size_t target = data_.history.size() - static_cast<std::size_t>(count);
  const History::Entry entry = data_.history.before(target);
  const bool same_loads = data_.history.hasLoadsSince(target, data_.loads.namedLoads());
  std::shared_ptr<const SavedState> saved;
  // What is late of the change itself goes with it.
  if (data_.loads.isUntouched() && !data_.loads.isLoading() && same_loads) saved = entry.state;
  if (saved && saved->in_balance) {
    History kept = std::exchange(data_.history, History());
    kept.dropFrom(target);
    const int torn = surgery_.springsTorn();
    const SolveReport report = loadState(*saved);
    surgery_.setSpringsTorn(torn);
    data_.history = std::move(kept);
    return report;
  }
  data_.motion.stop();
  body.change() = asBefore(body.lattice(), entry, body.model().splitCells(), body.state());
  body.weigh();
  data_.threads.take(entry.sutures);
  if (data_.threads.anyWhole()) data_.rebuildSurface();  // nodes may have other numbers than there
  data_.pieces.take(entry.pieces);
  data_.history.dropFrom(target);
  program_.joinAnew();
  if (data_.motion.takesNoTime()) return surgery_.changeTopology({});
  data_.threads.loosen(body.displacement());
  surgery_.changeTopology(body.freeNodes());
  if (data_.threads.anyWhole()) suturing_.drawThreadsIn();
  return data_.outcome.report;
}

// What the method learned was of the other material.
bool TissueStates::retune(const TissueConfig& tissue, const SolverConfig& solver) {
  // What these refuse is refused before anything is another one.
  makeMethod(solver, data_.body.lattice(), *makeModel(tissue, data_.body.lattice()));
  data_.methods.setConfig(solver);
  data_.bounds.setMaxMs(solver.max_ms);
  const std::uint64_t fingerprint = balanceFingerprint(tissue, solver);
  if (fingerprint == balance_fingerprint_) return false;
  balance_fingerprint_ = fingerprint;
  data_.endAside();
  data_.methods.drop();
  const std::unique_ptr<TissueModel> earlier = data_.body.remake(tissue);
  data_.methods.make(solver);
  data_.renewTies();
  data_.loads.forEach([&](LoadingPatch& patch) {
    scaleRim(data_.body.state(), *earlier, data_.body.model(), patch);
  });
  data_.history.forgetStates();
  data_.motion.setTolerance(solver.tolerance);
  return true;
}

}  // namespace robot_tissue
