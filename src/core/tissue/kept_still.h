// Pieces of which no shape is in balance, as gravity or given forces move them and nothing holds
// them: for one solve they are kept where they are.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "tissue/tissue_data.h"

namespace robot_tissue {

class KeptStill {
 public:
  // From here on they stand, by a patch of their own behind the others. The forces on them are off.
  explicit KeptStill(TissueData& data);
  // After the solve: the patches are again what they were. What would have to hold these pieces is
  // no answer to a load: what moves them is told to be adrift.
  void letGo(SolveReport& report);

 private:
  TissueData& data_;
  bool any_ = false;
  std::vector<std::pair<std::size_t, LoadingPatch>> adrift_;  // patches by force, by number
};

}  // namespace robot_tissue
