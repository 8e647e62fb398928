// The tissue: lattice, shape, standing loads and the method that solves them, behind one door.
// Every call either succeeds as a whole or throws InputError and changes nothing; calls for which
// no error is named throw none. Lengths are in m, forces in N, times in s; points and vectors are
// in the tissue's frame.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/contact_update.h"
#include "robot_tissue/core/deadline.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/narrow_contact.h"
#include "robot_tissue/core/patience.h"
#include "robot_tissue/core/removed_space.h"
#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/solve_report.h"
#include "robot_tissue/core/surface.h"
#include "robot_tissue/core/suture.h"

namespace robot_tissue {

struct NodeMotion;
struct SavedState;
struct TissueParts;

struct CutReport {
  int springs_cut = 0;   // by this cut
  int springs_torn = 0;  // by tear_stretch, thereafter
  int pieces = 1;        // of the lattice, after it
  SolveReport solve;     // balance after it; the last one when nothing was cut
  // Of cutAlong: new surface (m^2), and the mean of where its springs were crossed (m).
  double area = 0.0;
  Vec3 center = Vec3::Zero();
};

struct RemoveReport {
  double volume = 0.0;             // of what was removed, at rest (m^3)
  int pieces = 1;                  // of the lattice, after it
  std::vector<std::string> loads;  // named loads that went with all their nodes
  bool holds_all = false;          // of drill: nothing was removed, as nothing would be left
  SolveReport solve;               // balance after it; the last one when nothing was removed
};

// A part of the tissue in which springs that are not severed join all nodes.
struct TissuePiece {
  int number = 0;       // its own for as long as it lasts
  double volume = 0.0;  // at rest (m^3)
  bool fixed = false;   // a fixed node holds it
  // A fixed node, a patch, a touch of a tool, or a suture to a held piece holds it.
  bool held = false;
  Vec3 center = Vec3::Zero();  // of its volume, deformed (m, tissue frame)
};

// The way of a blade or burr from where it comes into the tissue to where it leaves it: whether a
// call begins one, or goes on with the last one.
enum class Stroke { kBegins, kGoesOn };

// Corners of a triangle that cuts (m, tissue frame).
using CutTriangle = std::array<Vec3, 3>;

struct SutureResult {
  SutureReport suture;
  SolveReport solve;  // balance after it
};

// What bears the tissue: fixed nodes alone, or supports, too, along which it may slide.
enum class Bedding { kFixedNodes, kSupports };

// Whether tools or supports are near in a time step. Where they are, the step is one of Euler's
// backward method; else of the generalized-alpha method, which is more exact (doc/time.md).
enum class Touched { kByNone, kByTools };

class Tissue {
 public:
  // Called after each increment of a load: 1-based increment, how many there are, what was solved.
  using OnIncrement = std::function<void(int increment, int increments, const SolveReport&)>;

  // Throws InputError: unknown model or method, a box without a node, ...
  Tissue(const TissueConfig& tissue, const SolverConfig& solver);
  ~Tissue();

  // References are to what the tissue has as long as it lives; what they refer to changes with it.
  const Lattice& lattice() const;
  const LatticeState& state() const;
  const TissueSurface& surface() const;
  // Deformed vertices of the surface (m, tissue frame).
  const std::vector<Vec3>& vertices() const;
  const Box& bounds() const;  // of vertices() (m, tissue frame)
  // Number of the piece that each node is of, the ghosts last, -1: removed. Of a piece that comes
  // apart the largest part keeps the number, the others get the next ones; undo and loadState bring
  // numbers back, a reset begins anew.
  const std::vector<int>& pieceOfNodes() const;
  std::vector<TissuePiece> pieces() const;  // by their numbers, ascending
  // As pieces(), but with their centers in the rest shape, which costs less: only what holds the
  // pieces is found anew each time.
  std::vector<TissuePiece> restingPieces() const;
  // Numbers of the pieces that were taken out, as nothing held them any more (tissue.free_pieces).
  const std::vector<int>& droppedPieces() const;
  // No tool touched it in the last solve.
  bool isUntouched() const;
  // Longest motion of a tool that one solve follows well (m).
  double stepLength() const;
  // What bounds the iterations of all of the tissue's solves.
  Patience& patience();
  const Patience& patience() const;
  // Standing loads in the order of SolveReport::patches: named patches, then the tools'.
  const std::vector<LoadingPatch>& patches() const;
  // How many of patches(), counted from the first, are named loads; the rest are the tools'.
  std::size_t namedPatches() const;

