#include "tearing.h"

#include <cstdint>

#include "stopwatch.h"

namespace robot_tissue {

void tearStretched(World& world) {
  if (world.is_trial || !world.tissue.mayTear()) return;
  const int before = world.tissue.springsTorn();
  const std::uint64_t topology = world.tissue.surface().revision;
  const Stopwatch watch(world.report.solve_ms);
  world.tissue.tear();
  if (world.tissue.surface().revision == topology) return;
  world.report.springs_torn += world.tissue.springsTorn() - before;
  world.report.changed = true;
  world.sliding.commit(world.pose, world.tissue);
}

}  // namespace robot_tissue
