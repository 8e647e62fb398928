// While one lives, what is severed, removed or sutured, and what tears of that, is one change to
// take back.
#pragma once

#include <memory>

#include "tissue/partings.h"
#include "tissue/tissue_data.h"

namespace robot_tissue {

class TopologyChange {
 public:
  // To be made before the change, where something will change. One within another is part of it.
  TopologyChange(TissueData& data, History::Kind kind)
      : data_(data), is_outermost_(!data.history.isUnderWay()) {
    if (is_outermost_ && data_.history.begins(kind, data_.loads.namedLoads())) {
      const LatticeState& state = data_.body.state();
      data_.history.begin(kind,
                          {{state.severed.begin(), state.severed.end()},
                           partingsOf(state),
                           state.ahead,
                           state.taken,
                           data_.threads.all(),
                           data_.pieces.numbers(),
                           std::make_shared<const SavedState>(data_.saved())},
                          data_.loads.namedLoads());
    }
  }
  ~TopologyChange() {
    if (is_outermost_) data_.history.end(data_.loads.namedLoads());
  }
  TopologyChange(const TopologyChange&) = delete;
  TopologyChange& operator=(const TopologyChange&) = delete;

 private:
  TissueData& data_;
  bool is_outermost_;
};

}  // namespace robot_tissue
