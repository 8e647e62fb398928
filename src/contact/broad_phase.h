// Which shapes of the links come near the tissue, by FCL's broad phase. FCL's objects are made once
// and only placed anew.
#pragma once

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <memory>
#include <vector>

#include "placed_link.h"

namespace robot_tissue {

class BroadPhase {
 public:
  BroadPhase();
  ~BroadPhase();
  BroadPhase(BroadPhase&&) noexcept;

  void addLink(const std::vector<CollisionShape>& shapes);

  struct Near {
    std::size_t link, shape;
  };
  // Those whose boxes are nearer to the box (tissue frame, m) than the margin, by links and shapes.
  // In: all links, as they were added.
  std::vector<Near> nearTo(const Box& box, const std::vector<PlacedLink>& links, double margin);

 private:
  class Object;
  struct Entry {
    Near number;
    std::unique_ptr<Object> object;  // none for a plane, which has no box
  };

  std::vector<Entry> entries_;
  std::size_t links_ = 0;
  std::unique_ptr<fcl::DynamicAABBTreeCollisionManagerd> manager_;
  std::unique_ptr<Object> tissue_;  // as a box
};

}  // namespace robot_tissue
