// How walls that are thin against the spacing bend, wherever they stand in the grid: the table of
// doc/accuracy.md. A strip clamped at one end hangs under a small weight; its deflection beyond a
// section is compared with Bernoulli's and Timoshenko's beam from that section on.
//   thin_walls METHOD [PLACES]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "../core/bent_strip.h"

using namespace robot_tissue;
using namespace robot_tissue::bent_strip;

int main(int argc, char** argv) {
  const std::string method = argc > 1 ? argv[1] : "newton";
  const int places = argc > 2 ? std::atoi(argv[2]) : 12;
  std::printf(
      "thickness_h,degrees,rolled,method,least,median,greatest,cycles_median,cycles_most,not_ok\n");
  const std::pair<double, double> turns[] = {{0, 0}, {22, 0}, {45, 0}, {0, 22}, {0, 45}, {45, 35}};
  for (const auto& [degrees, rolled] : turns) {
    for (const double thickness : {0.3, 0.5, 0.7, 1.0, 1.5, 2.5, 4.0}) {
      const Strip strip = {thickness, std::max(24.0, 10.0 * thickness), degrees, rolled};
      Random random;
      std::vector<double> ratios;
      std::vector<int> cycles;
      int not_ok = 0;
      for (int place = 0; place < places; ++place) {
        const Answer answer = bend(strip, method, random.offset(1.0));
        ratios.push_back(answer.ratio);
        cycles.push_back(answer.cycles);
        if (!answer.ok) ++not_ok;
      }
      std::sort(ratios.begin(), ratios.end());
      std::sort(cycles.begin(), cycles.end());
      std::printf("%g,%g,%g,%s,%.3f,%.3f,%.3f,%d,%d,%d\n", thickness, degrees, rolled,
                  method.c_str(), ratios.front(), ratios[ratios.size() / 2], ratios.back(),
                  cycles[cycles.size() / 2], cycles.back(), not_ok);
      std::fflush(stdout);
    }
  }
}
