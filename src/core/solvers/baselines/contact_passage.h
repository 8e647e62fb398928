// Touches of tools in a time step that a method goes through in small steps. The tools' planes, and
// what friction is anchored to, go evenly from where they were to where they are. In each small
// step, of duration h, a touch pushes where its nodes came without it, implicitly (own; the forward
// increment form of Carpenter, Taylor and Katona 1991 with a spring and a dashpot for its rigid
// constraint):
//
//   f = max(0, multiplier - k g - c dg/dt),   c = 2 (k m)^(1/2),   g after the push
//
// c is critical for the mass m of the touch's nodes: what meets a tool does not bounce off it, as
// it would off a spring alone. Friction likewise, cut to its bound. What a touch is told to have
// pushed with is the mean of the step.
#pragma once

#include <functional>
#include <vector>

#include "loads/constrained_state.h"

namespace robot_tissue {

class ContactPassage {
 public:
  struct SmallStep {
    double end = 0.0;    // share of the time step that is gone after it
    double share = 0.0;  // of the time step
  };
  // Of a node: square of the small step's duration over its mass, per axis; 0 where held (m/N).
  using Mobility = std::function<Vec3(int node)>;
  // Moves the node, and its displacement in the shape, by its mobility times the force (N).
  using Push = std::function<void(int node, const Vec3& force)>;

  // The shape is that at the step's start. Its touches have no force until this goes: they do not
  // act by their energy.
  explicit ContactPassage(ConstrainedState& shape);
  ~ContactPassage();
  ContactPassage(const ContactPassage&) = delete;
  ContactPassage& operator=(const ContactPassage&) = delete;

  void push(const SmallStep& step, const Mobility& mobility, const Push& push);

  // At the end: the springs' forces there are the mean ones.
  void tellMeans();

 private:
  struct Touch {
    std::size_t patch, number;     // in the patch
    Vec3 before = Vec3::Zero();    // point less the plane's way, a small step ago (m)
    double normal_force = 0.0;     // mean (N)
    Vec3 friction = Vec3::Zero();  // mean (N)
  };

  const ContactSpring& springOf(const Touch& touch) const {
    return springs_[touch.patch][touch.number];
  }

  ConstrainedState& shape_;
  std::vector<ContactSprings> springs_;  // per patch, of the step's end
  std::vector<Touch> touches_;
};

}  // namespace robot_tissue
