// A load step that time ran out in, to be gone on with from what it came to: a slip takes many
// updates' time, and begun anew it would never be through.
#pragma once

#include <cstdint>
#include <optional>

#include "checkpoint.h"

namespace robot_tissue {

// What is done with a shape that did not converge.
enum class IfUnconverged { kTake, kRefuse };

class UnfinishedLoadStep {
 public:
  struct Rest {
    Checkpoint came_to;
    IfUnconverged otherwise = IfUnconverged::kTake;
    int iterations = 0;  // so far
  };

  // From the shape that there is, the last good one.
  void keep(Rest rest, const Tissue& tissue);
  // Whether there is one, and nothing else moved or cut the tissue since.
  bool isOf(const Tissue& tissue) const;
  const RobotPose& goesTo() const { return kept_->rest.came_to.pose; }  // only where there is one
  // Takes it up; then there is none. Only where there is one.
  Rest take();
  void forget() { kept_.reset(); }
  // The shape that it began at is there anew.
  void beginAt(const Tissue& tissue);

 private:
  struct Kept {
    Rest rest;
    Tissue::Displacements from;          // the last good shape
    std::uint64_t surface_revision = 0;  // of that shape
  };

  std::optional<Kept> kept_;
};

}  // namespace robot_tissue
