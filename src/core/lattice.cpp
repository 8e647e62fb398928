#include "robot_tissue/core/lattice.h"

#include <cmath>
#include <sstream>

namespace robot_tissue {
namespace {

constexpr double kBoxSlack = 1e-3;  // of the spacing
const char* const kAxisNames[] = {"x", "y", "z"};

std::array<int, 3> gridSize(const Box& shape, double spacing) {
  std::array<int, 3> size{};
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = (shape.max[axis] - shape.min[axis]) / spacing;
    const double whole = std::round(cells);
    // Written so that a spacing of 0 or NaN does not pass.
    if (!(whole >= 1.0) || !(std::abs(cells - whole) <= kBoxSlack)) {
      std::ostringstream line;
      line << "tissue.spacing: " << spacing << ": the shape is "
           << shape.max[axis] - shape.min[axis] << " m along " << kAxisNames[axis]
           << "; allowed: a whole number of spacings, at least 1";
      throw InputError(line.str());
    }
    size[static_cast<std::size_t>(axis)] = static_cast<int>(whole) + 1;
  }
  return size;
}

bool contains(const Box& box, const Vec3& point, double slack) {
  return ((point - box.min).array() >= -slack).all() && ((box.max - point).array() >= -slack).all();
}

const Material& materialAt(const TissueConfig& config, const Vec3& point) {
  for (auto region = config.regions.rbegin(); region != config.regions.rend(); ++region) {
    if (contains(region->box, point, kBoxSlack * config.spacing)) return region->material;
  }
  return config.material;
}

// What the four cells round a spring give it: moduli add up, E h / 4 a cell, so that a bar of any
// cross section has the stiffness E A / L; a spring constant is the paper's, the same on a face.
class SpringStiffness {
 public:
  void add(const Material& material, double spacing) {
    if (material.spring_stiffness) {
      sum_ += *material.spring_stiffness;
      ++constants_;
    } else {
      sum_ += material.young_modulus * spacing / 4.0;
    }
  }
  double value() const { return constants_ > 0 ? sum_ / constants_ : sum_; }

 private:
  double sum_ = 0.0;
  int constants_ = 0;
};

}  // namespace

const char* toString(SolveStatus status) {
  switch (status) {
    case SolveStatus::kOk:
      return "OK";
    case SolveStatus::kLate:
      return "LATE";
    case SolveStatus::kUnconverged:
      return "UNCONVERGED";
    case SolveStatus::kInverted:
      return "INVERTED";
  }
  return "UNCONVERGED";
}

Lattice::Lattice(const TissueConfig& config)
    : size_(gridSize(config.shape, config.spacing)),
      origin_(config.shape.min),
      spacing_(config.spacing) {
  const auto count = static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                     static_cast<std::size_t>(size_[2]);
  fixed_.assign(count, 0);
  mass_.assign(count, 0.0);
  buildSprings(config);
  for (std::size_t box = 0; box < config.fixed.size(); ++box) {
    const std::vector<int> nodes = nodesIn(config.fixed[box]);
    if (nodes.empty()) {
      throw InputError("tissue.fixed[" + std::to_string(box) +
                       "]: no node in this box; allowed: a box that holds one node or more");
    }
    for (const int node : nodes) fixed_[static_cast<std::size_t>(node)] = 1;
  }
}

void Lattice::buildSprings(const TissueConfig& config) {
  std::array<int, kNeighbors> none{};
  none.fill(-1);
  springs_of_node_.assign(fixed_.size(), none);
  std::vector<SpringStiffness> stiffness;
  for (int node = 0; node < nodeCount(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      auto index = gridIndex(node);
      if (++index[static_cast<std::size_t>(axis)] == size_[static_cast<std::size_t>(axis)])
        continue;
      const int upper = this->node(index[0], index[1], index[2]);
      const int spring = static_cast<int>(springs_.size());
      springs_.push_back({node, upper, axis, 0.0});
      springs_of_node_[static_cast<std::size_t>(node)][static_cast<std::size_t>(2 * axis + 1)] =
          spring;
      springs_of_node_[static_cast<std::size_t>(upper)][static_cast<std::size_t>(2 * axis)] =
          spring;
    }
  }
  stiffness.resize(springs_.size());
  const double corner_volume = std::pow(spacing_, 3) / 8.0;
  for (int k = 0; k + 1 < size_[2]; ++k) {
    for (int j = 0; j + 1 < size_[1]; ++j) {
      for (int i = 0; i + 1 < size_[0]; ++i) {
        const Material& material =
            materialAt(config, restPosition(node(i, j, k)) + Vec3::Constant(0.5 * spacing_));
        for (int corner = 0; corner < 8; ++corner) {
          const int at = node(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1));
          mass_[static_cast<std::size_t>(at)] += material.density * corner_volume;
          for (int axis = 0; axis < 3; ++axis) {
            if (corner >> axis & 1) continue;
            const int spring = springOf(at, 2 * axis + 1);
            stiffness[static_cast<std::size_t>(spring)].add(material, spacing_);
          }
        }
      }
    }
  }
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    springs_[spring].stiffness = stiffness[spring].value();
  }
}

std::array<int, 3> Lattice::gridIndex(int node) const {
  const int row = node / size_[0];
  return {node % size_[0], row % size_[1], row / size_[1]};
}

Vec3 Lattice::restPosition(int node) const {
  const auto index = gridIndex(node);
  return origin_ + spacing_ * Vec3(index[0], index[1], index[2]);
}

int Lattice::neighbor(int node, int direction) const {
  const int spring = springOf(node, direction);
  if (spring < 0) return -1;
  const Spring& joined = springs_[static_cast<std::size_t>(spring)];
  return direction % 2 == 1 ? joined.b : joined.a;
}

std::vector<int> Lattice::nodesIn(const Box& box) const {
  std::array<int, 3> first{}, last{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double low = (box.min[a] - origin_[a]) / spacing_ - kBoxSlack;
    const double high = (box.max[a] - origin_[a]) / spacing_ + kBoxSlack;
    const double top = size_[axis] - 1;
    if (!(low <= top) || !(high >= 0.0)) return {};
    first[axis] = static_cast<int>(std::ceil(std::max(low, 0.0)));
    last[axis] = static_cast<int>(std::floor(std::min(high, top)));
  }
  std::vector<int> nodes;
  for (int k = first[2]; k <= last[2]; ++k) {
    for (int j = first[1]; j <= last[1]; ++j) {
      for (int i = first[0]; i <= last[0]; ++i) nodes.push_back(node(i, j, k));
    }
  }
  return nodes;
}

LatticeState Lattice::restState() const {
  LatticeState state;
  state.displacement.assign(fixed_.size(), Vec3::Zero());
  state.severed.assign(springs_.size(), 0);
  return state;
}

}  // namespace robot_tissue
