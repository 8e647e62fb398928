#include "robot_tissue/core/composition.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "config/material.h"
#include "geometry/mesh_columns.h"
#include "geometry/mesh_slicing.h"

namespace robot_tissue {
namespace {

// Panels along each axis of a cell that several surfaces cross (1). More: shares of its materials
// are more exact, at the square of the cost. At 4 they are off by some thousandths of the cell.
// Chosen.
constexpr int kPanels = 4;
constexpr double kLeastLength = 1e-9;  // of a cell's lines (1): less is rounding

using Stretches = std::vector<std::pair<double, double>>;  // heights, in spacings

bool holds(const Stretches& stretches, double height) {
  return std::any_of(stretches.begin(), stretches.end(), [height](const auto& stretch) {
    return stretch.first <= height && height < stretch.second;
  });
}

// Cells of the grid that hold what of the mesh is in it, and the grid between them.
struct Window {
  std::array<int, 3> low{};
  Grid grid;
};

Window windowOf(const TriangleMesh& mesh, const Grid& grid) {
  const Box bounds = boundsOf(mesh.vertices);
  std::array<int, 3> low{}, high{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const auto cells = static_cast<double>(grid.size()[axis] - 1);
    const auto along = [&](double place) {
      return (place - grid.shape().min()[a]) / grid.spacing();
    };
    low[axis] = static_cast<int>(std::clamp(std::floor(along(bounds.min()[a])), 0.0, cells - 1.0));
    high[axis] =
        static_cast<int>(std::clamp(std::ceil(along(bounds.max()[a])), low[axis] + 1.0, cells));
  }
  const auto point = [&grid](const std::array<int, 3>& index) {
    return Vec3(grid.shape().min() + grid.spacing() * Vec3(index[0], index[1], index[2]));
  };
  return {low, Grid({point(low), point(high)}, grid.spacing())};
}

// A mesh in the grid of a tissue, that may reach beyond it.
class MeshInGrid {
 public:
  MeshInGrid(const TriangleMesh& mesh, const Grid& grid)
      : mesh_(mesh), window_(windowOf(mesh, grid)) {}

  // Of the cell's volume, what the mesh encloses.
  double shareAt(const std::array<int, 3>& cell) {
    if (shares_.empty()) shares_ = slicedWithin(mesh_, window_.grid).filled;
    std::size_t number = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
      const int along = cell[axis] - window_.low[axis], count = window_.grid.size()[axis] - 1;
      if (along < 0 || along >= count) return 0.0;
      number = number * at(count) + at(along);
    }
    return shares_[number];
  }

  // Where the vertical line through x and y is inside, in spacings of the tissue's grid.
  Stretches insideAt(double x, double y) {
    if (!columns_) columns_.emplace(mesh_, window_.grid);
    Stretches inside = columns_->insideAt(x - window_.low[0], y - window_.low[1]);
    for (auto& [low, high] : inside) {
      low += window_.low[2];
      high += window_.low[2];
    }
    return inside;
  }

 private:
  const TriangleMesh& mesh_;
  Window window_;
  std::vector<double> shares_;
  std::optional<MeshColumns> columns_;
};

// Places of vertical lines in a cell, along x and y: those of Gauss's rule of two points in each of
// kPanels panels.
const std::vector<double>& columnPlaces() {
  static const std::vector<double> places = [] {
    std::vector<double> found;
    for (int panel = 0; panel < kPanels; ++panel) {
      for (const double side : {-1.0, 1.0}) {
        found.push_back((panel + 0.5 + side * 0.5 / std::sqrt(3.0)) / kPanels);
      }
    }
    return found;
  }();
  return places;
}

class Composer {
 public:
  Composer(const TissueConfig& config, const FilledGrid& tissue)
      : config_(config), tissue_(tissue) {
    if (config.mesh) tissue_mesh_.emplace(*config.mesh, tissue.grid);
    for (const Region& region : config.regions) {
      meshes_.emplace_back();
      if (region.mesh) meshes_.back().emplace(*region.mesh, tissue.grid);
    }
  }

  Composition of(int cell) {
    place_ = indexOf(cell);
    findLayers();
    const double filled = tissue_.filled[at(cell)];
    if (layers_.empty()) return {{ground_, 1.0}};
    if (layers_.size() > 1 || filled < 1.0) {
      if (const auto found = byColumns(filled < 1.0)) return *found;
    }
    const Layer& only = layers_.front();
    return {{ground_, 1.0 - only.share}, {only.region, only.share}};
  }

 private:
  struct Layer {
    int region;
    double share;  // of the whole cell's volume
  };

