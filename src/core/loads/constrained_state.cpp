#include "loads/constrained_state.h"

namespace robot_tissue {

Vec3 centerOf(const LoadingPatch& patch) { return patch.center + patch.place.displacement; }

}  // namespace robot_tissue
