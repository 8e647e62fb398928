#include "solvers/multigrid/cycle/patch_answers.h"

#include <algorithm>

namespace robot_tissue {

std::optional<double> movePatches(const Lattice& lattice, const std::vector<GroupVector>& motions,
                                  ConstrainedState& shape) {
  std::optional<double> turned;
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    LoadingPatch& patch = shape.patches[index];
    const GroupVector& motion = motions[index];
    if (!byForce(patch) || motion.isZero(0.0)) continue;
    movePatch(lattice, patch, lattice.spacing() * motion.head<3>(), motion.tail<3>(), shape.state);
    turned = std::max(turned.value_or(0.0), motion.tail<3>().norm());
  }
  return turned;
}

PatchAnswers answersOf(const Lattice& lattice, const SolveContext& solve,
                       const std::function<Vec3(int)>& forceOn) {
  const LatticeState& state = solve.shape.state;
  PatchAnswers answers;
  const auto note = [&answers](const Vec3& force) {
    answers.greatest = std::max(answers.greatest, force.norm());
  };
  for (std::size_t index = 0; index < solve.shape.patches.size(); ++index) {
    const LoadingPatch& patch = solve.shape.patches[index];
    std::vector<Vec3> on_hard;
    for (const int node : solve.hold.hardOf(index)) {
      on_hard.push_back(forceOn(node));
      note(on_hard.back());
    }
    for (const RimSpring& spring : patch.rim) {
      const Vec3 stretch = spring.anchor - state.displacement[at(spring.node)];
      note(stiffnessOf(patch, spring) * stretch);
    }
    for (const ContactSpring& spring : patch.contacts) note(forceOf(spring, state.displacement));
    answers.all.push_back(answerOf(lattice, state, patch, on_hard));
  }
  return answers;
}

}  // namespace robot_tissue
