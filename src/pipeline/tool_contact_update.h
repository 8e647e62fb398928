// Whether the contacts that a shape was solved for are those of the shape (Tissue asks).
#pragma once

#include <cstdint>
#include <vector>

#include "touch_finder.h"
#include "world.h"

namespace robot_tissue {

class ToolContactUpdate : public ContactUpdate {
 public:
  ToolContactUpdate(World& world, TouchFinder& touch_finder)
      : world_(world),
        touch_finder_(touch_finder),
        surface_revision_(world.tissue.surface().revision) {}

  std::vector<double> longestWays() override;
  double shareOfWay(const std::vector<Vec3>& before) override;
  bool renew(std::vector<LoadingPatch>& of_tools, Shape shape, Round round) override;

  double deepestShown() override;

  double leftInside() const { return left_inside_; }

  // Where the surface is another one, as after a cut, what touches and holds it is brought onto it.
  enum class Touches { kOfThisSurface, kGoOn, kMetAnew };
  Touches takeSurface();
  // On another tissue, which no tool touches yet.
  void beginAnew();

 private:
  // Of a link: in the box a vertex goes so far at once and no farther (m), and on that way it is
  // looked for in the link after each stride (m).
  struct Surroundings {
    Box box;
    double longest = 0.0;
    double stride = 0.0;
  };

  std::vector<Surroundings> surroundings() const;
  double shareOutside(double share, int strides, const std::vector<Vec3>& start) const;
  bool hasTimeForContactsOnly() const;
  std::vector<double> depthsAt(double share, const std::vector<Vec3>& start) const;
  std::vector<double> depthsIn(const std::vector<Vec3>& vertices) const;

  World& world_;
  TouchFinder& touch_finder_;
  std::uint64_t surface_revision_;
  std::vector<Vec3> now_;     // where the way that is looked at ends, of the lattice's own
  double contacts_ms_ = 0.0;  // that the last renewal took
  double left_inside_ = 0.0;  // depth of the deepest contact after the last solve (m)
};

}  // namespace robot_tissue
