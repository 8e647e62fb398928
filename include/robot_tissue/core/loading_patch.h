// Data between stages, 3 of 4: what acts on the lattice.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/contact_spring.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class Lattice;
struct LatticeState;

// Joins a node at the rim of a patch to it (core/loads/patch_rim.h); the patch's other nodes are
// hard.
struct RimSpring {
  int node = 0;
  Vec3 stiffness = Vec3::Zero();  // along the patch's own x, y, z, which turn with it (N/m)
  Vec3 anchor = Vec3::Zero();     // the patch's end: what the node's displacement would be, were it
                                  // hard (m)
};

// What the law of rims takes of the tissue (doc/model.md, "The rim").
struct RimModuli {
  double stiffness = 0.0;  // shear modulus times spacing (N/m)
  double poisson_ratio = 0.0;
};

// Of the spring between a bonded flat plate and a node at its edge (m/N); infinite: free.
struct RimCompliance {
  double across = 0.0;  // in the surface, across the edge
  double along = 0.0;
  double normal = 0.0;
};

// Of a node `depth` spacings inside the plate's edge, < 0: beyond it.
RimCompliance rimCompliance(const RimModuli& moduli, double depth);

// A node that goes with a tool as part of one hard piece. Directions are of the tissue at rest.
struct SeatedNode {
  int node = 0;
  Vec3 outward = Vec3::Zero();  // to the tool
  double share = 0.0;           // how much of the law of rims holds (1)
  std::vector<FaceEdge> edges;  // of the tool's flat face, as seen from the node
};

// Where a patch stands that a force moves: its center moved, then it turned about that.
struct PatchPlace {
  Vec3 displacement = Vec3::Zero();  // from where the patch was put on (m)
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

// Nodes that move as one hard piece (paper, section 4.3: "a single hard surface patch"), and points
// of the surface that a tool pushes without holding them.
struct LoadingPatch {
  enum class Drive { kDisplacement, kForce };

  std::string name;         // of the load, or of the tool
  std::optional<int> tool;  // number of the tool or support whose patch it is; none: a named load
  std::vector<int> nodes;   // ascending
  std::vector<RimSpring> rim;  // ascending; nodes of the patch, and some next to it
  ContactSprings contacts;
  Drive drive = Drive::kDisplacement;
  std::vector<Vec3> displacement;  // kDisplacement: per node, from rest (m)
  std::array<bool, 3> free_axis = {{false, false, false}};  // kDisplacement: nodes slide along it
  Vec3 force = Vec3::Zero();                                // kForce: on the tissue (N)
  bool turns = false;          // kForce: also until the moment about its center is zero
  Vec3 center = Vec3::Zero();  // kForce: mean rest position of its nodes, where the force acts (m)
  PatchPlace place;            // kForce: the solver moves it, with its nodes and anchors
};

// A force moves the patch, not a given displacement.
bool byForce(const LoadingPatch& patch);

// True when the patch's nodes do not move along the axis by themselves.
bool holds(const LoadingPatch& patch, std::size_t axis);

// The patch's nodes without those that rim springs join to it.
std::vector<int> hardNodes(const LoadingPatch& patch);

// Displacements of the patch's nodes as the patch has them (m): of those in the rim, the anchors'.
std::vector<Vec3> ownDisplacement(const LoadingPatch& patch, const std::vector<Vec3>& displacement);

// Mean of ownDisplacement (m).
Vec3 meanDisplacement(const LoadingPatch& patch, const std::vector<Vec3>& displacement);

// Of the rim's springs on their nodes (N), added to what the nodes have. Energy in J.
void addRimForces(const LoadingPatch& patch, const std::vector<Vec3>& displacement,
                  std::vector<Vec3>& forces);
double rimEnergy(const LoadingPatch& patch, const std::vector<Vec3>& displacement);

// Of the springs in contact on the nodes (N), added to what the nodes have. Energy in J.
void addContactForces(const LoadingPatch& patch, const std::vector<Vec3>& displacement,
                      std::vector<Vec3>& forces);
double contactEnergy(const LoadingPatch& patch, const std::vector<Vec3>& displacement);

// Matrix of a rim spring's stiffness in the tissue frame (N/m).
Eigen::Matrix3d stiffnessOf(const LoadingPatch& patch, const RimSpring& spring);

// Moves a patch by force, with its hard nodes and anchors: by a translation (m), then by a turn
// about its center (rotation vector, rad).
void movePatch(const Lattice& lattice, LoadingPatch& patch, const Vec3& translation,
               const Vec3& turn, LatticeState& state);

// What a patch met, in the order of the patches.
struct PatchAnswer {
  Vec3 force = Vec3::Zero();         // of the patch on the tissue (N)
  Vec3 torque = Vec3::Zero();        // of that about the tissue frame's origin (N m)
  Vec3 displacement = Vec3::Zero();  // mean over its nodes, from rest (m)
  // Its force moves tissue that nothing else holds, without end: it was kept where it was.
  bool is_adrift = false;
};

// From the forces of the tissue, and of others' contacts, on its hard nodes, in their order (N;
// without those of rims).
PatchAnswer answerOf(const Lattice& lattice, const LatticeState& state, const LoadingPatch& patch,
                     const std::vector<Vec3>& on_hard_nodes);
// The hard nodes' of the forces on all nodes.
std::vector<Vec3> onHardNodes(const LoadingPatch& patch, const std::vector<Vec3>& forces);

}  // namespace robot_tissue
