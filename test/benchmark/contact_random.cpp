// Three tools that move at random (random_visits.h).
//   contact_random [MOTIONS] [FRICTION] [SPACING in mm] [SEED] [METHOD] [FIRST motion to tell of]
//                  [FIRST VISIT, those before are left out]
// Writes one line a visit (from the rest shape until all tools have left): seed,friction,visit,
// motions,load_steps,not_finite,inverted_updates,inverted_at_leave,left_mm,greatest_force_n,
// deepest_mm,most_displacement_mm,unconverged,s,lost,deepest_followed_mm; lost: updates in which no
// shape could follow the tools, deepest_followed_mm of the others. With FIRST, one line a motion on
// stderr, too.
#include "random_visits.h"

int main(int argc, char** argv) {
  using namespace robot_tissue;
  const int motions = static_cast<int>(argument(argc, argv, 1, 10000.0));
  RandomVisits::Trial trial;
  trial.friction = argument(argc, argv, 2, 0.3);
  trial.spacing = 1e-3 * argument(argc, argv, 3, 10.0);
  trial.seed = static_cast<unsigned>(argument(argc, argv, 4, 1.0));
  if (argc > 5) trial.method = argv[5];
  trial.first_told = static_cast<int>(argument(argc, argv, 6, -1.0));
  RandomVisits visits(trial);
  std::printf(
      "seed,friction,visit,motions,load_steps,not_finite,inverted_updates,inverted_at_leave,"
      "left_mm,greatest_force_n,deepest_mm,most_displacement_mm,unconverged,s,lost,deepest_"
      "followed_mm\n");
  const int first = static_cast<int>(argument(argc, argv, 7, 0.0));
  for (int number = 0; number < first; ++number) visits.skip();
  for (int number = first; number < motions / RandomVisits::kMotionsOfVisit; ++number) {
    const RandomVisits::Sums sums = visits.visit(number);
    std::printf("%u,%g,%d,%d,%d,%d,%d,%d,%.9g,%.3f,%.3f,%.2f,%d,%.2f,%d,%.3f\n", trial.seed,
                trial.friction, number, RandomVisits::kMotionsOfVisit, sums.load_steps,
                sums.not_finite, sums.inverted, sums.inverted_at_leave, 1e3 * sums.left, sums.force,
                1e3 * sums.depth, 1e3 * sums.displaced, sums.unconverged, sums.seconds, sums.lost,
                1e3 * sums.depth_followed);
    std::fflush(stdout);
  }
  return 0;
}
