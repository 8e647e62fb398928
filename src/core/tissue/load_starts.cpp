// LoadProgram: the patches of a load, and where they start.
#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/text_of.h"
#include "loads/patch_bed.h"
#include "loads/patch_rim.h"
#include "material/tissue_model.h"
#include "tissue/load_program.h"
#include "tissue/refused_patch.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

// The center of a patch that turns is that of its nodes at rest.
void driveByForce(const PatchConfig& config, const Lattice& lattice, bool may_turn,
                  LoadingPatch& patch) {
  patch.drive = LoadingPatch::Drive::kForce;
  patch.force = *config.force;
  if (config.turns && !may_turn) {
    refusePatch(config.name, "turns: this method moves patches without turning them",
                "turns false, or another method");
  }
  if (config.turns && areOnALine(lattice, patch.nodes)) {
    refusePatch(config.name, "turns: its nodes are on a line, which nothing keeps from turning",
                "turns false, or a box of nodes on more than one line");
  }
  patch.turns = config.turns;
  patch.center = restCenter(lattice, patch.nodes);
}

void driveByDisplacement(const PatchConfig& config, LoadingPatch& patch) {
  Vec3 displacement = Vec3::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<double>& component = (*config.displacement)[axis];
    patch.free_axis[axis] = !component;
    displacement[static_cast<Eigen::Index>(axis)] = component.value_or(0.0);
  }
  patch.displacement.assign(patch.nodes.size(), displacement);
  for (RimSpring& spring : patch.rim) {
    spring.anchor = displacement;
    for (int axis = 0; axis < 3; ++axis) {
      if (patch.free_axis[at(axis)]) spring.stiffness[axis] = 0.0;
    }
  }
}

// A patch as it stands, one hard piece: where it has nodes that it did not hold or join so far.
class HardPiece {
 public:
  // The displacement of each of its nodes (m).
  HardPiece(const Lattice& lattice, const LoadingPatch& patch, const std::vector<Vec3>& own)
      : lattice_(lattice), rotation_(patch.place.rotation) {
    for (std::size_t i = 0; i < own.size(); ++i) {
      const Vec3 rest = lattice.restPosition(patch.nodes[i]);
      shift_ += (rest + own[i] - rotation_ * rest) / static_cast<double>(own.size());
    }
  }

  Vec3 displacementOf(int node) const {
    const Vec3 rest = lattice_.restPosition(node);
    return rotation_ * rest + shift_ - rest;
  }

 private:
  const Lattice& lattice_;
  const Eigen::Matrix3d rotation_;
  Vec3 shift_ = Vec3::Zero();
};

// Where a patch's rim reaches nodes of another one, these are the other's alone.
void leaveRimsToOwners(std::vector<LoadingPatch>& patches) {
  std::unordered_map<int, const LoadingPatch*> owners;
  for (const LoadingPatch& patch : patches) {
    for (const int node : patch.nodes) owners[node] = &patch;
  }
  for (LoadingPatch& patch : patches) {
    const auto foreign = [&](const RimSpring& spring) {
      const auto owner = owners.find(spring.node);
      return owner != owners.end() && owner->second != &patch;
    };
    patch.rim.erase(std::remove_if(patch.rim.begin(), patch.rim.end(), foreign), patch.rim.end());
  }
}

}  // namespace

std::vector<LoadRamp> LoadProgram::rampsTo(const std::vector<LoadingPatch>& targets) const {
  std::vector<LoadRamp> ramps;
  for (const LoadingPatch& target : targets) {
    ramps.push_back(makeRamp(target, data_.loads.find(target.name)));
  }
  return ramps;
}

// A new patch by force keeps the shape that its nodes have: where there was no time to balance
// that, it is balanced first, as far as there is time now. False: there was nothing to do.
bool LoadProgram::comesToBalanceBefore(const std::vector<LoadingPatch>& targets) {
  const auto keeps_shape = [&](const LoadingPatch& target) {
    const LoadingPatch* standing = data_.loads.find(target.name);
    return byForce(target) && (standing == nullptr || !byForce(*standing));
  };
  const bool any = data_.methods.now().findsEquilibrium() &&
                   std::any_of(targets.begin(), targets.end(), keeps_shape);
  int solves = 0;
  while (any && data_.outcome.is_late && !data_.bounds.isTimeOver() &&
         solves < tuning::kMostBalances) {
    solver_.solve({});
    ++solves;
  }
  return solves > 0;
}

void LoadProgram::placeStarts(std::vector<LoadRamp>& ramps) {
  for (LoadRamp& ramp : ramps) {
    const LoadingPatch* standing = data_.loads.find(ramp.target.name);
    if (standing != nullptr && byForce(ramp.target) && standing->nodes != ramp.target.nodes) {
      layNewNodes(*standing, ramp.start);
    }
    ramp.patch = data_.loads.place(ramp.start);
  }
  leaveRimsToOwners(data_.loads.patches());
}

