#include "config/material.h"

namespace robot_tissue {
namespace {

constexpr double kBoxSlack = 1e-3;  // of the spacing

}  // namespace

bool contains(const Region& region, const Vec3& point, double spacing) {
  const double slack = kBoxSlack * spacing;
  return ((point - region.box.min()).array() >= -slack).all() &&
         ((region.box.max() - point).array() >= -slack).all();
}

Moduli moduliOf(const Material& material) {
  const bool stiffens = material.law == Material::Law::kFung;
  return {shearModulus(material), bulkModulus(material), stiffens ? material.stiffening : 0.0};
}

double poissonRatio(const Moduli& moduli) {
  return (3.0 * moduli.bulk - 2.0 * moduli.shear) / (2.0 * (3.0 * moduli.bulk + moduli.shear));
}

// K = 1 / (sum of s / (K_i + k)) - k, and G likewise with g, where k = 4/3 G_0 and
// g = G_0 / 6 (9 K_0 + 8 G_0) / (K_0 + 2 G_0) are of the first one.
Moduli mixed(const std::vector<std::pair<Moduli, double>>& parts) {
  const Moduli& around = parts.front().first;
  if (parts.size() == 1) return around;
  const double k = 4.0 / 3.0 * around.shear;
  const double g = around.shear / 6.0 * (9.0 * around.bulk + 8.0 * around.shear) /
                   (around.bulk + 2.0 * around.shear);
  double shear_compliance = 0.0, bulk_compliance = 0.0, shear = 0.0, stiffening = 0.0;
  for (const auto& [moduli, share] : parts) {
    shear_compliance += share / (moduli.shear + g);
    bulk_compliance += share / (moduli.bulk + k);
    shear += share * moduli.shear;
    stiffening += share * moduli.shear * moduli.stiffening;
  }
  return {1.0 / shear_compliance - g, 1.0 / bulk_compliance - k, stiffening / shear};
}

double shearModulus(const Material& material) {
  return material.young_modulus / (2.0 * (1.0 + material.poisson_ratio));
}

double bulkModulus(const Material& material) {
  return material.young_modulus / (3.0 * (1.0 - 2.0 * material.poisson_ratio));
}

}  // namespace robot_tissue
