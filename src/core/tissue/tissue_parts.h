// What is behind Tissue.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot_tissue/core/tissue.h"
#include "tissue/body.h"
#include "tissue/history.h"
#include "tissue/method_pair.h"
#include "tissue/piece_registry.h"
#include "tissue/solve_bounds.h"
#include "tissue/solve_outcome.h"
#include "tissue/standing_loads.h"
#include "tissue/threads.h"
#include "tissue/tissue_motion.h"

namespace robot_tissue {

class BladeSurface;
struct Crossing;
struct SpringAhead;
struct LoadRamp;
struct SutureThread;

struct TissueParts {
  using OnIncrement = Tissue::OnIncrement;
  using Displacements = Tissue::Displacements;
  using Shape = Tissue::Shape;

  // Throws InputError: unknown model or method, a box without a node, ...
  TissueParts(const TissueConfig& tissue, const SolverConfig& solver);
  ~TissueParts();

  // No tool touched it in the last solve.
  bool isUntouched() const { return loads_.isUntouched(); }
  // Longest motion of a tool that one solve follows well (m).
  double stepLength() const;
  // Net force of the springs, of threads (and of gravity) on a node (N): what a patch node hands to
  // its tool.
  Vec3 nodeForce(int node) const;
  // Of the tissue (N), but for pieces that hang: gravity pulls them and nothing bears them, so that
  // no shape is their balance. Where no time passes they stay as they are.
  Vec3 weight() const;
  bool anyHangs() const { return !hangingNodes().empty(); }
  Vec3 forceOfFixedNodes() const;  // on the tissue (N)
  // Against moving a node alone from rest, mean over the axes (N/m): of the cells, and how many
  // times that in the time step under way, where its rate and the node's mass count, too.
  double stiffening(int node) const;
  // Of a node so many spacings inside the plate's edge, < 0: beyond it (doc/model.md, "The rim").
  // None where cells at the node are filled in part, and where method or model have no rims.
  std::optional<RimCompliance> rimCompliance(int node, double depth) const;
  // None where a node is not in a flat surface of whole cells; likewise.
  std::optional<Recess> recessUnder(const BallPress& press) const;

  // Asked after each solve; null: nobody. It outlives the tissue, or is taken back.
  void setContactUpdate(ContactUpdate* update) { contact_update_ = update; }

  // Something comes near, but does not touch yet: the solver makes what its first solve needs,
  // where nothing was solved for since the tissue, or its cells, are as they are.
  void expectTouch();

  // Equilibrium under what acts now, at rest.
  SolveReport settle();

  void beginTimeStep(double duration, Touched touched);
  void endTimeStep();
  // In steps of the method's own: contacts pushed as it says, in the mean.
  bool goesThroughTime() const;
  // Time goes by while no tool moves, in steps of an error within the tolerance.
  SolveReport wait(double duration);
  // Brings the step's patches to their loads in increments; they stand until released. Refused when
  // the method needs more than most_increments.
  void load(const LoadStep& step, const OnIncrement& on_increment = {},
            int most_increments = 100000);
  // There was no time to come to balance, whatever else is to be said of the shape, or to bring
  // named patches to their loads.
  bool isLate() const { return outcome_.is_late || loads_.isLoading(); }
  // Else the shape is in balance, but was shown before its contacts were settled (LoadStepBound).
  bool areContactsSettled() const { return outcome_.are_contacts_settled || isUntouched(); }
  // Whether that may be, with the contacts as they are.
  bool mayShowUnsettled() const;
  void noteUnsettled();
  // Brings those patches on.
  void loadOn(const OnIncrement& on_increment = {});
  // What a named patch met in the last solve; zero when there is none of that name.
  PatchAnswer answerOf(const std::string& name, const SolveReport& report) const;
  // Takes patches away; the shape is found anew from rest under the loads that stay.
  SolveReport release(const std::vector<std::string>& names);
  // Puts the tools' patches in the place of the earlier ones and solves. `disturbed`: nodes that
  // left a patch. When the last tool has left, the shape is found anew from rest, unless the tissue
  // is borne by supports, which it may have slid along.
  SolveReport follow(std::vector<LoadingPatch> tool_patches, const std::vector<int>& disturbed,
                     Bedding bedding = Bedding::kFixedNodes);
  Shape shape() const;
  void restore(const Shape& shape);
  // Cells, shape, named loads and sutures of another tissue of the same lattice; at rest.
  void takeOver(const TissueParts& other);
  // In between, solves teach the method nothing that later ones depend on.
  void beginAside();
  void endAside();
  // Severs the springs that cross the polygon in the deformed shape, then balances; in time it only
  // severs them.
  CutReport cut(const std::vector<Vec3>& corners);
  // Takes what has its center in the space away, in whole cells and parts that cuts made of cells,
  // then as cut. Named loads lose the nodes that go. Throws InputError when nothing would be left.
  RemoveReport remove(const RemovedSpace& space);
  // The same along a burr's way, without the refusal: all of a stroke is taken back as one removal.
  RemoveReport drill(const CoveredSpace& space, Stroke stroke);
  // How many cuts, removals, tears and sutures there are to take back: all since the last reset, or
  // loaded state.
  int undoable() const;
  // Takes the last ones back. Where the named loads are those of then, no tool touches and the
  // shape was in balance, it is that one, bit for bit; else it is balanced under what stands now.
  // Throws InputError for less than 1, or more than there are.
  SolveReport undo(int count);
  // The same of a surface of triangles, such as a blade's edge sweeps. All of a stroke is taken
  // back as one cut.
  CutReport cutAlong(const std::vector<CutTriangle>& swept, Stroke stroke = Stroke::kBegins);
  // Drops pieces that nothing holds any more, where free pieces drop; severs what is stretched
  // beyond tear_stretch and balances, over and over, until nothing is. For shapes that tools make:
  // those of the other calls but follow have torn already. LATE: the rest is left to the next call.
  SolveReport tear();
  // Severs the springs between these nodes and the others, torn in one change, and balances; false:
  // there are none. For what a grasper holds.
  bool tearOut(const std::vector<int>& nodes);
  bool mayTear() const { return !tear_strains_.empty() || pieces_.dropsFree(); }
  int springsTorn() const { return springs_torn_; }  // since rest, or the state that was loaded
  // Joins two points of the surface by a thread, then balances; in time it only joins them. A cut
  // leaves each end on its side; where the tissue of an end goes the thread goes.
  SutureResult suture(const SutureConfig& config);
  // In the order in which they were made, broken ones, too.
  std::vector<SutureReport> sutures() const;
  // Rest shape, bit for bit; cuts mended, loads and sutures gone.
  void reset();
  // The same tissue with other moduli, and another tolerance or max_ms: `tissue` and `solver` are
  // otherwise those that it was made of. Shape, cuts and loads stay. True: the shape has to be
  // balanced anew.
  bool retune(const TissueConfig& tissue, const SolverConfig& solver);

