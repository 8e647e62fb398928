// Bullet's elastic material with the moduli of a tissue's.
#pragma once

#include <BulletSoftBody/btDeformableNeoHookeanForce.h>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// Bullet's energy is that of Smith, de Goes and Kim 2018 (equation 14); its two moduli are not
// Lame's: theirs follow from those as in section 3.4 of the paper, so that small strains are right.
inline void setModuli(const Material& material, btDeformableNeoHookeanForce& elasticity) {
  const double nu = material.poisson_ratio;
  const double mu = material.young_modulus / (2.0 * (1.0 + nu));
  const double lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
  elasticity.setLameParameters(static_cast<btScalar>(4.0 / 3.0 * mu),
                               static_cast<btScalar>(lambda + 5.0 / 6.0 * mu));
  elasticity.setDamping(0);
}

}  // namespace robot_tissue
