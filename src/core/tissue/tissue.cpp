// Tissue: which of the parts behind it answers what.
#include "robot_tissue/core/tissue.h"

#include <utility>

#include "material/tissue_model.h"
#include "tissue/tissue_parts.h"

namespace robot_tissue {

Tissue::Tissue(const TissueConfig& tissue, const SolverConfig& solver)
    : parts_(std::make_unique<TissueParts>(tissue, solver)) {}

Tissue::~Tissue() = default;

const Lattice& Tissue::lattice() const { return parts_->body_.lattice(); }
const LatticeState& Tissue::state() const { return parts_->body_.state(); }
const TissueSurface& Tissue::surface() const { return parts_->body_.surface(); }
const std::vector<Vec3>& Tissue::vertices() const { return parts_->body_.vertices(); }
const Box& Tissue::bounds() const { return parts_->body_.bounds(); }
const std::vector<int>& Tissue::pieceOfNodes() const { return parts_->pieces_.ofNodes(); }
std::vector<TissuePiece> Tissue::pieces() const { return parts_->pieces_.deformed(); }
std::vector<TissuePiece> Tissue::restingPieces() const { return parts_->pieces_.atRest(); }
const std::vector<int>& Tissue::droppedPieces() const { return parts_->pieces_.dropped(); }
bool Tissue::isUntouched() const { return parts_->isUntouched(); }
double Tissue::stepLength() const { return parts_->stepLength(); }
Patience& Tissue::patience() { return parts_->bounds_.patience(); }
const Patience& Tissue::patience() const { return parts_->bounds_.patience(); }
const std::vector<LoadingPatch>& Tissue::patches() const { return parts_->loads_.patches(); }
std::size_t Tissue::namedPatches() const { return parts_->loads_.named(); }
Tissue::Displacements Tissue::displacements() const { return parts_->body_.displacements(); }
bool Tissue::resistsInversion() const { return parts_->body_.model().resistsInversion(); }
int Tissue::cellsBeyondLaw() const {
  return parts_->body_.model().cellsBeyondLaw(parts_->body_.state());
}
const SolveReport& Tissue::lastReport() const { return parts_->outcome_.report; }
void Tissue::noteUnconverged() { parts_->outcome_.worsen(SolveStatus::kUnconverged); }
std::vector<Vec3> Tissue::shownDisplacement() const {
  return parts_->body_.shownDisplacement(parts_->loads_.patches());
}
Vec3 Tissue::nodeForce(int node) const { return parts_->nodeForce(node); }
std::vector<int> Tissue::freeNodes() const { return parts_->body_.freeNodes(); }
Vec3 Tissue::weight() const { return parts_->weight(); }
bool Tissue::anyHangs() const { return parts_->anyHangs(); }
Vec3 Tissue::forceOfFixedNodes() const { return parts_->forceOfFixedNodes(); }
double Tissue::nodeStiffness(int node) const { return parts_->body_.nodeStiffness(node); }
double Tissue::stiffening(int node) const { return parts_->stiffening(node); }
Vec3 Tissue::nodePosition(int node) const { return parts_->body_.nodePosition(node); }
std::optional<RimCompliance> Tissue::rimCompliance(int node, double depth) const {
  return parts_->rimCompliance(node, depth);
}
std::optional<Recess> Tissue::recessUnder(const BallPress& press) const {
  return parts_->recessUnder(press);
}
void Tissue::setContactUpdate(ContactUpdate* update) { parts_->setContactUpdate(update); }
void Tissue::setDeadline(std::optional<Deadline> deadline) {
  parts_->bounds_.setDeadline(deadline);
}
bool Tissue::isRoundForNextCall() const { return parts_->bounds_.isRoundForNextCall(); }
void Tissue::expectTouch() { parts_->expectTouch(); }
SolveReport Tissue::settle() { return parts_->settle(); }
bool Tissue::hasTime() const { return parts_->motion_.hasTime(); }
bool Tissue::isMoving() const { return parts_->motion_.isMoving(); }
double Tissue::longestTimeStep() const { return parts_->motion_.integrator().longestStep(); }
void Tissue::expectTimeStep(double duration, Touched touched) {
  parts_->motion_.expectStep(duration, touched);
}
void Tissue::beginTimeStep(double duration, Touched touched) {
  parts_->beginTimeStep(duration, touched);
}
void Tissue::endTimeStep() { parts_->endTimeStep(); }
bool Tissue::isInTimeStep() const { return parts_->motion_.isInTimeStep(); }
bool Tissue::goesInTime() const { return parts_->motion_.goesInTime(); }
bool Tissue::goesThroughTime() const { return parts_->goesThroughTime(); }
void Tissue::stopTime() { parts_->motion_.stop(); }
SolveReport Tissue::wait(double duration) { return parts_->wait(duration); }
void Tissue::load(const LoadStep& step, const OnIncrement& on_increment, int most_increments) {
  parts_->load(step, on_increment, most_increments);
}
bool Tissue::isLate() const { return parts_->isLate(); }
bool Tissue::areContactsSettled() const { return parts_->areContactsSettled(); }
bool Tissue::mayShowUnsettled() const { return parts_->mayShowUnsettled(); }
void Tissue::noteUnsettled() { parts_->noteUnsettled(); }
bool Tissue::isLoading() const { return parts_->loads_.isLoading(); }
void Tissue::loadOn(const OnIncrement& on_increment) { parts_->loadOn(on_increment); }
PatchAnswer Tissue::answerOf(const std::string& name, const SolveReport& report) const {
  return parts_->answerOf(name, report);
}
SolveReport Tissue::release(const std::vector<std::string>& names) {
  return parts_->release(names);
}
SolveReport Tissue::follow(std::vector<LoadingPatch> tool_patches,
                           const std::vector<int>& disturbed, Bedding bedding) {
  return parts_->follow(std::move(tool_patches), disturbed, bedding);
}
Tissue::Shape Tissue::shape() const { return parts_->shape(); }
void Tissue::restore(const Shape& shape) { parts_->restore(shape); }
void Tissue::takeOver(const Tissue& other) { parts_->takeOver(*other.parts_); }
void Tissue::beginAside() { parts_->beginAside(); }
void Tissue::endAside() { parts_->endAside(); }
CutReport Tissue::cut(const std::vector<Vec3>& corners) { return parts_->cut(corners); }
RemoveReport Tissue::remove(const RemovedSpace& space) { return parts_->remove(space); }
RemoveReport Tissue::drill(const CoveredSpace& space, Stroke stroke) {
  return parts_->drill(space, stroke);
}
int Tissue::undoable() const { return parts_->undoable(); }
SolveReport Tissue::undo(int count) { return parts_->undo(count); }
CutReport Tissue::cutAlong(const std::vector<CutTriangle>& swept, Stroke stroke) {
  return parts_->cutAlong(swept, stroke);
}
SolveReport Tissue::tear() { return parts_->tear(); }
bool Tissue::tearOut(const std::vector<int>& nodes) { return parts_->tearOut(nodes); }
bool Tissue::mayTear() const { return parts_->mayTear(); }
int Tissue::springsTorn() const { return parts_->springsTorn(); }
SutureResult Tissue::suture(const SutureConfig& config) { return parts_->suture(config); }
std::vector<SutureReport> Tissue::sutures() const { return parts_->sutures(); }
void Tissue::reset() { parts_->reset(); }
bool Tissue::retune(const TissueConfig& tissue, const SolverConfig& solver) {
  return parts_->retune(tissue, solver);
}
std::string Tissue::savedState() const { return parts_->savedState(); }
std::uint64_t Tissue::stateHash() const { return parts_->stateHash(); }
std::shared_ptr<const SavedState> Tissue::readState(const std::string& bytes) const {
  return parts_->readState(bytes);
}
SolveReport Tissue::loadState(const SavedState& saved) { return parts_->loadState(saved); }

}  // namespace robot_tissue
