// How much wider than it is a bonded patch seems to the lattice of model `elastic`, and the springs
// between patch and rim nodes that make up for it. Prints CSV; doc/model.md, "The rim", reads it.
//
// quantity:
//   plate_column         what one column more under the plate adds to the energy: 1, if the strip
//                        is long enough
//   strip_shift          how much wider (spacings) the plate seems, joined rigidly
//   strip_stiffness      diagonal springs that take this away; "coupling": the shift they leave
//                        to two motions at once
//   rim_shift, rim_stiffness   the same of the rim itself, below; a "coupling" spring included
//   stiffness_at_depth, law_at_depth   strip_stiffness for a plate that ends `depth` spacings
//                        beyond the rim column, and what rim_law.h says
//   sliding_shift, sliding_stiffness   of a plate without friction that moves normal to the
//                        surface, as its rim's: that rim mixes nothing
//   law_shift            shift that the springs of rim_law.h leave
// Values of rim_law.h are rim_shift (across, along, normal) and rim_stiffness at the limit.
// cells: of the lower of two strips, the other has twice as many; "limit": extrapolated from the
// last three, with errors of 1/cells and 1/cells^2.
//   rim_strip [sliding]
//
// The rim itself: near it, a motion across and one normal to the surface mix, and the mixture turns
// with the logarithm of the strip's height (stresses there go as r^(-1/2 + i eps), eps =
// log(3 - 4 nu) / 2 pi). So the strip's shifts have no limit. The mixture shows in the gap that a
// motion of the plate leaves at free rim nodes: gap = C^(1/2) Q with a rotation Q, C their
// compliance, and the strip's shift is Q^T M Q. M has a limit. Springs S give it
// M(S) = M - (1 + C^(1/2) S C^(1/2))^(-1), so S = C^(-1/2) (M^(-1) - 1) C^(-1/2) leaves none.
#include "../rim_strip.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace robot_tissue {
namespace {

constexpr int kBonded = 12;  // length of the strip under the plate and beside it, in heights
constexpr int kBeside = 7;
constexpr int kLowest = 8;  // cells
constexpr char kLimit[] = "limit";

using Mix = Eigen::Matrix2d;  // of motions across the rim and normal to the surface

struct Row {
  double across = 0.0;
  double along = 0.0;
  double normal = 0.0;
  double coupling = 0.0;  // of across and normal
};

Row rowOf(const Eigen::Matrix3d& form) { return {form(0, 0), form(1, 1), form(2, 2), form(0, 2)}; }
Row rowOf(const Mix& mix, double along) { return {mix(0, 0), along, mix(1, 1), mix(0, 1)}; }
Mix mixOf(const Eigen::Matrix3d& form) {
  return (Mix() << form(0, 0), form(0, 2), form(2, 0), form(2, 2)).finished();
}

void print(const char* quantity, double ratio, const std::string& cells, double depth,
           const Row& row) {
  std::printf("%s,%g,%s,%g,%.4f,%.4f,%.4f,%.4f\n", quantity, ratio, cells.c_str(), depth,
              row.across, row.along, row.normal, row.coupling);
  std::fflush(stdout);
}

double limitOf(double coarse, double middle, double fine) {
  return (8.0 * fine - 6.0 * middle + coarse) / 3.0;
}
Row limitOf(const std::vector<Row>& rows) {
  const Row &a = rows[rows.size() - 3], &b = rows[rows.size() - 2], &c = rows.back();
  return {limitOf(a.across, b.across, c.across), limitOf(a.along, b.along, c.along),
          limitOf(a.normal, b.normal, c.normal), limitOf(a.coupling, b.coupling, c.coupling)};
}

class Strips {
 public:
  Strips(double poisson_ratio, int highest, Strip::Plate plate) : ratio_(poisson_ratio) {
    for (int cells = kLowest; cells <= highest; cells *= 2) {
      cells_.push_back(cells);
      strips_.emplace_back(cells, poisson_ratio, kBonded, kBeside, plate);
    }
  }

  // measure(coarse, fine) of each pair of strips.
  template <typename Measure>
  std::vector<Row> measured(const Measure& measure) const {
    std::vector<Row> rows;
    for (std::size_t i = 0; i + 1 < strips_.size(); ++i) {
      rows.push_back(measure(strips_[i], strips_[i + 1]));
    }
    return rows;
  }
  template <typename Measure>
  std::vector<Row> report(const char* quantity, const Measure& measure) const {
    const std::vector<Row> rows = measured(measure);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      print(quantity, ratio_, std::to_string(cells_[i]), 0.0, rows[i]);
    }
    return rows;
  }
  template <typename Measure>
  void reportLimit(const char* quantity, const Measure& measure) const {
    print(quantity, ratio_, kLimit, 0.0, limitOf(report(quantity, measure)));
  }
  void reportShifts() const;
  void reportScan() const;
  void reportSliding() const;

 private:
  double ratio_;
  std::vector<int> cells_;
  std::vector<Strip> strips_;
};

// Diagonal springs to the rim column for which the plate seems to end where it does: Newton's
// method with slopes by differences, on logarithms, so that they stay positive.
RimSprings springsWithoutShift(const Strip& coarse, const Strip& fine, const RimLaw& start,
                               double depth) {
  constexpr double kStep = 1e-5;
  RimSprings springs = springsAt(start, depth);
  const auto excess = [&](const RimSprings& joined) {
    return Vec3(seemingDepth(coarse, fine, joined).diagonal().array() - depth);
  };
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Vec3 left = excess(springs);
    Eigen::Matrix3d slope;
    for (int axis = 0; axis < 3; ++axis) {
      RimSprings stiffer = springs;
      stiffer[axis] *= std::exp(kStep);
      slope.col(axis) = (excess(stiffer) - left) / kStep;
    }
    const Vec3 step = slope.partialPivLu().solve(left).cwiseMax(-0.5).cwiseMin(0.5);
    springs.head<3>().array() *= (-step).array().exp();
  }
  return springs;
}

