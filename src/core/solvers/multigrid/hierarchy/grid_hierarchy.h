// The tissue's lattice and, above it, lattices of twice, four times ... its spacing: what is smooth
// and far is found on the coarse ones (nonlinear multigrid: Brandt 1977; its use for this cell:
// own).
//
// Nodes move as the trilinear mean of the coarse nodes around them, P; a coarse node starts where
// the node at its place is. On the coarse lattice the forces are those of its own cells plus a
// load, chosen such that at the start they are P^T of the fine lattice's. What holds a fine node
// holds the coarse node at its place, and ties those around it; springs hang on the means.
//
// Of a block that is all there, each lattice is solved for in a part only, wider from level to
// level: nodes beyond are where the next coarser lattice has them, P again, so that what is solved
// for is a lattice whose spacing doubles with the distance (multilevel adaptive technique: Brandt
// 1977). Where two spacings meet, the forces of the fine cells go to the coarse nodes by P^T, so
// that nothing is lost there (fast adaptive composite grid: McCormick 1984).
//
// Lengths in spacings of the finest lattice, forces in modulus() * spacing^2, as GridLevel.
#pragma once

#include <vector>

#include "loads/dof_constraints.h"
#include "material/elastic_model.h"
#include "robot_tissue/core/lattice.h"
#include "solvers/multigrid/hierarchy/grid_transfer.h"
#include "solvers/multigrid/hierarchy/level_source.h"
#include "solvers/multigrid/level/grid_level.h"

namespace robot_tissue {

template <typename Real>
class GridHierarchy {
 public:
  // Open in the middle, where parts can be; else as a whole. The workers, null for none, must
  // outlive the levels.
  GridHierarchy(const Lattice& lattice, const ElasticModel& model, const CellSet& cells,
                Workers* workers);

  // Opens the least part that has the box (grid points), and more so many layers beyond on each
  // coarser lattice; all of it where that is little less. With the shape as it is; to be bound.
  // False: it was open, and still is.
  bool open(const GridBox& box, int layers, const std::vector<Vec3>& displacement);
  bool isWhole() const { return free_.front() == whole(); }
  const GridBox& free() const { return free_.front(); }  // nodes of the finest lattice
  GridBox whole() const;

  GridLevel<Real>& finest() { return levels_.front(); }
  const GridLevel<Real>& finest() const { return levels_.front(); }
  // Of the finest lattice; -1: not in the open part.
  int entryOf(int node) const;
  double modulus() const { return modulus_; }  // E0 (Pa)

  // Takes over what holds the nodes, and gravity. The shape's contacts must stay where they are.
  void bind(const ConstrainedState& shape, const DofConstraints& hold);
  // Places patches by force, and takes their motion so far as done.
  void renewGroups(const ConstrainedState& shape, const DofConstraints& hold);
  // Where nodes of which nothing is held are elsewhere than this lattice has them, all levels start
  // from there. True: there were some.
  bool setDisplacement(const std::vector<Vec3>& displacement,
                       const std::vector<std::uint8_t>& held);
  Vec3 displacementOf(int node) const;  // m
  // Components that are not held.
  void writeTo(std::vector<Vec3>& displacement, const std::vector<std::uint8_t>& held) const;

  bool isFinite() const;  // the shape

  // The smooth motion that goes with the finest lattice's forces, into `motion`.
  void findSmoothMotion();
  // Makes a share of it.
  void go(double share);
  Field<Real> motion;  // zero where the coarse lattices went astray
  std::vector<GroupVector> group_motion;

  // What is beyond the open part, by levels from the first coarse one on, in each one's units; what
  // finer ones cover is zero or left alone. Nothing where the whole is open.
  using Beyond = std::vector<Field<Real>>;
  Beyond placesBeyond() const;
  void putBeyond(const Beyond& places);
  void moveBeyond(const Beyond& step, double share);
  // Unbalanced there, with the finest lattice's forces as they are.
  Beyond findForcesBeyond();
  static double workBeyond(const Beyond& force, const Beyond& motion);
  // Squared and summed over the finest lattice's nodes, in its spacings.
  double squaredDistanceBeyond(const Beyond& places) const;
  double squaredMotionBeyond() const;  // of the smooth motion
  double squaredDisplacementBeyond() const;
  double squaredRoughnessBeyond() const;  // what trilinear means miss of the displacement

