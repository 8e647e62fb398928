// What Tissue asks after each solve while tools touch; answered by whoever knows the contacts.
#pragma once

#include <vector>

#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class ContactUpdate {
 public:
  // Of the shape there is: what was solved for, and in balance; or not there yet.
  enum class Shape { kSolved, kOnItsWay };
  // Whether a solve with what was renewed may follow.
  enum class Round { kNext, kLast };

  virtual ~ContactUpdate() = default;

  // Per vertex of the surface: how far it may go at once from where it is (m); empty: anywhere.
  virtual std::vector<double> longestWays() = 0;
  // Share of the way from these displacements to the present ones that may be gone at once: the
  // rest is solved for anew, with the contacts at that shape.
  virtual double shareOfWay(const std::vector<Vec3>& before) = 0;
  // When the contacts are no longer those that the shape was solved for, puts the tools' new
  // patches in (but in the last round) and returns true: it is solved again.
  virtual bool renew(std::vector<LoadingPatch>& of_tools, Shape shape, Round round) = 0;
  // After renew: how deep a tool or support stands in what is shown (m).
  virtual double deepestShown() { return 0.0; }
};

}  // namespace robot_tissue
