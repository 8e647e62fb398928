// Pipeline: trial steps, after which all is put back as it was.
#include "pipeline_parts.h"

namespace robot_tissue {

struct Pipeline::Mark {
  Tissue::Shape shape;
  WorldState world;
  State state;
  std::shared_ptr<const ContactFinder::Kept> searches;
};

void Pipeline::beginTrial() {
  if (!state_.under_way.isOf(world_.tissue)) state_.under_way.forget();
  trial_from_ = std::make_shared<const Mark>(Mark{
      world_.tissue.shape(), static_cast<const WorldState&>(world_), state_, world_.finder.kept()});
  world_.tissue.beginAside();
  world_.is_trial = true;
}

void Pipeline::undoTrial() {
  if (!trial_from_) return;
  const std::shared_ptr<const Mark> mark = trial_from_;
  endTrial();
  world_.tissue.restore(mark->shape);
  world_.takeBack(mark->world);
  state_ = mark->state;
  state_.under_way.beginAt(world_.tissue);
  world_.finder.restore(*mark->searches, world_.tissue.surface(), world_.tissue.vertices());
}

// With what it did, if it is not undone before.
void Pipeline::endTrial() {
  trial_from_.reset();
  world_.is_trial = false;
  world_.tissue.endAside();
}

}  // namespace robot_tissue
