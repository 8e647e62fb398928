#include "config/material.h"

namespace robot_tissue {
namespace {

constexpr double kBoxSlack = 1e-3;  // of the spacing

bool contains(const Box& box, const Vec3& point, double slack) {
  return ((point - box.min()).array() >= -slack).all() &&
         ((box.max() - point).array() >= -slack).all();
}

}  // namespace

const Material& materialAt(const TissueConfig& config, const Vec3& point) {
  for (auto region = config.regions.rbegin(); region != config.regions.rend(); ++region) {
    if (contains(region->box, point, kBoxSlack * config.spacing)) return region->material;
  }
  return config.material;
}

Moduli moduliOf(const Material& material) {
  const bool stiffens = material.law == Material::Law::kFung;
  return {shearModulus(material), bulkModulus(material), stiffens ? material.stiffening : 0.0};
}

double poissonRatio(const Moduli& moduli) {
  return (3.0 * moduli.bulk - 2.0 * moduli.shear) / (2.0 * (3.0 * moduli.bulk + moduli.shear));
}

double shearModulus(const Material& material) {
  return material.young_modulus / (2.0 * (1.0 + material.poisson_ratio));
}

double bulkModulus(const Material& material) {
  return material.young_modulus / (3.0 * (1.0 - 2.0 * material.poisson_ratio));
}

}  // namespace robot_tissue
