#include "richardson.h"

#include <algorithm>
#include <cmath>

#include "tuning.h"

namespace robot_tissue {
namespace {

// (h1^p - h2^p) / (h2^p - h3^p), which grows with p.
double ratioAt(double order, double h1, double h2, double h3) {
  if (std::abs(order) < 1e-9) return std::log(h1 / h2) / std::log(h2 / h3);
  return (std::pow(h1, order) - std::pow(h2, order)) / (std::pow(h2, order) - std::pow(h3, order));
}

double observedOrder(const std::vector<Sample>& samples) {
  const double coarse = (samples[0].value - samples[1].value).norm();
  const double fine = (samples[1].value - samples[2].value).norm();
  if (!(fine > 0.0)) return tuning::kHighestSought;
  double low = tuning::kLowestSought, high = tuning::kHighestSought;
  while (high - low > 1e-6) {
    const double middle = 0.5 * (low + high);
    const double ratio =
        ratioAt(middle, samples[0].spacing, samples[1].spacing, samples[2].spacing);
    (ratio < coarse / fine ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Limit limitOf(const std::vector<Sample>& samples) {
  Limit limit;
  if (samples.size() > 2) {
    limit.observed = observedOrder(samples);
    limit.order = std::clamp(limit.observed, kLowestOrder, kHighestOrder);
  }
  const Sample& finer = samples.back();
  const Sample& coarser = samples[samples.size() - 2];
  const double gain = std::pow(coarser.spacing / finer.spacing, limit.order) - 1.0;
  limit.value = finer.value + (finer.value - coarser.value) / gain;
  return limit;
}

}  // namespace robot_tissue
