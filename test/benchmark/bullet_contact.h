// A block of tissue that a rigid tool touches, as Bullet's deformable world has it: an outside
// peer, as bullet_body.h.
#pragma once

#include <memory>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// How Bullet goes through time.
struct BulletPace {
  int steps = 32;                // in which a way of the tool is gone
  double duration = 1.0 / 60.0;  // s: of a way
  bool implicit = false;         // elastic forces, too, not damping alone
};

// On the straight way between two places of a tool, turned as at its end.
inline Pose onTheWay(const Pose& from, const Pose& to, double share) {
  Pose place = to;
  place.translation() = from.translation() + share * (to.translation() - from.translation());
  return place;
}

class BulletContact {
 public:
  // The tool has one shape, a ball or a box, in its frame. Throws InputError on others.
  BulletContact(const TissueConfig& tissue, const ToolConfig& tool, const Pose& tissue_T_tool,
                const BulletPace& pace);
  ~BulletContact();

  const Lattice& lattice() const;
  void goTo(const Pose& tissue_T_tool);
  // Whether all nodes are at finite places no farther from rest than the block is wide.
  bool isWhole() const;
  Vec3 displacement(int node) const;  // m, from rest
  // Of the tissue on the tool, by what holds the fixed nodes (N).
  Vec3 forceOnTool() const;
  // Of the deepest node in the tool (m); 0: none is in it.
  double penetration() const;
  int contacts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace robot_tissue