Mix rootOf(const Mix& mix) { return Eigen::SelfAdjointEigenSolver<Mix>(mix).operatorSqrt(); }

// Q of the head comment.
Mix turnOf(const Strip& strip) {
  const Mix gap = rootOf(mixOf(strip.compliance())).inverse() * mixOf(strip.gap());
  const Eigen::JacobiSVD<Mix> parts(gap, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return parts.matrixU() * parts.matrixV().transpose();
}

// M of the head comment: 2 Qc^T M Qc - Qf^T M Qf is what the two strips show.
Mix rimShift(const Strip& coarse, const Strip& fine) {
  const Mix turn_coarse = turnOf(coarse), turn_fine = turnOf(fine);
  const auto asVector = [](const Mix& mix) { return Vec3(mix(0, 0), mix(1, 1), mix(0, 1)); };
  Eigen::Matrix3d shown;
  for (int i = 0; i < 3; ++i) {
    Mix one = Mix::Zero();
    one(i == 1, i != 0) = one(i != 0, i == 1) = 1.0;
    shown.col(i) = asVector(2.0 * turn_coarse.transpose() * one * turn_coarse -
                            turn_fine.transpose() * one * turn_fine);
  }
  const Vec3 measured = asVector(mixOf(seemingDepth(coarse, fine, rigidRim())));
  const Vec3 m = shown.partialPivLu().solve(measured);
  return (Mix() << m[0], m[2], m[2], m[1]).finished();
}

void Strips::reportShifts() const {
  report("plate_column", [](const Strip& coarse, const Strip&) {
    return rowOf(Eigen::Matrix3d(coarse.excess(rigidRim()) - coarse.excess(RimSprings::Zero())));
  });
  report("strip_shift", [](const Strip& coarse, const Strip& fine) {
    return rowOf(seemingDepth(coarse, fine, rigidRim()));
  });
  reportLimit("rim_shift", [](const Strip& coarse, const Strip& fine) {
    return rowOf(rimShift(coarse, fine), seemingDepth(coarse, fine, rigidRim())(1, 1));
  });
  reportLimit("rim_stiffness", [](const Strip& coarse, const Strip& fine) {
    const Mix inverse_root = rootOf(mixOf(fine.compliance())).inverse();
    const Mix inner = rimShift(coarse, fine).inverse() - Mix::Identity();
    const double along = seemingDepth(coarse, fine, rigidRim())(1, 1);
    return rowOf(Mix(inverse_root * inner * inverse_root),
                 (1.0 / along - 1.0) / fine.compliance()(1, 1));
  });
  reportLimit("strip_stiffness", [&](const Strip& coarse, const Strip& fine) {
    const RimSprings springs = springsWithoutShift(coarse, fine, rimLaw(ratio_), 0.0);
    return Row{springs[0], springs[1], springs[2], seemingDepth(coarse, fine, springs)(0, 2)};
  });
}

void Strips::reportScan() const {
  const RimLaw law = rimLaw(ratio_);
  for (int tenths = -7; tenths <= 2; ++tenths) {
    const double depth = 0.1 * tenths;
    if (depth < law.normal.shift) {
      const auto best = measured([&](const Strip& coarse, const Strip& fine) {
        const RimSprings springs = springsWithoutShift(coarse, fine, law, depth);
        return Row{springs[0], springs[1], springs[2], seemingDepth(coarse, fine, springs)(0, 2)};
      });
      print("stiffness_at_depth", ratio_, kLimit, depth, limitOf(best));
    }
    const RimSprings springs = springsAt(law, depth);
    print("law_at_depth", ratio_, kLimit, depth, {springs[0], springs[1], springs[2], 0.0});
    const auto left = measured([&](const Strip& coarse, const Strip& fine) {
      return rowOf(Eigen::Matrix3d(seemingDepth(coarse, fine, springs) -
                                   depth * Eigen::Matrix3d::Identity()));
    });
    print("law_shift", ratio_, std::to_string(cells_[1]), depth, left[1]);
    print("law_shift", ratio_, kLimit, depth, limitOf(left));
  }
}

void Strips::reportSliding() const {
  const auto shift = [](const Strip& coarse, const Strip& fine) {
    RimSprings rigid = RimSprings::Zero();
    rigid[2] = std::numeric_limits<double>::infinity();
    return seemingDepth(coarse, fine, rigid)(2, 2);
  };
  reportLimit("sliding_shift", [&](const Strip& coarse, const Strip& fine) {
    return Row{0.0, 0.0, shift(coarse, fine), 0.0};
  });
  reportLimit("sliding_stiffness", [&](const Strip& coarse, const Strip& fine) {
    const double left = 1.0 / shift(coarse, fine) - 1.0;
    return Row{0.0, 0.0, left / fine.compliance()(2, 2), 0.0};
  });
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  const bool sliding_alone = argc > 1 && std::string(argv[1]) == "sliding";
  std::printf("quantity,poisson_ratio,cells,depth,across,along,normal,coupling\n");
  for (const double ratio : {0.25, 0.30, 0.35, 0.40, 0.45, 0.47, 0.49}) {
    Strips(ratio, 64, Strip::Plate::kSliding).reportSliding();
    if (sliding_alone) continue;
    const Strips strips(ratio, ratio < 0.42 ? 128 : 256, Strip::Plate::kBonded);
    strips.reportShifts();
    strips.reportScan();
  }
  return 0;
}
