// While one lives, what is severed, removed or sutured, and what tears of that, is one change to
// take back.
#pragma once

#include "tissue/history.h"
#include "tissue/partings.h"
#include "tissue/threads.h"
#include "tissue/tissue_parts.h"

namespace robot_tissue {

class TissueParts::TopologyChange {
 public:
  // To be made before the change, where something will change. One within another is part of it.
  TopologyChange(TissueParts& tissue, History::Kind kind)
      : tissue_(tissue), is_outermost_(!tissue.history_.isUnderWay()) {
    if (is_outermost_ && tissue_.history_.begins(kind)) {
      const LatticeState& state = tissue_.body_.state();
      tissue_.history_.begin(kind,
                             {{state.severed.begin(), state.severed.end()},
                              partingsOf(state),
                              state.ahead,
                              state.taken,
                              tissue_.threads_.all(),
                              tissue_.pieces_.numbers(),
                              std::make_shared<const SavedState>(tissue_.stateNow())},
                             tissue_.loads_.namedLoads());
    }
  }
  ~TopologyChange() {
    if (is_outermost_) tissue_.history_.end(tissue_.loads_.namedLoads());
  }
  TopologyChange(const TopologyChange&) = delete;
  TopologyChange& operator=(const TopologyChange&) = delete;

 private:
  TissueParts& tissue_;
  bool is_outermost_;
};

}  // namespace robot_tissue