  // The nodes' displacements (m, tissue frame) as they are now, to be kept. While the shape stays
  // all calls give the same copy: one pointer, one shape.
  using Displacements = std::shared_ptr<const std::vector<Vec3>>;
  Displacements displacements() const;

  // Whether the model's cells push back when they are pressed flat: then a shape with cells inside
  // out is a wrong one.
  bool resistsInversion() const;
  // How many cells are so strained that the law `fung` goes on as a polynomial there
  // (doc/model.md).
  int cellsBeyondLaw() const;
  // What the method said of the present shape.
  const SolveReport& lastReport() const;
  // Makes lastReport() one of a shape that did not converge: for who knows a reason why the shape
  // cannot be right that the tissue does not know.
  void noteUnconverged();
  // Displacements as they are shown (m, tissue frame): nodes of a patch's rim where the patch has
  // them, nodes that a tool touches where the tool has them.
  std::vector<Vec3> shownDisplacement() const;
  // Net force of the springs, of threads (and of gravity) on a node (N, tissue frame): what a patch
  // node hands to its tool.
  Vec3 nodeForce(int node) const;
  std::vector<int> freeNodes() const;  // all nodes that are neither fixed nor removed, ascending
  // Of the tissue (N, tissue frame), but for pieces that hang: gravity pulls them and nothing bears
  // them, so that no shape is their balance. Where no time passes they stay as they are.
  Vec3 weight() const;
  bool anyHangs() const;
  // Names of the loads by force that move tissue that nothing else holds, without end, as a cut may
  // leave it. Where no time passes it stays as it is, and such a load has no answer: UNCONVERGED,
  // but where a tool touches the tissue.
  std::vector<std::string> adriftLoads() const;
  Vec3 forceOfFixedNodes() const;  // on the tissue (N, tissue frame)
  // Of the cells, against moving a node alone from rest, mean over the axes (N/m).
  double nodeStiffness(int node) const;
  // How many times nodeStiffness the node has in the time step under way or expected (1), where the
  // rate of strain and the node's mass count, too. 1: there is none, or the method goes through it.
  double stiffening(int node) const;
  Vec3 nodePosition(int node) const;  // deformed (m, tissue frame)
  // Of the material around the node, filled in part or not; none where method or model have no
  // rims.
  std::optional<RimModuli> rimModuli(int node) const;
  // Of a node `depth` spacings inside a plate's edge, < 0: beyond it (doc/model.md, "The rim").
  // None where cells at the node are filled in part, and where method or model have no rims.
  std::optional<RimCompliance> rimCompliance(int node, double depth) const;
  // How a tool holds the nodes that it has, ascending: springs to those that are not hard, without
  // anchors, of stiffness zero to those that it does not hold (core/loads/tool_bed.h). None where
  // method or model have no rims: all are hard.
  std::vector<RimSpring> springsUnder(const std::vector<SeatedNode>& nodes) const;
  // The way into the tissue (unit, tissue frame) as if the surface around `middle` (m, at rest),
  // out to three spacings and from the point up to folds at rest, had no dent; zero where it has no
  // area.
  Vec3 inwardsAround(const SurfacePoint& point, const Vec3& middle) const;
  // How much deeper than the lattice tells the shape goes into the tissue (narrow_contact.h). None
  // where the contact is wide, the tissue is of several materials around it or thinner than two
  // spacings, all that bears it is held, and where the method finds no equilibrium or the model has
  // no moduli.
  std::optional<Recess> recessUnder(const NarrowPress& press) const;

  // Asked after each solve; null: nobody. It outlives the tissue, or is taken back.
  void setContactUpdate(ContactUpdate* update);

