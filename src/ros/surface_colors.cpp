#include "robot_tissue/ros/surface_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "robot_tissue/core/surface_strain.h"
#include "robot_tissue/pipeline/touch_pressure.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

constexpr std::array<ColorMeaning, 4> kMeanings = {{{"none", "", ""},
                                                    {"displacement", "displacement", "mm"},
                                                    {"strain", "stretch of the surface", "%"},
                                                    {"pressure", "pressure of tools", "kPa"}}};
constexpr double kPercent = 100.0;
constexpr double kMillimeters = 1e3;   // in a meter
constexpr double kKilopascals = 1e-3;  // in a pascal

// ColorBrewer's YlOrRd (Brewer 2003): light to dark, told apart by the color-blind, too.
constexpr std::array<std::array<double, 3>, 5> kRamp = {{{1.00, 1.00, 0.80},
                                                         {1.00, 0.85, 0.46},
                                                         {0.99, 0.55, 0.24},
                                                         {0.89, 0.10, 0.11},
                                                         {0.50, 0.00, 0.15}}};
// Towards the light, unit: from above and before.
const Vec3 kLight(0.36, -0.48, 0.80);

// Where nodes have them (m): what is drawn at tools' edges is aside of that.
std::vector<Vec3> verticesOfNodes(const Tissue& tissue) {
  std::vector<Vec3> vertices;
  deform(tissue.surface(), tissue.shownDisplacement(), vertices);
  return vertices;
}

std::vector<double> displacements(const Tissue& tissue) {
  const std::vector<Vec3> vertices = verticesOfNodes(tissue);
  std::vector<double> values;
  values.reserve(vertices.size());
  for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
    const Vec3 way = vertices[vertex] - tissue.surface().rest[vertex];
    values.push_back(kMillimeters * way.norm());
  }
  return values;
}

std::vector<double> inUnit(double units, std::vector<double> values) {
  for (double& value : values) value *= units;
  return values;
}

}  // namespace

const ColorMeaning& meaningOf(ColorBy color) { return kMeanings[static_cast<std::size_t>(color)]; }

std::optional<ColorBy> colorByName(const std::string& name) {
  for (std::size_t i = 0; i < kMeanings.size(); ++i) {
    if (name == kMeanings[i].name) return static_cast<ColorBy>(i);
  }
  return {};
}

std::vector<std::string> colorNames() {
  std::vector<std::string> names;
  names.reserve(kMeanings.size());
  for (const ColorMeaning& each : kMeanings) names.emplace_back(each.name);
  return names;
}

std::vector<double> surfaceValues(ColorBy color, const Pipeline& pipeline) {
  switch (color) {
    case ColorBy::kDisplacement:
      return displacements(pipeline.tissue());
    case ColorBy::kStrain:
      return inUnit(kPercent, surfaceStrains(pipeline.tissue().surface(),
                                             verticesOfNodes(pipeline.tissue())));
    case ColorBy::kPressure:
      return inUnit(kKilopascals, touchPressures(pipeline));
    case ColorBy::kNone:
      break;
  }
  return {};
}

double scaleFor(const std::vector<double>& values, double present) {
  const double most = values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
  if (most <= present && most > tuning::kScaleInUse * present) return present;
  if (!(most > tuning::kLeastScale)) return tuning::kLeastScale;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (most <= step * power) return step * power;
  }
  return 10.0 * power;
}

std_msgs::ColorRGBA colorOf(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(kRamp.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
  const double rest = place - static_cast<double>(low);
  const auto channel = [&](std::size_t k) {
    return static_cast<float>((1.0 - rest) * kRamp[low][k] + rest * kRamp[low + 1][k]);
  };
  std_msgs::ColorRGBA color;
  color.r = channel(0);
  color.g = channel(1);
  color.b = channel(2);
  color.a = 1.0F;
  return color;
}

std_msgs::ColorRGBA litColorOf(double share, const Vec3& normal) {
  const double facing = 0.5 * (1.0 + normal.dot(kLight));
  const auto light = static_cast<float>(tuning::kDarkest + (1.0 - tuning::kDarkest) * facing);
  std_msgs::ColorRGBA color = colorOf(share);
  color.r *= light;
  color.g *= light;
  color.b *= light;
  return color;
}

}  // namespace robot_tissue
