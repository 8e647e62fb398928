#include "run_scene.h"

#include <algorithm>
#include <stdexcept>

namespace robot_tissue {
namespace {

class Runner {
 public:
  Runner(const Scene& scene, const OnRow& on_row)
      : scene_(scene), on_row_(on_row), tissue_(scene.tissue, scene.solver) {}

  RunResult run() {
    for (std::size_t i = 0; i < scene_.steps.size(); ++i) {
      step_ = static_cast<int>(i);
      try {
        std::visit([this](const auto& step) { perform(step); }, scene_.steps[i]);
      } catch (const InputError& error) {
        throw InputError("steps[" + std::to_string(step_) + "]: " + error.what());
      }
    }
    keepShape();
    return std::move(result_);
  }

 private:
  void perform(const SettleStep&) { keep(tissue_.settle()); }
  void perform(const LoadStep& step) {
    tissue_.load(step, [this](int increment, int increments, const SolveReport& report) {
      keep(report, increment, increments);
    });
  }
  void perform(const CutStep& step) { keep(tissue_.cut(step.corners).solve); }
  void perform(const ReleaseStep& step) { keep(tissue_.release(step.patches)); }
  void perform(const ResetStep&) {
    tissue_.reset();
    keep(SolveReport());
  }

  void keep(const SolveReport& report, int increment = 1, int increments = 1) {
    const std::vector<LoadingPatch>& patches = tissue_.patches();
    if (patches.size() != report.patches.size()) {
      throw std::logic_error("the solver answered for " + std::to_string(report.patches.size()) +
                             " patches, " + std::to_string(patches.size()) + " stand");
    }
    for (std::size_t i = 0; i < patches.size(); ++i) {
      result_.patches.push_back({step_, increment, patches[i].name, report.patches[i]});
    }
    result_.increments.push_back({step_, increment, report});
    if (on_row_) on_row_(result_.increments.back(), increments);
  }

  void keepShape() {
    const Lattice& lattice = tissue_.lattice();
    for (int node = 0; node < lattice.nodeCount(); ++node) {
      result_.rest.push_back(lattice.restPosition(node));
    }
    result_.displacement = tissue_.shownDisplacement();
    deform(tissue_.surface(), result_.displacement, result_.vertices);
    result_.triangles = tissue_.surface().triangles;
    result_.displacement.resize(result_.rest.size());  // ghosts are no nodes of the lattice
  }

  const Scene& scene_;
  const OnRow& on_row_;
  Tissue tissue_;
  RunResult result_;
  int step_ = 0;
};

}  // namespace

bool RunResult::allOk() const {
  return std::all_of(increments.begin(), increments.end(),
                     [](const auto& row) { return row.report.status == SolveStatus::kOk; });
}

RunResult runScene(const Scene& scene, const OnRow& on_row) { return Runner(scene, on_row).run(); }

}  // namespace robot_tissue
