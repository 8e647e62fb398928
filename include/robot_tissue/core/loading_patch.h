// Data between stages, 3 of 4: what acts on the lattice.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Nodes that move as one hard piece (paper, section 4.3: "a single hard surface patch").
struct LoadingPatch {
  enum class Drive { kDisplacement, kForce };

  std::string name;
  std::vector<int> nodes;  // ascending
  Drive drive = Drive::kDisplacement;
  std::vector<Vec3> displacement;  // kDisplacement: per node, from rest (m)
  std::array<bool, 3> free_axis = {{false, false, false}};  // kDisplacement: nodes slide along it
  Vec3 force = Vec3::Zero();                                // kForce: on the tissue (N)
};

// True when the patch's nodes do not move along the axis by themselves.
bool holds(const LoadingPatch& patch, std::size_t axis);

// Mean over the patch's nodes of a displacement given per node of the lattice (m).
Vec3 meanDisplacement(const LoadingPatch& patch, const std::vector<Vec3>& displacement);

// What a patch met, in the order of the patches.
struct PatchAnswer {
  Vec3 force = Vec3::Zero();         // of the patch on the tissue (N)
  Vec3 displacement = Vec3::Zero();  // mean over its nodes, from rest (m)
};

}  // namespace robot_tissue
