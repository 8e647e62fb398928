// Prints model `elastic` against formulas, as CSV; doc/accuracy.md shows it.
#include "analytic_checks.h"

#include <cstdio>

namespace {

constexpr double kPi = 3.14159265358979323846;

void print(const char* check, double poisson_ratio, double value, const char* unit) {
  std::printf("%s,%g,%.4g,%s\n", check, poisson_ratio, value, unit);
  std::fflush(stdout);
}

}  // namespace

int main() {
  using namespace robot_tissue;
  std::printf("check,poisson_ratio,value,unit\n");
  for (const double ratio : {0.25, 0.45, 0.49}) {
    for (int axis = 0; axis < 3; ++axis) {
      const PulledBar bar = pulledBar(axis, ratio);
      const std::string along(1, "xyz"[axis]);
      print(("free bar along " + along + ": E").c_str(), ratio, 100.0 * bar.young_modulus_error,
            "% off");
      print(("free bar along " + along + ": Poisson's ratio").c_str(), ratio,
            100.0 * bar.poisson_ratio_error, "% off");
    }
    for (const Vec3& direction : {Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(1, 2, 3)}) {
      const PulledBar bar = uniaxialStress(direction, ratio);
      char along[64];
      std::snprintf(along, sizeof along, "along (%g %g %g): E", direction.x(), direction.y(),
                    direction.z());
      print(along, ratio, 100.0 * bar.young_modulus_error, "% off");
      std::snprintf(along, sizeof along, "along (%g %g %g): Poisson's ratio", direction.x(),
                    direction.y(), direction.z());
      print(along, ratio, 100.0 * bar.poisson_ratio_error, "% off");
    }
    print("turn by pi: greatest force", ratio, forceAfterTurn(kPi, ratio), "mu h^2");
    print("patch test: greatest difference", ratio, patchTestError(ratio), "of the greatest u");
    for (const int cells : {2, 4, 8}) {
      const HangingBar bar = hangingBar(cells, ratio);
      print(("hanging bar, " + std::to_string(cells) + " cells thick: tip").c_str(), ratio,
            bar.deflection, "of the length");
      print(("hanging bar, " + std::to_string(cells) + " cells thick: against elastica").c_str(),
            ratio, 100.0 * (bar.deflection / bar.elastica - 1.0), "% off");
    }
    for (const double spacing : {0.01, 0.005}) {
      for (const bool by_punch : {false, true}) {
        const std::string name = std::string("volume ratio, a fifth pressed by ") +
                                 (by_punch ? "a punch" : "the face") + ", spacing " +
                                 (spacing == 0.01 ? "10 mm" : "5 mm");
        print(name.c_str(), ratio, volumeRatioUnderPress(by_punch, spacing, ratio), "");
      }
    }
  }
  return 0;
}
