#include "broad_phase.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>

namespace robot_tissue {
namespace {

using Type = ToolShape::Type;
using Met = fcl::CollisionObjectd;

// Of meshes the box around them.
std::shared_ptr<fcl::CollisionGeometryd> geometryOf(const CollisionShape& shape) {
  const ToolShape& measures = shape.measures();
  switch (measures.type) {
    case Type::kSphere:
      return std::make_shared<fcl::Sphered>(measures.radius);
    case Type::kBox:
      return std::make_shared<fcl::Boxd>(measures.size);
    case Type::kCylinder:
      return std::make_shared<fcl::Cylinderd>(measures.radius, measures.length);
    case Type::kMesh:
      return std::make_shared<fcl::Boxd>(Vec3(shape.mesh().bounds().sizes()));
    case Type::kPlane:
      break;
  }
  return nullptr;
}

// Whether every point of the box is farther than the margin (m) above the plane, by the ball around
// it.
bool isAbove(const PlacedShape& plane, const Box& box, double margin) {
  const Vec3 center = plane.shape_T_tissue * Vec3(box.center());
  return plane.shape->distance(center).value > 0.5 * box.diagonal().norm() + margin;
}

}  // namespace

// A shape as FCL's broad phase has it, with our own box in the place of FCL's: FCL's is around a
// ball around the turned shape, and wider.
class BroadPhase::Object : public fcl::CollisionObjectd {
 public:
  using fcl::CollisionObjectd::CollisionObjectd;

  void place(const PlacedShape& placed, double margin) {
    t = placed.tissue_T_shape;
    placeBox(grownBy(margin, placed.bounds));
  }
  void placeBox(const Box& box) {
    aabb.min_ = box.min();
    aabb.max_ = box.max();
  }
};

BroadPhase::BroadPhase()
    : manager_(std::make_unique<fcl::DynamicAABBTreeCollisionManagerd>()),
      tissue_(std::make_unique<Object>(std::make_shared<fcl::Boxd>(1.0, 1.0, 1.0))) {}
BroadPhase::~BroadPhase() = default;
BroadPhase::BroadPhase(BroadPhase&&) noexcept = default;

void BroadPhase::addLink(const std::vector<CollisionShape>& shapes) {
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    Entry entry{{links_, shape}, nullptr};
    if (const auto geometry = geometryOf(shapes[shape])) {
      entry.object = std::make_unique<Object>(geometry);
      manager_->registerObject(entry.object.get());
    }
    entries_.push_back(std::move(entry));
  }
  ++links_;
}

std::vector<BroadPhase::Near> BroadPhase::nearTo(const Box& box,
                                                 const std::vector<PlacedLink>& links,
                                                 double margin) {
  std::vector<Near> near;
  for (Entry& entry : entries_) {
    const auto& [link, shape] = entry.number;
    if (entry.object) entry.object->setUserData(&entry.number);
    if (shape >= links[link].size()) continue;  // the link's pose is not rigid: it touches nothing
    if (entry.object) {
      entry.object->place(links[link][shape], margin);
    } else if (!isAbove(links[link][shape], box, margin)) {
      near.push_back(entry.number);
    }
  }
  manager_->update();
  tissue_->placeBox(box);
  manager_->collide(tissue_.get(), &near, [](Met* one, Met* other, void* data) {
    const void* number = one->getUserData() ? one->getUserData() : other->getUserData();
    static_cast<std::vector<Near>*>(data)->push_back(*static_cast<const Near*>(number));
    return false;
  });
  near.erase(std::remove_if(near.begin(), near.end(),
                            [&](const Near& n) { return n.shape >= links[n.link].size(); }),
             near.end());
  std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) {
    return a.link != b.link ? a.link < b.link : a.shape < b.shape;
  });
  return near;
}

}  // namespace robot_tissue
