// Tissue: which of the parts behind it answers what.
#include "robot_tissue/core/tissue.h"

#include <utility>

#include "material/tissue_model.h"
#include "tissue/tissue_parts.h"

namespace robot_tissue {

Tissue::Tissue(const TissueConfig& tissue, const SolverConfig& solver)
    : parts_(std::make_unique<TissueParts>(tissue, solver)) {}

Tissue::~Tissue() = default;

const Lattice& Tissue::lattice() const { return parts_->data.body.lattice(); }
const LatticeState& Tissue::state() const { return parts_->data.body.state(); }
const TissueSurface& Tissue::surface() const { return parts_->data.body.surface(); }
const std::vector<Vec3>& Tissue::vertices() const { return parts_->data.body.vertices(); }
const Box& Tissue::bounds() const { return parts_->data.body.bounds(); }
const std::vector<int>& Tissue::pieceOfNodes() const { return parts_->data.pieces.ofNodes(); }
std::vector<TissuePiece> Tissue::pieces() const { return parts_->data.pieces.deformed(); }
std::vector<TissuePiece> Tissue::restingPieces() const { return parts_->data.pieces.atRest(); }
const std::vector<int>& Tissue::droppedPieces() const { return parts_->data.pieces.dropped(); }
bool Tissue::isUntouched() const { return parts_->data.loads.isUntouched(); }
double Tissue::stepLength() const { return parts_->data.stepLength(); }
Patience& Tissue::patience() { return parts_->data.bounds.patience(); }
const Patience& Tissue::patience() const { return parts_->data.bounds.patience(); }
const std::vector<LoadingPatch>& Tissue::patches() const { return parts_->data.loads.patches(); }
std::size_t Tissue::namedPatches() const { return parts_->data.loads.named(); }
Tissue::Displacements Tissue::displacements() const { return parts_->data.body.displacements(); }
bool Tissue::resistsInversion() const { return parts_->data.body.model().resistsInversion(); }
int Tissue::cellsBeyondLaw() const {
  return parts_->data.body.model().cellsBeyondLaw(parts_->data.body.state());
}
const SolveReport& Tissue::lastReport() const { return parts_->data.outcome.report; }
void Tissue::noteUnconverged() { parts_->data.outcome.worsen(SolveStatus::kUnconverged); }
std::vector<Vec3> Tissue::shownDisplacement() const {
  return parts_->data.body.shownDisplacement(parts_->data.loads.patches());
}
Vec3 Tissue::nodeForce(int node) const { return parts_->forces.nodeForce(node); }
std::vector<int> Tissue::freeNodes() const { return parts_->data.body.freeNodes(); }
Vec3 Tissue::weight() const { return parts_->forces.weight(); }
bool Tissue::anyHangs() const { return !parts_->data.hangingNodes().empty(); }
std::vector<std::string> Tissue::adriftLoads() const {
  std::vector<std::string> names;
  for (const std::size_t number : parts_->data.adrift().patches) {
    names.push_back(patches()[number].name);
  }
  return names;
}
Vec3 Tissue::forceOfFixedNodes() const { return parts_->forces.forceOfFixedNodes(); }
double Tissue::nodeStiffness(int node) const { return parts_->data.body.nodeStiffness(node); }
double Tissue::stiffening(int node) const { return parts_->forces.stiffening(node); }
Vec3 Tissue::nodePosition(int node) const { return parts_->data.body.nodePosition(node); }
std::optional<RimModuli> Tissue::rimModuli(int node) const {
  return parts_->forces.rimModuli(node);
}
std::vector<RimSpring> Tissue::springsUnder(const std::vector<SeatedNode>& nodes) const {
  return parts_->forces.springsUnder(nodes);
}
std::optional<RimCompliance> Tissue::rimCompliance(int node, double depth) const {
  return parts_->forces.rimCompliance(node, depth);
}
Vec3 Tissue::inwardsAround(const SurfacePoint& point, const Vec3& middle) const {
  return parts_->forces.inwardsAround(point, middle);
}
std::optional<Recess> Tissue::recessUnder(const NarrowPress& press) const {
  return parts_->forces.recessUnder(press);
}
void Tissue::setContactUpdate(ContactUpdate* update) { parts_->solver.setContactUpdate(update); }
void Tissue::setDeadline(std::optional<Deadline> deadline) {
  parts_->data.bounds.setDeadline(deadline);
}
bool Tissue::isRoundForNextCall() const { return parts_->data.bounds.isRoundForNextCall(); }
void Tissue::expectTouch() { parts_->solver.expectTouch(); }
SolveReport Tissue::settle() { return parts_->program.settle(); }
bool Tissue::hasTime() const { return parts_->data.motion.hasTime(); }
bool Tissue::isInTime() const { return parts_->data.motion.isInTime(); }
bool Tissue::isMoving() const { return parts_->data.motion.isMoving(); }
double Tissue::longestTimeStep() const { return parts_->data.motion.integrator().longestStep(); }
void Tissue::expectTimeStep(double duration, Touched touched) {
  parts_->data.motion.expectStep(duration, touched);
}
void Tissue::beginTimeStep(double duration, Touched touched) {
  parts_->time.beginTimeStep(duration, touched);
}
void Tissue::endTimeStep() { parts_->time.endTimeStep(); }
bool Tissue::isTimeStepOver() const {
  return parts_->data.outcome.is_cut_short || parts_->data.bounds.isTimeStepOver();
}
bool Tissue::isTimeStepRefused() const { return parts_->data.motion.integrator().isRefused(); }
void Tissue::haltMotion() { parts_->data.motion.halt(); }
bool Tissue::isInTimeStep() const { return parts_->data.motion.isInTimeStep(); }
bool Tissue::goesInTime() const { return parts_->data.motion.goesInTime(); }
bool Tissue::goesThroughTime() const { return parts_->data.goesThroughTime(); }
void Tissue::stopTime() { parts_->data.motion.stop(); }
SolveReport Tissue::wait(double duration) { return parts_->time.wait(duration); }
void Tissue::load(const LoadStep& step, const OnIncrement& on_increment, int most_increments) {
  parts_->program.load(step, on_increment, most_increments);
}
bool Tissue::isLate() const { return parts_->data.isLate(); }
bool Tissue::areContactsSettled() const {
  return parts_->data.outcome.are_contacts_settled || isUntouched();
}
bool Tissue::mayShowUnsettled() const { return parts_->solver.mayShowUnsettled(); }
void Tissue::noteUnsettled() { parts_->solver.noteUnsettled(); }
bool Tissue::isLoading() const { return parts_->data.loads.isLoading(); }
void Tissue::loadOn(const OnIncrement& on_increment) { parts_->program.loadOn(on_increment); }
PatchAnswer Tissue::answerOf(const std::string& name, const SolveReport& report) const {
  return parts_->data.loads.answerOf(name, report);
}
SolveReport Tissue::release(const std::vector<std::string>& names) {
  return parts_->program.release(names);
}
SolveReport Tissue::follow(std::vector<LoadingPatch> tool_patches,
                           const std::vector<int>& disturbed, Bedding bedding) {
  return parts_->program.follow(std::move(tool_patches), disturbed, bedding);
}
Tissue::Shape Tissue::shape() const { return parts_->data.shape(); }
void Tissue::restore(const Shape& shape) { parts_->data.restore(shape); }
void Tissue::takeOver(const Tissue& other) { parts_->states.takeOver(other.parts_->data); }
void Tissue::beginAside() { parts_->data.beginAside(); }
void Tissue::endAside() { parts_->data.endAside(); }
CutReport Tissue::cut(const std::vector<Vec3>& corners) { return parts_->surgery.cut(corners); }
RemoveReport Tissue::remove(const RemovedSpace& space) { return parts_->surgery.remove(space); }
RemoveReport Tissue::drill(const CoveredSpace& space, Stroke stroke) {
  return parts_->surgery.drill(space, stroke);
}
int Tissue::undoable() const { return parts_->states.undoable(); }
SolveReport Tissue::undo(int count) { return parts_->states.undo(count); }
CutReport Tissue::cutAlong(const std::vector<CutTriangle>& swept, Stroke stroke) {
  return parts_->surgery.cutAlong(swept, stroke);
}
SolveReport Tissue::tear() { return parts_->surgery.tear(); }
bool Tissue::tearOut(const std::vector<int>& nodes) { return parts_->surgery.tearOut(nodes); }
bool Tissue::mayTear() const { return parts_->surgery.mayTear(); }
bool Tissue::isOverstretched() const { return parts_->surgery.isOverstretched(); }
int Tissue::springsTorn() const { return parts_->surgery.springsTorn(); }
SutureResult Tissue::suture(const SutureConfig& config) { return parts_->suturing.suture(config); }
std::vector<SutureReport> Tissue::sutures() const { return parts_->suturing.sutures(); }
void Tissue::reset() { parts_->states.reset(); }
bool Tissue::retune(const TissueConfig& tissue, const SolverConfig& solver) {
  return parts_->states.retune(tissue, solver);
}
std::string Tissue::savedState() const { return parts_->states.savedState(); }
std::uint64_t Tissue::stateHash() const { return parts_->states.stateHash(); }
std::shared_ptr<const SavedState> Tissue::readState(const std::string& bytes) const {
  return parts_->states.readState(bytes);
}
SolveReport Tissue::loadState(const SavedState& saved) { return parts_->states.loadState(saved); }

}  // namespace robot_tissue
