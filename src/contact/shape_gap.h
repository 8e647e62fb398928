// Distance between two shapes, by FCL where no formula of our own is at hand.
#pragma once

#include <memory>

#include "placed_link.h"

namespace robot_tissue {

// A shape without its padding as FCL has it. None for spheres and planes.
class GapShape {
 public:
  explicit GapShape(const CollisionShape& shape);
  ~GapShape();
  GapShape(GapShape&&) noexcept;

  struct FclObject;
  const FclObject* object() const { return object_.get(); }

 private:
  std::unique_ptr<FclObject> object_;
};

struct GapSide {
  const PlacedShape* placed = nullptr;
  const GapShape* shape = nullptr;
  const std::vector<Vec3>* points = nullptr;  // surfacePoints()
};

// Between the padded shapes (m), 0 when they overlap. One that is wider than `reach` (m) may be
// told less, but wider than that.
double gapBetween(const GapSide& a, const GapSide& b, double reach);

}  // namespace robot_tissue
