// How tissue that only supports bear comes to lie on them, where no time passes in the scene. A
// piece that falls, rolls or topples on its way has no balance near its shape for a solver to find,
// so its way is followed in time, by a pipeline of its own, until it rests.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "robot_tissue/core/deadline.h"
#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

class Landing {
 public:
  // Null: no tissue of that scene has to come to lie, or its membranes do not move in time.
  static std::unique_ptr<const Landing> ofScene(const TissueConfig& tissue,
                                                const SolverConfig& solver,
                                                const std::vector<SupportConfig>& supports);

  Landing(const TissueConfig& tissue, const SolverConfig& solver,
          std::vector<SupportConfig> supports);

  // When it is looked whether the tissue lies.
  enum class Look {
    kOnItsWay,  // it has become slow
    kLast,      // it is followed no further
    kAtRest
  };
  // Whether it lies in these displacements (m).
  using Lies = std::function<bool(const Tissue::Displacements&, Look)>;

  enum class End {
    kLies,
    kNothingBelow,  // or other tissue
    kGoesOn         // it lies nowhere within kLongestLanding, or before the end, or takes far too
                    // long (Patience)
  };
  // Follows the tissue, which no tool touches, from its present shape until it lies.
  End from(const Tissue& tissue, const Deadline& end, const Lies& lies) const;

 private:
  Tissue::Displacements lowered(const Tissue& tissue) const;
  bool anyLiesOnTissue(const Tissue& tissue, const std::map<int, double>& pieces) const;
  double clearance(const Vec3& point) const;
  double slowWay() const;

  TissueConfig tissue_;  // with time, and without tearing
  SolverConfig solver_;
  std::vector<SupportConfig> supports_;
};

}  // namespace robot_tissue