  // Topology, shape and named loads as bytes (doc/state_file.md); a load on its way is the one that
  // it has come to.
  std::string savedState() const;
  // The same only of two states that are, bit for bit.
  std::uint64_t stateHash() const;
  // Throws InputError, the reason alone, for bytes that are no state of this tissue.
  std::shared_ptr<const SavedState> readState(const std::string& bytes) const;
  // Back to it, bit for bit where it was in balance without tools; else it is balanced. Tools'
  // patches and sutures go.
  SolveReport loadState(const SavedState& saved);

  SolveReport solve(const std::vector<int>& disturbed);
  SolveReport severAndBalance(const std::vector<Crossing>& crossings,
                              const BladeSurface* blade = nullptr);
  SolveReport goNearer(std::vector<SpringAhead> ahead);
  void shift(const std::vector<int>& nodes, const Vec3& way);
  void predict();
  SolveReport asItIs();
  // tissue_surgery.cpp
  class TopologyChange;
  SavedState stateNow() const;
  void take(const SavedState& saved);
  bool mayReach(const Box& bounds) const;
  RemoveReport takeAway(const std::vector<std::uint8_t>& within, Stroke stroke);
  std::vector<std::string> dropLostLoads();
  // loose_pieces.cpp
  std::vector<int> hangingNodes() const;
  bool holdHanging();
  void letHangingBe(SolveReport& report);
  void takeOut(const std::vector<int>& pieces);
  void dropFreed();
  void dropLetGo();
  SolveReport changeTopology(const std::vector<int>& disturbed);
  bool hasTimeForLevels(double before_ms) const;
  SolveReport leaveToNextCall(const std::vector<int>& disturbed);
  // contact_rounds.cpp
  struct Rounds;
  struct RoundShape;
  enum class RoundDecision { kDone, kSolveAgain };
  SolveReport solveInRounds(const std::vector<int>& disturbed);
  RoundDecision endRound(Rounds& rounds);
  RoundShape takeShape(Rounds& rounds, bool late);
  void tellWhatIsOpen(Rounds& rounds, const RoundShape& shape, bool renewed);
  void worsen(Rounds& rounds, SolveStatus status);
  void renewContacts();
  void limitWays();
  bool goBack(const Rounds& rounds);
  double costOfIteration() const;
  SolveReport solveOnce(const std::vector<int>& disturbed);
  // suturing.cpp
  SutureThread threadOf(const SutureConfig& config) const;
  SolveReport drawThreadsIn();
  bool solveOnThreads(SolveReport& report);
  SolveReport settleFromRest();
  SolveReport solveWithThreads(const std::vector<int>& disturbed, LatticeState& state);
  SolveReport solveAndBreak(const std::vector<int>& disturbed);
  void rebindThreads();
  SolveReport solveFromRest();
  void describeShape(SolveReport& report);
  void deformSurface(Body::OffPoint of_tools = drawnOff);
  LoadingPatch makePatch(const PatchConfig& config) const;
  LoadRamp makeRamp(const LoadingPatch& target, const LoadingPatch* standing) const;
  // load_stepping.cpp; reports are the last increment's, with the worst status of all.
  bool stopsOnTheWay(const std::vector<LoadRamp>& ramps);
  double foreseenSteps(const std::vector<LoadRamp>& ramps) const;
  SolveReport stepLoadsByItself(const std::vector<LoadRamp>& ramps,
                                const OnIncrement& on_increment);
  SolveReport stepLoads(const std::vector<LoadRamp>& ramps, int increments,
                        const OnIncrement& on_increment);
  SolveReport goInSteps(const std::vector<LoadRamp>& ramps, int increment, int increments);
  SolveReport goTo(const std::vector<LoadRamp>& ramps, double share);
  Vec3 patchForce(const LoadingPatch& patch) const;
  void renewTies();
  void rebuildSurface();

  Body body_;
  StandingLoads loads_;
  SolveOutcome outcome_;
  Threads threads_;
  History history_;                   // of what changed the topology
  std::vector<double> tear_strains_;  // per spring (tearStrains)
  int springs_torn_ = 0;
  MethodPair methods_;
  TissueMotion motion_;
  PieceRegistry pieces_;
  SolveBounds bounds_;
  ContactUpdate* contact_update_ = nullptr;
  std::uint64_t balance_fingerprint_ = 0;  // of the scene
};

}  // namespace robot_tissue
