// How far nodes of a flat surface go under a force on one of them, normal to it, on the lattice of
// model `elastic` and on a half-space (Boussinesq 1885): the table of core/loads/point_loads.cpp.
// Prints CSV: poisson_ratio,i,j (spacings from the force), compliance, half_space (way over force,
// times shear modulus and spacing; empty under the force).
//   point_loads [CELLS from side to side; half as many deep]
// What the block's ground takes is the mean by which nodes five to seven spacings off go less than
// those of a half-space; it is taken away from all.
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "contact_trial.h"
#include "robot_tissue/core/tissue.h"

namespace robot_tissue {
namespace {

constexpr double kSpacing = 0.005;  // m
constexpr double kWay = 1e-5;       // m: small strain
constexpr double kTolerance = 1e-5;

using Offset = std::array<int, 2>;

class PointLoad {
 public:
  PointLoad(double poisson_ratio, int cells)
      : poisson_ratio_(poisson_ratio),
        middle_(cells / 2),
        tissue_(blockWith(poisson_ratio, cells), solverOf("layered", kTolerance)) {
    PatchConfig patch;
    patch.name = "point";
    const Vec3 place = kSpacing * Vec3(middle_, middle_, middle_), reach = Vec3::Constant(1e-4);
    patch.box = {place - reach, place + reach};
    patch.displacement = {0.0, 0.0, -kWay};
    LoadStep step;
    step.increments = 1;
    step.patches.push_back(patch);
    tissue_.load(step);
    const double force = std::abs(tissue_.lastReport().patches.front().force.z());
    unit_ = kYoung / (2.0 * (1.0 + poisson_ratio)) * kSpacing / force;
    const std::vector<Offset> far = {{5, 0}, {6, 0}, {5, 3}, {4, 4}, {7, 0}};
    double ground = 0.0;
    for (const Offset& offset : far) ground += compliance(offset) - ofHalfSpace(offset);
    ground_ = ground / static_cast<double>(far.size());
  }

  double compliance(const Offset& offset) const {
    const int node = tissue_.lattice().node(middle_ + offset[0], middle_ + offset[1], middle_);
    return -tissue_.state().displacement[at(node)].z() * unit_ - ground_;
  }

  double ofHalfSpace(const Offset& offset) const {
    return (1.0 - poisson_ratio_) / (2.0 * M_PI * std::hypot(offset[0], offset[1]));
  }

 private:
  static TissueConfig blockWith(double poisson_ratio, int cells) {
    TissueConfig block = blockOf(kSpacing * Vec3(cells, cells, cells / 2), kSpacing);
    block.material.young_modulus = kYoung;
    block.material.poisson_ratio = poisson_ratio;
    return block;
  }

  double poisson_ratio_;
  int middle_;
  Tissue tissue_;
  double unit_ = 0.0, ground_ = 0.0;
};

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  const int cells = static_cast<int>(argument(argc, argv, 1, 40));
  std::printf("poisson_ratio,i,j,compliance,half_space\n");
  for (const double poisson_ratio : {0.25, 0.35, 0.45, 0.49}) {
    const PointLoad load(poisson_ratio, cells);
    std::printf("%.2f,0,0,%.4f,\n", poisson_ratio, load.compliance({0, 0}));
    for (const Offset& offset :
         std::vector<Offset>{{1, 0}, {1, 1}, {2, 0}, {2, 1}, {3, 0}, {4, 0}, {5, 0}}) {
      std::printf("%.2f,%d,%d,%.4f,%.4f\n", poisson_ratio, offset[0], offset[1],
                  load.compliance(offset), load.ofHalfSpace(offset));
    }
  }
  return 0;
}
