#include "unfinished_load_step.h"

#include <utility>

namespace robot_tissue {

void UnfinishedLoadStep::keep(Rest rest, const Tissue& tissue) {
  kept_ = Kept{std::move(rest), tissue.displacements(), tissue.surface().revision};
}

bool UnfinishedLoadStep::isOf(const Tissue& tissue) const {
  return kept_ && kept_->from == tissue.displacements() &&
         kept_->surface_revision == tissue.surface().revision;
}

UnfinishedLoadStep::Rest UnfinishedLoadStep::take() {
  Rest rest = std::move(kept_->rest);
  kept_.reset();
  return rest;
}

void UnfinishedLoadStep::beginAt(const Tissue& tissue) {
  if (kept_) kept_->from = tissue.displacements();
}

}  // namespace robot_tissue
