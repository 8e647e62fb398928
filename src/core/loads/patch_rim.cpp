#include "loads/patch_rim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "loads/rim_law.h"

namespace robot_tissue {
namespace {

using GridIndex = std::array<int, 3>;

// The edge of the patch, as seen from one of its nodes or one beside it.
class RimBuilder {
 public:
  RimBuilder(const Lattice& lattice, const TissueModel& model, const LatticeState& state,
             const Box& box, const std::vector<int>& nodes)
      : lattice_(lattice), model_(model), state_(state), box_(box) {
    first_ = last_ = lattice.gridIndex(nodes.front());
    for (const int node : nodes) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        first_[axis] = std::min(first_[axis], lattice.gridIndex(node)[axis]);
        last_[axis] = std::max(last_[axis], lattice.gridIndex(node)[axis]);
      }
    }
    findNormal(nodes);
  }

  std::vector<RimSpring> build() const {
    std::vector<RimSpring> rim;
    if (normal_ < 0) return rim;
    GridIndex from = first_, to = last_;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == normal_) continue;
      --from[at(axis)];
      ++to[at(axis)];
    }
    for (int k = from[2]; k <= to[2]; ++k) {
      for (int j = from[1]; j <= to[1]; ++j) {
        for (int i = from[0]; i <= to[0]; ++i) {
          const int node = lattice_.node(i, j, k);
          if (node < 0 || lattice_.isFixed(node) || !isOnSurface(node, normal_)) continue;
          if (const auto stiffness = stiffnessOf(node)) {
            rim.push_back({node, *stiffness, Vec3::Zero()});
          }
        }
      }
    }
    std::sort(rim.begin(), rim.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
    return rim;
  }

 private:
  // The axis along which the patch is one node thick and lies on the surface; of several the one
  // along which its box is thinnest.
  void findNormal(const std::vector<int>& nodes) {
    for (int axis = 0; axis < 3; ++axis) {
      if (first_[at(axis)] != last_[at(axis)]) continue;
      const bool on_surface = std::all_of(nodes.begin(), nodes.end(),
                                          [&](int node) { return isOnSurface(node, axis); });
      if (!on_surface) continue;
      const Vec3 extent = box_.max() - box_.min();
      if (normal_ < 0 || extent[axis] <= extent[normal_]) normal_ = axis;
    }
  }

  // All cells at the node lie on one side of it, and the material reaches up to the node: where a
  // mesh fills cells in part, the surface runs somewhere between the nodes.
  bool isOnSurface(int node, int axis) const {
    bool below = false, above = false;
    const CellSet& cells = *state_.cells;
    for (const CellSet::Meeting& met : cells.meetings(node)) {
      if (lattice_.cells()[at(cells.all()[at(met.cell)].place)].share() < 1.0) return false;
      ((met.corner >> axis & 1) != 0 ? below : above) = true;
    }
    return below != above;
  }

  // Empty: the node is hard, or free. The compliances of the edges around a corner add.
  std::optional<Vec3> stiffnessOf(int node) const {
    const Moduli moduli = model_.moduliAt(state_, node);
    if (moduli.shear <= 0.0) return std::nullopt;
    const RimLaw law = rimLaw(poissonRatio(moduli));
    Vec3 compliance = Vec3::Zero();
    for (int across = 0; across < 3; ++across) {
      if (across == normal_) continue;
      for (const int side : {-1, 1}) {
        const double depth = depthOf(node, across, side);
        for (int axis = 0; axis < 3; ++axis) {
          const RimMode& mode =
              axis == across ? law.across : (axis == normal_ ? law.normal : law.along);
          compliance[axis] += 1.0 / rimStiffness(mode, depth);
        }
      }
    }
    if (compliance.maxCoeff() == 0.0) return std::nullopt;
    const Vec3 stiffness = compliance.cwiseInverse().cwiseMin(kHardestRim);
    if (stiffness.maxCoeff() == 0.0) return std::nullopt;
    return moduli.shear * lattice_.spacing() * stiffness;
  }

  // Of the node inside the patch's edge on this side, in spacings; infinite where there is no rim,
  // minus infinite beyond a cut.
  double depthOf(int node, int axis, int side) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const double rest = lattice_.restPosition(node)[axis];
    const double depth =
        (side > 0 ? box_.max()[axis] - rest : rest - box_.min()[axis]) / lattice_.spacing();
    const int outwards = 2 * axis + (side > 0 ? 1 : 0), inwards = outwards ^ 1;
    if (depth < 0.0) return isJoined(node, inwards) ? depth : -kNone;
    return isJoined(node, outwards) ? depth : kNone;
  }

  bool isJoined(int node, int direction) const {
    const int spring = lattice_.springOf(node, direction);
    return spring >= 0 && state_.severed[at(spring)] == 0;
  }

  const Lattice& lattice_;
  const TissueModel& model_;
  const LatticeState& state_;
  const Box& box_;
  GridIndex first_{};  // of the patch's nodes
  GridIndex last_{};
  int normal_ = -1;  // -1: the patch is not flat
};

}  // namespace

std::vector<RimSpring> rimOf(const Lattice& lattice, const TissueModel& model,
                             const LatticeState& state, const Box& box,
                             const std::vector<int>& nodes) {
  return RimBuilder(lattice, model, state, box, nodes).build();
}

}  // namespace robot_tissue
