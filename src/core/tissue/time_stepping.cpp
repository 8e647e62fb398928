// Tissue: how it moves in time.
#include <algorithm>
#include <cmath>

#include "cutting/split_cells.h"
#include "material/elastic_model.h"
#include "solvers/solver_method.h"
#include "tissue/solve_total.h"
#include "tissue/threads.h"
#include "tissue/time_integrator.h"
#include "tissue/tissue_parts.h"
#include "tissue/tuning.h"

namespace robot_tissue {

bool TissueParts::isMoving() const { return time_ && in_time_ && time_->moves(); }

bool TissueParts::goesThroughTime() const {
  return goesInTime() && method_->goesThroughTimeSteps();
}

double TissueParts::longestTimeStep() const { return time_->longestStep(); }

// Whether loads that go and cuts leave the shape as it is, to be moved by time.
bool TissueParts::takesNoTime() const { return time_ && !in_time_step_; }

void TissueParts::expectTimeStep(double duration, Touched touched) {
  using Scheme = TimeIntegrator::Scheme;
  const auto& model = dynamic_cast<const ElasticModel&>(body_.model());
  expects_time_step_ = true;
  time_->expect(duration,
                touched == Touched::kByTools ? Scheme::kBackwardEuler : Scheme::kGeneralizedAlpha,
                body_.state(), model.nodeMasses(body_.cells()));
}

void TissueParts::beginTimeStep(double duration, Touched touched) {
  expectTimeStep(duration, touched);
  const auto& model = dynamic_cast<const ElasticModel&>(body_.model());
  in_time_ = in_time_step_ = true;
  body_.model().setInertia(nullptr);
  const auto cell_forces = [&](const LatticeState& shape) {
    std::vector<Vec3> forces = method_->cellForces(shape);
    return forces.empty() ? model.cellForces(shape) : forces;
  };
  body_.model().setInertia(&time_->begin(body_.state(), cell_forces));
}

void TissueParts::endTimeStep() {
  expects_time_step_ = false;
  if (!in_time_step_) return;
  in_time_step_ = false;
  const std::vector<std::size_t> falling = fallingPieces();
  for (const std::size_t piece : falling) {
    shift(free_pieces_[piece], -time_->drift(free_pieces_[piece], body_.state(), body_.gravity()));
  }
  time_->end(body_.state(), method_->velocities());
  if (!time_->moves()) return;
  for (const std::size_t piece : falling) shift(free_pieces_[piece], -time_->lead(body_.gravity()));
}

void TissueParts::findFreePieces() {
  if (free_pieces_of_ == body_.state().cells) return;
  free_pieces_of_ = body_.state().cells;
  const std::vector<int>& pieces = pieceOfNodes();
  std::vector<bool> held;
  free_pieces_.clear();
  for (std::size_t node = 0; node < pieces.size(); ++node) {
    if (pieces[node] < 0) continue;
    const std::size_t piece = at(pieces[node]);
    if (free_pieces_.size() <= piece) free_pieces_.resize(piece + 1);
    held.resize(free_pieces_.size(), false);
    free_pieces_[piece].push_back(static_cast<int>(node));
    if (isFixed(body_.lattice(), body_.cells(), static_cast<int>(node))) held[piece] = true;
  }
  for (std::size_t piece = 0; piece < held.size(); ++piece) {
    if (held[piece]) free_pieces_[piece].clear();
  }
}

// Of free_pieces_, those that nothing holds or touches: their centers of mass go as gravity says,
// to rounding.
std::vector<std::size_t> TissueParts::fallingPieces() {
  findFreePieces();
  std::vector<int> touched = threads_->nodes();
  for (const LoadingPatch& patch : loads_.patches()) {
    touched.insert(touched.end(), patch.nodes.begin(), patch.nodes.end());
    for (const ContactSpring& contact : patch.contacts) {
      for (const NodeWeight& carrier : contact.carriers) touched.push_back(carrier.node);
    }
  }
  std::sort(touched.begin(), touched.end());
  const auto is_touched = [&](int node) {
    return std::binary_search(touched.begin(), touched.end(), node);
  };
  std::vector<std::size_t> falling;
  for (std::size_t piece = 0; piece < free_pieces_.size(); ++piece) {
    const std::vector<int>& nodes = free_pieces_[piece];
    if (!nodes.empty() && std::none_of(nodes.begin(), nodes.end(), is_touched)) {
      falling.push_back(piece);
    }
  }
  return falling;
}

void TissueParts::shift(const std::vector<int>& nodes, const Vec3& way) {
  if (way.isZero(0.0)) return;
  std::vector<Vec3>& displacement = body_.change().displacement;
  for (const int node : nodes) displacement[at(node)] += way;
  deformSurface();
}

void TissueParts::stopTime() {
  if (!time_) return;
  in_time_ = in_time_step_ = expects_time_step_ = false;
  time_->rest();
  body_.model().setInertia(nullptr);
}

// Until it was solved for, the shape at rest is not the one under gravity or a pressure.
void TissueParts::wakeUnderBodyLoad() {
  if (!time_ || !body_.hasBodyLoad()) return;
  in_time_ = true;
  time_->wake(body_.state());
}

// Loads or cuts are others, the shape is not yet.
SolveReport TissueParts::asItIs() {
  in_time_ = true;
  time_->wake(body_.state());
  outcome_.report.patches.resize(loads_.patches().size());
  return outcome_.report;
}

// Tools would have to be looked at on the way.
void TissueParts::predict() {
  LatticeState& state = body_.change();
  for (std::size_t node = 0; node < state.displacement.size(); ++node) {
    const int index = static_cast<int>(node);
    if (!isGone(state, index) && !isFixed(body_.lattice(), *state.cells, index)) {
      state.displacement[node] = time_->predicted(node);
    }
  }
}

SolveReport TissueParts::wait(double duration) {
  if (in_time_ && !time_->moves()) {
    outcome_.report.iterations = 0;
    outcome_.report.wall_ms = 0.0;
    return outcome_.report;
  }
  double left = duration;
  double longest = longestTimeStep();
  SolveTotal total;
  while (left > 0.0) {
    const double steps = std::ceil(left / longest - tuning::kRounding);
    const double step = left / std::max(1.0, steps);
    const Shape good = shape();
    beginTimeStep(step);
    if (loads_.patches().empty()) predict();
    const SolveReport report = solve({});
    endTimeStep();
    total.addWork(report);
    if (time_->errorRatio() > tuning::kRefusedError && step > tuning::kShortestStep) {
      longest = std::max(tuning::kShortestStep, tuning::kMostShrink * step);
      restore(good);
      continue;
    }
    tear();
    longest = longestTimeStep();
    total.worsen(report.status);
    left = steps > 1.0 ? left - step : 0.0;
    if (!time_->moves()) break;
    if (deadline_ && deadline_->isOver() && left > 0.0) {
      total.worsen(SolveStatus::kLate);
      break;
    }
  }
  total.tellIn(outcome_.report);
  return outcome_.report;
}

}  // namespace robot_tissue