  // Calls that follow begin no further solve after it, and tell what they leave as LATE; each makes
  // one solve at least, with one cycle of the method, but for a change of the topology, which may
  // leave it to the next call. Loads stop on their way then, to be carried on (loadOn). None:
  // solver.max_ms bounds each solve.
  void setDeadline(std::optional<Deadline> deadline);
  // Whether a solve and a look at the contacts, as short as the last ones, would end after the
  // deadline, but not if they were the first that a call does.
  bool isRoundForNextCall() const;

  // Something comes near, but does not touch yet: the solver makes what its first solve needs,
  // where nothing was solved for since the tissue, or its cells, are as they are.
  void expectTouch();

  // Equilibrium under what acts now, at rest: time stops (stopTime).
  SolveReport settle();

  // Whether tissue.time is set. Then time goes by in steps: what is called between beginTimeStep
  // and endTimeStep is of the step, its shape the one at the step's end; between two steps the
  // shape stays as it is. After stopTime, and before the first step, shapes are equilibria, at
  // rest.
  bool hasTime() const;
  bool isInTime() const;  // since the last stopTime time has gone by: nothing else moves the shape
  bool isMoving() const;  // time will change the shape
  // This, expectTimeStep, beginTimeStep and wait: only where hasTime().
  double longestTimeStep() const;  // that the error of the last one allows (s)
  // What is asked from here on is asked for a time step of `duration` (s), which is about to begin.
  void expectTimeStep(double duration, Touched touched);
  void beginTimeStep(double duration, Touched touched = Touched::kByNone);  // s
  void endTimeStep();
  bool isTimeStepOver() const;     // all its time is gone: no other solve is begun in it
  bool isTimeStepRefused() const;  // the one that ended last, as its error asks for shorter ones
  // Velocities are zero from here on, as where a motion leads to no shape; forces move on.
  void haltMotion();
  bool isInTimeStep() const;
  bool goesInTime() const;  // a time step is under way, or expected
  // A time step is under way or expected, and the method goes through it in shorter steps of its
  // own: then the forces of contacts are means over the time step.
  bool goesThroughTime() const;
  void stopTime();
  // Lets so much time (s) go by while no tool moves, in steps of an error within the tolerance. The
  // report has the worst status of all steps, and the work of all.
  SolveReport wait(double duration);
  // Brings the step's patches to their loads in increments; they stand until released. Throws
  // InputError: a patch whose box has no node, or a fixed one, or a node of another patch; one that
  // the method cannot turn; a load that needs more than most_increments.
  void load(const LoadStep& step, const OnIncrement& on_increment = {},
            int most_increments = 100000);
  // There was no time to come to balance, whatever else is to be said of the shape, or to bring
  // named patches to their loads.
  bool isLate() const;
  // False: the shape is in balance, but was shown before its contacts were settled (LoadStepBound).
  bool areContactsSettled() const;
  // Whether the shape may be shown before its contacts are settled, as tools stand no deeper in it
  // than the bound on the load step bears; and that it is.
  bool mayShowUnsettled() const;
  void noteUnsettled();
  bool isLoading() const;  // there was no time to bring named patches to their loads
  // Brings the patches that isLoading tells of on.
  void loadOn(const OnIncrement& on_increment = {});
  // What a named patch met (N, N m, m; tissue frame), of a report of this tissue; zero when there
  // is none of that name.
  PatchAnswer answerOf(const std::string& name, const SolveReport& report) const;
  // Takes named patches away; the shape is found anew from rest under the loads that stay. Throws
  // InputError for a name that no standing patch has.
  SolveReport release(const std::vector<std::string>& names);
  // Puts the tools' patches (m, tissue frame) in the place of the earlier ones and solves.
  // `disturbed`: nodes that left a patch. When the last tool has left, the shape is found anew from
  // rest, unless the tissue is borne by supports, which it may have slid along.
  SolveReport follow(std::vector<LoadingPatch> tool_patches, const std::vector<int>& disturbed,
                     Bedding bedding = Bedding::kFixedNodes);
  // The shape and its loads, to come back to; cuts are not part of it: those made since stay.
  struct Shape {
    Displacements displacement;
    std::shared_ptr<const CellSet> cells;  // whose nodes `displacement` is of
    std::vector<LoadingPatch> patches;
    std::size_t named_patches = 0;
    SolveReport report;
    bool is_late = false;
    bool are_contacts_settled = true;
    std::shared_ptr<const NodeMotion> motion;  // null: at rest
    bool in_time = false;
    std::vector<std::string> whole_sutures;  // that have not broken
    bool is_cut_short = false;               // a time step had no time to come to its end
    std::vector<int> disturbed;              // nodes of the lattice that are still to be balanced
  };
  Shape shape() const;
  void restore(const Shape& shape);  // of this tissue
  // Takes cells, shape, named loads and sutures of another tissue of the same lattice; at rest.
  void takeOver(const Tissue& other);
  // Between these two calls, solves teach the method nothing that later ones depend on.
  void beginAside();
  void endAside();
  // Severs the springs that cross the polygon (3 or more corners in order, m, tissue frame) in the
  // deformed shape, then balances; in time it only severs them. Throws InputError: fewer than 3
  // corners, one that is not finite, or no area.
  CutReport cut(const std::vector<Vec3>& corners);
  // Takes away what has its center in the space (m, tissue frame) in the deformed shape, in whole
  // cells and parts that cuts made of cells, then balances; in time it only takes away. Named loads
  // lose the nodes that go. Throws InputError when nothing would be left.
  RemoveReport remove(const RemovedSpace& space);
  // As remove, along a burr's way; where nothing would be left it removes nothing, and the report
  // tells (holds_all). All of a stroke is taken back as one removal.
  RemoveReport drill(const CoveredSpace& space, Stroke stroke);
  // How many cuts, removals, tears and sutures there are to take back: all since the last reset, or
  // loaded state.
  int undoable() const;
  // Takes the last `count` of them back. Where the named loads are those of before them, no tool
  // touches and the shape was in balance, it is that one, bit for bit; else it is balanced under
  // what stands now. What tore is whole again, also where it is stretched too far still
  // (isOverstretched): it tears with the next call that solves, as a change of its own. Throws
  // InputError for less than 1, or more than undoable().
  SolveReport undo(int count);
  // As cut, along a surface of triangles, such as a blade's edge sweeps; those without an area cut
  // nothing. All of a stroke is taken back as one cut.
  CutReport cutAlong(const std::vector<CutTriangle>& swept, Stroke stroke = Stroke::kBegins);
  // Drops pieces that nothing holds any more, where free pieces drop; severs what is stretched
  // beyond tear_stretch and balances, over and over, until nothing is. For shapes that tools make:
  // all other calls that solve, but `follow`, have torn already. LATE: the rest is left to the next
  // call.
  SolveReport tear();
  // Severs the springs between these nodes and the others, torn in one change, and balances; false:
  // there are none. For what a grasper holds.
  bool tearOut(const std::vector<int>& nodes);
  bool mayTear() const;          // `tear` may sever or drop something, now or in other shapes
  bool isOverstretched() const;  // `tear` would sever some now
  int springsTorn() const;       // since rest, or the state that was loaded
  // Joins two points of the surface by a thread, then balances; in time it only joins them. A cut
  // leaves each end on its side; where the tissue of an end goes the thread goes. Throws
  // InputError: numbers out of range, no name or one that is taken, a point farther than a spacing
  // off the surface, two ends at one point, a method that finds no equilibrium.
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
  // Of savedState: two states have the same hash only when they are the same, bit for bit.
  std::uint64_t stateHash() const;
  // Throws InputError, the reason alone, for bytes that are no state of this tissue.
  std::shared_ptr<const SavedState> readState(const std::string& bytes) const;
  // Back to that state, bit for bit where it was in balance without tools; else it is balanced.
  // Patches and sutures of now go.
  SolveReport loadState(const SavedState& saved);

 private:
  std::unique_ptr<TissueParts> parts_;  // the classes behind it, see doc/architecture.md
};

}  // namespace robot_tissue