  // Regions that are in the cell in part, the uppermost first, and what is below them.
  void findLayers() {
    layers_.clear();
    ground_ = kOwnMaterial;
    for (int region = static_cast<int>(config_.regions.size()) - 1; region >= 0; --region) {
      const double share = shareOf(region);
      if (share >= 1.0) {
        ground_ = region;
        return;
      }
      if (share > 0.0) layers_.push_back({region, share});
    }
  }

  double shareOf(int region) {
    if (meshes_[at(region)]) return meshes_[at(region)]->shareAt(place_);
    return contains(config_.regions[at(region)], center(), config_.spacing) ? 1.0 : 0.0;
  }

  std::array<int, 3> indexOf(int cell) const {
    const auto& size = tissue_.grid.size();
    const int row = cell / (size[0] - 1);
    return {cell % (size[0] - 1), row % (size[1] - 1), row / (size[1] - 1)};
  }

  Vec3 center() const {
    const double spacing = tissue_.grid.spacing();
    return tissue_.grid.shape().min() + spacing * Vec3(place_[0], place_[1], place_[2]) +
           Vec3::Constant(0.5 * spacing);
  }

  // Where several surfaces cross the cell: exact along vertical lines. Nothing where none of them
  // meets tissue.
  std::optional<Composition> byColumns(bool filled_in_part) {
    std::map<int, double> lengths;  // by region
    for (const double x : columnPlaces()) {
      for (const double y : columnPlaces()) {
        addColumn(place_[0] + x, place_[1] + y, filled_in_part, lengths);
      }
    }
    double all = 0.0;
    for (const auto& [region, length] : lengths) all += length;
    if (!(all > kLeastLength)) return std::nullopt;
    Composition composition;
    for (const auto& [region, length] : lengths) {
      if (length > kLeastLength * all) composition.push_back({region, length / all});
    }
    return composition;
  }

  void addColumn(double x, double y, bool filled_in_part, std::map<int, double>& lengths) {
    const double floor = place_[2];
    std::vector<Stretches> inside = {{{floor, floor + 1.0}}};  // of the tissue, then of the layers
    if (filled_in_part) inside.front() = tissue_mesh_->insideAt(x, y);
    for (const Layer& layer : layers_) {
      inside.push_back(meshes_[at(layer.region)]->insideAt(x, y));
    }
    std::vector<double> heights = {floor, floor + 1.0};
    for (const Stretches& stretches : inside) {
      for (const auto& [low, high] : stretches) {
        for (const double height : {low, high}) {
          if (height > floor && height < floor + 1.0) heights.push_back(height);
        }
      }
    }
    std::sort(heights.begin(), heights.end());
    for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
      const double middle = 0.5 * (heights[i] + heights[i + 1]);
      if (!holds(inside.front(), middle)) continue;
      lengths[uppermostAt(middle, inside)] += heights[i + 1] - heights[i];
    }
  }

  int uppermostAt(double height, const std::vector<Stretches>& inside) const {
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
      if (holds(inside[layer + 1], height)) return layers_[layer].region;
    }
    return ground_;
  }

  const TissueConfig& config_;
  const FilledGrid& tissue_;
  std::optional<MeshInGrid> tissue_mesh_;
  std::vector<std::optional<MeshInGrid>> meshes_;  // of the regions that have one
  std::array<int, 3> place_{};                     // of the cell that is looked at
  std::vector<Layer> layers_;
  int ground_ = kOwnMaterial;
};

}  // namespace

CellCompositions compositionsOf(const TissueConfig& config, const FilledGrid& tissue) {
  CellCompositions found;
  std::map<int, std::uint32_t> kind_of;  // of one material, by region
  Composer composer(config, tissue);
  for (int cell = 0; cell < tissue.grid.cellCount(); ++cell) {
    if (tissue.filled[at(cell)] <= 0.0) continue;
    Composition composition = composer.of(cell);
    const auto next = static_cast<std::uint32_t>(found.kinds.size());
    const bool is_pure = composition.size() == 1;
    const auto known = is_pure ? kind_of.find(composition.front().region) : kind_of.end();
    found.of_cell.push_back(known != kind_of.end() ? known->second : next);
    if (known != kind_of.end()) continue;
    if (is_pure) kind_of[composition.front().region] = next;
    found.kinds.push_back(std::move(composition));
  }
  if (found.kinds.size() == 1) found.of_cell = std::vector<std::uint32_t>();
  return found;
}

const Material& materialOf(const TissueConfig& config, int region) {
  return region == kOwnMaterial ? config.material : config.regions[at(region)].material;
}

double densityOf(const TissueConfig& config, const Composition& composition) {
  double density = 0.0;
  for (const auto& part : composition)
    density += part.share * materialOf(config, part.region).density;
  return density;
}

}  // namespace robot_tissue
