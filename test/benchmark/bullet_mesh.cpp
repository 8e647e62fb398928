#include <algorithm>

#include "bullet_body.h"

namespace robot_tissue {

const std::vector<std::string>& bulletMethods() {
  static const std::vector<std::string> names = {"bullet_deformable", "bullet_soft"};
  return names;
}

BulletSettings bestSettings(const std::string& method, const Lattice& lattice) {
  // The slowest wave goes through the block's shortest side.
  const int cells = *std::min_element(lattice.size().begin(), lattice.size().end()) - 1;
  BulletSettings settings;
  if (method == "bullet_soft") {
    settings.time_step = 1.0 / 60.0;  // without gravity it has no effect
    settings.iterations = 1;
    settings.damping = 1.0 / cells;
    settings.stiffness = 0.1;
  } else if (method == "bullet_deformable") {
    settings.time_step = 10.0;  // so long that a step is one of Newton's towards the equilibrium
    settings.iterations = 2 * cells;
    settings.ramp = std::max(1, cells / 5);
  } else {
    throw InputError("--method: is '" + method + "', must be bullet_deformable or bullet_soft");
  }
  return settings;
}

std::vector<std::array<int, 4>> tetrahedraOf(const Lattice& lattice) {
  constexpr int kFive[5][4] = {
      {0, 1, 2, 4}, {3, 2, 1, 7}, {5, 1, 4, 7}, {6, 4, 2, 7}, {1, 2, 4, 7}};
  std::vector<std::array<int, 4>> tetrahedra;
  for (const Cell& cell : lattice.cells()) {
    const auto index = lattice.gridIndex(cell.nodes[0]);
    const int mirror = (index[0] + index[1] + index[2]) % 2;  // of corner c: c ^ 1
    for (const auto& corners : kFive) {
      std::array<int, 4> nodes{};
      for (std::size_t i = 0; i < 4; ++i) nodes[i] = cell.nodes[at(corners[i] ^ mirror)];
      const Vec3 origin = lattice.restPosition(nodes[0]);
      const Vec3 a = lattice.restPosition(nodes[1]) - origin;
      const Vec3 b = lattice.restPosition(nodes[2]) - origin;
      const Vec3 c = lattice.restPosition(nodes[3]) - origin;
      if (a.cross(b).dot(c) < 0.0) std::swap(nodes[2], nodes[3]);
      tetrahedra.push_back(nodes);
    }
  }
  return tetrahedra;
}

}  // namespace robot_tissue
