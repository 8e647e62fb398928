// Tissue: its state as bytes, and back; its material.
#include "tissue/tissue_state.h"

#include <utility>

#include "lattice/piece_numbers.h"
#include "material/tissue_model.h"
#include "membrane/membrane_plan.h"
#include "saving/bytes.h"
#include "saving/saved_state.h"
#include "solvers/solver_method.h"
#include "tissue/history.h"
#include "tissue/registry.h"
#include "tissue/threads.h"
#include "tissue/time_integrator.h"
#include "tissue/tissue_parts.h"

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

}  // namespace

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

// What the method learned was of the other material.
bool TissueParts::retune(const TissueConfig& tissue, const SolverConfig& solver) {
  methods_.setConfig(solver);
  bounds_.setMaxMs(solver.max_ms);
  const std::uint64_t fingerprint = balanceFingerprint(tissue, solver);
  if (fingerprint == balance_fingerprint_) return false;
  balance_fingerprint_ = fingerprint;
  endAside();
  methods_.drop();
  const std::unique_ptr<TissueModel> earlier = body_.remake(tissue);
  methods_.make(solver);
  renewTies();
  loads_.forEach(
      [&](LoadingPatch& patch) { scaleRim(body_.state(), *earlier, body_.model(), patch); });
  history_.forgetStates();
  motion_.setTolerance(solver.tolerance);
  return true;
}

SavedState TissueParts::stateNow() const {
  SavedState saved;
  saved.lattice = body_.state();
  saved.pieces = pieces_.numbers()->names();
  saved.loads = loads_.namedLoads();
  saved.sutures = threads_.all();
  saved.report = outcome_.report;
  saved.report.patches.resize(loads_.named());  // without the tools
  saved.in_balance = isUntouched() && !isLate() && !motion_.isMoving();
  return saved;
}

std::string TissueParts::savedState() const {
  const SplitCells split = body_.model().splitCells();
  return encodeState(body_.lattice(), split, stateNow(),
                     {fingerprintOf(body_.lattice(), split), balance_fingerprint_});
}

std::uint64_t TissueParts::stateHash() const { return robot_tissue::stateHash(savedState()); }

std::shared_ptr<const SavedState> TissueParts::readState(const std::string& bytes) const {
  const SplitCells split = body_.model().splitCells();
  return std::make_shared<const SavedState>(
      decodeState(body_.lattice(), split, bytes,
                  {fingerprintOf(body_.lattice(), split), balance_fingerprint_}));
}

// Nothing of what was there stays, nor of what the method learned of it.
void TissueParts::take(const SavedState& saved) {
  motion_.stop();
  endAside();
  methods_.forget();
  outcome_.disturbed.clear();
  outcome_.is_late = false;
  springs_torn_ = 0;
  body_.change() = saved.lattice;
  loads_.take(saved.loads);
  history_.clear();
  body_.weigh();
  threads_.clear();
  rebuildSurface();
  threads_.take(saved.sutures);
  pieces_.take(std::make_shared<const PieceNumbers>(body_.lattice(), body_.state(), saved.pieces));
  outcome_.report = saved.report;
  deformSurface();
}

void TissueParts::takeOver(const TissueParts& other) {
  take(other.stateNow());
  outcome_.report = SolveReport();
  outcome_.report.patches.resize(loads_.patches().size());
  motion_.wakeUnderBodyLoad();
}

SolveReport TissueParts::loadState(const SavedState& saved) {
  take(saved);
  if (!saved.in_balance) return solve(body_.freeNodes());
  outcome_.report.inverted_cells = countInvertedCells(body_.lattice(), body_.state());
  outcome_.report.volume_ratio = body_.volumeRatio();
  return outcome_.report;
}

}  // namespace robot_tissue
