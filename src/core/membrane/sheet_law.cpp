#include "membrane/sheet_law.h"

#include <cmath>

namespace robot_tissue {

SheetLaw sheetLaw(const MembraneConfig& membrane) {
  const double nu = membrane.poisson_ratio;
  SheetLaw law;
  law.shear = membrane.young_modulus * membrane.thickness / (2.0 * (1.0 + nu));
  law.exponent = nu / (1.0 - nu);
  law.bending = membrane.young_modulus * std::pow(membrane.thickness, 3) / (12.0 * (1.0 - nu * nu));
  return law;
}

}  // namespace robot_tissue