// Nodes that the patch did not hold so far, as a removal took them and they are there again, go
// where its other nodes have them: it is one hard piece.
void LoadProgram::layNewNodes(const LoadingPatch& standing, LoadingPatch& start) const {
  LatticeState& state = data_.body.change();
  const HardPiece piece(data_.body.lattice(), standing,
                        ownDisplacement(standing, state.displacement));
  const auto has = [](const auto& nodes, int node) {
    return std::binary_search(nodes.begin(), nodes.end(), node);
  };
  for (const int node : start.nodes) {
    if (!has(standing.nodes, node)) state.displacement[at(node)] = piece.displacementOf(node);
  }
  std::vector<int> rim_before;
  for (const RimSpring& spring : standing.rim) rim_before.push_back(spring.node);
  for (RimSpring& spring : start.rim) {
    if (!has(rim_before, spring.node)) spring.anchor = piece.displacementOf(spring.node);
  }
}

std::vector<int> LoadProgram::nodesLeftIn(const Box& box) const {
  const LatticeState& state = data_.body.state();
  std::vector<int> nodes = data_.body.lattice().nodesIn(box);
  nodes.erase(
      std::remove_if(nodes.begin(), nodes.end(), [&](int node) { return isRemoved(state, node); }),
      nodes.end());
  return nodes;
}

// Anchors at rest.
std::vector<RimSpring> LoadProgram::springsAround(const Box& box,
                                                  const std::vector<int>& nodes) const {
  if (!data_.methods.now().findsEquilibrium()) return {};
  const Body& body = data_.body;
  const auto bed = bedOf(body.lattice(), body.model(), body.state(), box, nodes);
  return bed ? *bed : rimOf(body.lattice(), body.model(), body.state(), box, nodes);
}

// A load that a removal took nodes from has what is left of it until it is put on again.
void LoadProgram::joinAnew() {
  data_.loads.forEach([&](LoadingPatch& patch) {
    const Box* box = patch.tool ? nullptr : data_.history.boxOf(patch.name);
    if (box != nullptr && nodesLeftIn(*box) == patch.nodes) joinAnew(*box, patch);
  });
  leaveRimsToOwners(data_.loads.patches());
}

void LoadProgram::joinAnew(const Box& box, LoadingPatch& patch) const {
  const HardPiece piece(
      data_.body.lattice(), patch,
      byForce(patch) ? ownDisplacement(patch, data_.body.displacement()) : patch.displacement);
  const std::vector<RimSpring> earlier = std::exchange(patch.rim, springsAround(box, patch.nodes));
  for (RimSpring& spring : patch.rim) {
    const auto same = std::find_if(earlier.begin(), earlier.end(), [&](const RimSpring& other) {
      return other.node == spring.node;
    });
    spring.anchor = same != earlier.end() ? same->anchor : piece.displacementOf(spring.node);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!holds(patch, axis)) spring.stiffness[static_cast<Eigen::Index>(axis)] = 0.0;
    }
  }
}

LoadingPatch LoadProgram::makePatch(const PatchConfig& config) const {
  const Lattice& lattice = data_.body.lattice();
  LoadingPatch patch;
  patch.name = config.name;
  patch.nodes = nodesLeftIn(config.box);
  if (patch.nodes.empty())
    refusePatch(config.name, "no node in its box, " + textOf(config.box) + " m",
                "a box that holds a node");
  if (std::any_of(patch.nodes.begin(), patch.nodes.end(),
                  [&](int node) { return lattice.isFixed(node); })) {
    refusePatch(config.name, "its box holds fixed nodes", "a box of free nodes");
  }
  patch.rim = springsAround(config.box, patch.nodes);
  if (config.force) {
    driveByForce(config, lattice, data_.methods.now().findsEquilibrium(), patch);
  } else {
    driveByDisplacement(config, patch);
  }
  return patch;
}

// Starts where the patch stands, or where the nodes of a new one are, with the force it finds.
LoadRamp LoadProgram::makeRamp(const LoadingPatch& target, const LoadingPatch* standing) const {
  LoadRamp ramp;
  ramp.target = target;
  ramp.start = target;
  const std::vector<Vec3>& displacement = data_.body.displacement();
  for (RimSpring& spring : ramp.start.rim) spring.anchor = displacement[at(spring.node)];
  ramp.start.place = PatchPlace();
  if (standing != nullptr) {
    for (RimSpring& spring : ramp.start.rim) {
      for (const RimSpring& earlier : standing->rim) {
        if (earlier.node == spring.node) spring.anchor = earlier.anchor;
      }
    }
    if (standing->drive == target.drive) ramp.start.place = placeAbout(target.center, *standing);
  }
  if (byForce(target)) {
    ramp.start.force = patchForce(ramp.start);
    return ramp;
  }
  ramp.start.displacement = ownDisplacement(ramp.start, displacement);
  return ramp;
}

Vec3 LoadProgram::patchForce(const LoadingPatch& patch) const {
  const LatticeState& state = data_.body.state();
  std::vector<Vec3> forces(state.displacement.size(), Vec3::Zero());
  for (const int node : patch.nodes) forces[at(node)] = forces_.nodeForce(node);
  for (const LoadingPatch& other : data_.loads.patches()) {
    addContactForces(other, state.displacement, forces);
  }
  return answerOf(data_.body.lattice(), state, patch, onHardNodes(patch, forces)).force;
}

}  // namespace robot_tissue