 private:
  // From a level to the next coarser one.
  struct LevelLink {
    GridTransfer<Real> transfer;
    std::vector<LevelSpring> ties;  // coarse springs for fine nodes that are held
    std::vector<int> sources;       // per coarse spring that stands for a fine one: that one
    Field<Real> start;              // displacement of the coarse nodes
    Field<Real> wanted;             // their forces
    std::vector<GroupVector> wanted_of_groups;
  };
  // What patches hold, as numbers that are compared; empty: not known.
  struct Bond {
    std::vector<double> held, springs;
  };

  // grid_hierarchy.cpp
  void openAll(const ElasticModel& model, const CellSet& cells);
  std::vector<LevelCell> finestCells(const ElasticModel& model, const CellSet& cells) const;
  void weigh(const ElasticModel& model, const CellSet& cells);
  void addLevel(const LevelGrid& grid, int beside, const std::vector<LevelCell>& cells,
                const LevelPart& part, double greatest_stiffness);
  void addLink(GridTransfer<Real> transfer);
  void noMotion();
  void correct(std::size_t level);
  void restrictTo(std::size_t coarse);
  void solveCoarse(std::size_t level);
  std::vector<GroupVector> groupMotion(std::size_t coarse) const;
  bool isMotionFinite() const;

  // level_constraints.cpp
  static Bond bondOf(const ConstrainedState& shape, const DofConstraints& hold);
  void holdFinest(const ConstrainedState& shape, const DofConstraints& hold);
  void holdCoarse(std::size_t level);
  void hangFinest(const ConstrainedState& shape, const DofConstraints& hold);
  void hangCoarse(std::size_t level);
  void renewSprings(const ConstrainedState& shape, const DofConstraints& hold);
  void addTies(std::size_t level);
  void addTie(std::size_t level, int node, unsigned axes, int group, const Vec3& arm);
  std::vector<LevelSpring::Carrier> freeCarriers(
      std::size_t level, const std::vector<LevelSpring::Carrier>& fine) const;

  // composite_grid.cpp
  void measureStiffness();
  GridBox middle() const;
  std::vector<GridBox> partsAround(const GridBox& box, int layers) const;
  void openParts(const std::vector<GridBox>& free);
  GridTransfer<Real> transferTo(std::size_t level, const LevelGrid& grid);
  GridBox pointsOf(std::size_t level) const;
  template <typename Visit>
  void forPoints(std::size_t level, Visit visit) const;
  void placeCoarse(const std::vector<Vec3>& displacement);
  void holdFixed(std::size_t level);

  // composite_grid_vectors.cpp
  template <typename Visit>
  void forRowsBeyond(std::size_t level, Visit visit) const;
  double squaredBeyond(std::size_t level, const Field<Real>& of, const Field<Real>* less) const;
  double roughness(std::size_t level) const;
  void takeMotion();
  Vec3 valueAt(std::size_t level, const std::array<int, 3>& place) const;
  void writeBeyond(std::vector<Vec3>& displacement) const;
  void putOpen(std::size_t level, const LevelGrid& grid, Field<Real>& all) const;
  void writePlanes(const GridTransfer<Real>& transfer, const Field<Real>& coarse,
                   std::vector<Vec3>& displacement) const;
  void writePlanes(const GridTransfer<Real>& transfer, const Field<Real>& coarse, int first,
                   int end, std::vector<Vec3>& displacement) const;
  void placeInterfaces();

  const Lattice& lattice_;
  Workers* workers_;
  std::vector<LevelSource> sources_;  // empty where parts cannot be open
  std::vector<GridBox> free_;         // per level, in points of its whole grid
  std::vector<GridLevel<Real>> levels_;
  std::vector<LevelLink> links_;  // from level i to i + 1
  std::vector<int> nodes_;        // of the tissue, in the open part
  std::vector<int> entries_;      // theirs
  Field<Real> weight_;            // of the nodes; empty without gravity
  Bond bond_;
  double spacing_ = 1.0;
  double modulus_ = 1.0;
  std::vector<Field<Real>> motions_;  // per level, on their way to it
  Beyond motion_beyond_;              // the smooth motion there
};

extern template class GridHierarchy<float>;
extern template class GridHierarchy<double>;

}  // namespace robot_tissue
