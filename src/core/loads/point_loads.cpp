#include "loads/point_loads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "loads/ratio_table.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kPlaces = 6;
constexpr std::array<double, kPlaces> kSquared = {0.0, 1.0, 2.0, 4.0, 5.0, 9.0};  // spacings^2

struct PointLoads {
  double poisson_ratio;
  std::array<double, kPlaces> compliance;  // at kSquared
};

// doc/data/point_loads.csv. More at 0: light touches of balls are the softer between nodes.
constexpr PointLoads kPointLoads[] = {
    {0.25, {0.7582, 0.0311, 0.1010, 0.0718, 0.0512, 0.0352}},
    {0.35, {0.7117, 0.0097, 0.0876, 0.0679, 0.0450, 0.0284}},
    {0.45, {0.6567, -0.0111, 0.0748, 0.0658, 0.0388, 0.0203}},
    {0.49, {0.6300, -0.0182, 0.0698, 0.0655, 0.0363, 0.0164}},
};

}  // namespace

double pointCompliance(double poisson_ratio, double squared) {
  const double nearest = std::round(squared);
  const auto place = std::find(kSquared.begin(), kSquared.end(), nearest);
  if (place == kSquared.end()) return (1.0 - poisson_ratio) / (2.0 * M_PI * std::sqrt(squared));
  const auto [below, above, share] = placeIn(kPointLoads, poisson_ratio);
  const auto number = static_cast<std::size_t>(place - kSquared.begin());
  return (1.0 - share) * below.compliance[number] + share * above.compliance[number];
}

}  // namespace robot_tissue
