#include "material_presets.h"

#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

// All are taken as nearly incompressible. With shear modulus mu, E = 2 (1 + nu) mu.
constexpr double kPoissonRatio = 0.49;

// stiffening 0: law neo_hookean.
Material materialOf(double shear_modulus, double density, double stiffening) {
  Material material;
  material.young_modulus = 2.0 * (1.0 + kPoissonRatio) * shear_modulus;
  material.poisson_ratio = kPoissonRatio;
  material.density = density;
  material.law = stiffening > 0.0 ? Material::Law::kFung : Material::Law::kNeoHookean;
  material.stiffening = stiffening;
  return material;
}

// How exponents were found from what is published, and how sure they are: doc/scene.md.
std::vector<MaterialPreset> table() {
  return {
      {"liver", materialOf(2200.0, 1079.0, 0.0),
       "shear modulus 2.2 +- 0.3 kPa, human in vivo, waves of 60 Hz, strain below 0.1 % (Yin et "
       "al. 2007); stiffening of a known size not found for this law: do not trust it beyond some "
       "10 % of strain"},
      {"kidney", materialOf(4900.0, 1066.0, 0.0),
       "shear modulus 4.9 +- 0.5 kPa, human in vivo, waves of 45 Hz, strain below 0.1 % (Rouviere "
       "et al. 2011; 9.4 kPa at 76 Hz); stiffening of a known size not found for this law: do not "
       "trust it beyond some 10 % of strain"},
      {"muscle", materialOf(1000.0, 1090.0, 1.0),
       "passive, gluteal: shear modulus 1.0 kPa, human in vivo, waves of 50 Hz, and its growth "
       "with compression to some 30 % (J. Mech. Behav. Biomed. Mater. 2023, strain-dependent shear "
       "properties of adipose tissue in vivo); fibers are not modeled"},
      {"fat", materialOf(752.0, 911.0, 3.0),
       "gluteal: shear modulus 0.75 kPa, human in vivo, waves of 50 Hz, and its growth with "
       "compression to some 30 % (J. Mech. Behav. Biomed. Mater. 2023, as muscle); porcine 0.53 +- "
       "0.31 kPa (Sims et al. 2010)"},
      {"brain", materialOf(670.0, 1046.0, 15.0),
       "shear modulus 0.67 kPa and stiffening from Ogden's exponent -19, human in vivo, shift "
       "under gravity (Bennion et al. 2022); porcine 0.9 +- 0.3 kPa in torsion (Balbi et al. "
       "2019); shear and stretch together do not follow this law well (Mihai et al. 2015)"},
      {"silicone", materialOf(39400.0, 1070.0, 0.0),
       "Ecoflex 00-30: 69 kPa at 100 % of strain (data sheet of Smooth-On), as a neo-Hookean bar "
       "in tension; it stiffens beyond some 200 %"},
  };
}

}  // namespace

const std::vector<MaterialPreset>& materialPresets() {
  static const std::vector<MaterialPreset> all = table();
  return all;
}

std::string describe(const MaterialPreset& preset) {
  const Material& material = preset.material;
  const bool stiffens = material.law == Material::Law::kFung;
  return "young_modulus " + numberText(material.young_modulus) + " Pa, poisson_ratio " +
         numberText(material.poisson_ratio) + ", density " + numberText(material.density) +
         " kg/m^3, law " +
         (stiffens ? "fung, stiffening " + numberText(material.stiffening) : "neo_hookean") + ". " +
         preset.source;
}

}  // namespace robot_tissue
