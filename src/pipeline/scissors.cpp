#include "scissors.h"

#include <algorithm>
#include <cmath>

#include "stopwatch.h"
#include "swept_surface.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

double lengthOf(const std::vector<Vec3>& line) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) length += (line[i + 1] - line[i]).norm();
  return length;
}

Vec3 pointAlong(const std::vector<Vec3>& line, double length) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double part = (line[i + 1] - line[i]).norm();
    if (length <= part) return line[i] + (line[i + 1] - line[i]) * (length / part);
    length -= part;
  }
  return line.back();
}

// The last two links.
ScissorsState::Jaws jawsIn(const std::vector<Pose>& links) {
  const Pose tool_T_tissue = links.front().inverse();
  return {tool_T_tissue * links[links.size() - 2], tool_T_tissue * links.back()};
}

}  // namespace

void Scissors::endStrokes() {
  for (ScissorsState& state : states_) state.is_cutting = false;
}

bool Scissors::goTo(RobotPose& pose) {
  bool all = true;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    if (world_.tools[tool].role.shears) all = goTo(tool, pose) && all;
  }
  return all;
}

bool Scissors::goTo(std::size_t tool, RobotPose& pose) {
  ScissorsState& state = states_[tool];
  StrideActions actions;
  actions.length = tuning::kBladeStride * world_.tissue.lattice().spacing();
  actions.forget = [&] {
    const Strides strides = state.strides;
    state = ScissorsState();
    state.strides = strides;
    if (!strides.stands.empty()) beginAt(tool, jawsIn(strides.stands));
  };
  actions.move = [](const std::vector<Pose>&) {};
  actions.act = [&] { close(tool); };
  const bool arrived =
      goInStrides(world_, tool, world_.tools.linksOf(tool), actions, state.strides, pose);
  if (!world_.is_trial && !state.path.empty() && areClosed(tool)) close(tool);
  return arrived;
}

// m, along the way from tip to tip when they were widest apart; below 0: they have passed.
double Scissors::gapAt(std::size_t tool, const Jaws& jaws, const Places& places) const {
  const auto from_to = [](const Jaws& at, const Places& of) {
    return Vec3(at[1] * of[1] - at[0] * of[0]);
  };
  const Vec3 apart = from_to(states_[tool].path.front(), tipsOf(tool));
  const Vec3 now = from_to(jaws, places);
  return apart.norm() > 0.0 ? now.dot(apart.normalized()) : now.norm();
}

// Of the pieces, from the first on, those that have passed.
std::size_t Scissors::passedAt(std::size_t tool, const Jaws& jaws,
                               const std::vector<Piece>& pieces) const {
  const double met = tuning::kEdgesMeet * world_.tissue.lattice().spacing();
  const auto is_open = [&](const Piece& piece) { return gapAt(tool, jaws, piece.to) > met; };
  return static_cast<std::size_t>(std::find_if(pieces.begin(), pieces.end(), is_open) -
                                  pieces.begin());
}

bool Scissors::areClosed(std::size_t tool) const {
  const ScissorsState& state = states_[tool];
  const double met = tuning::kEdgesMeet * world_.tissue.lattice().spacing();
  return gapAt(tool, jawsIn(state.strides.stands), tipsOf(tool)) <= met;
}

Scissors::Places Scissors::tipsOf(std::size_t tool) const {
  const auto& edges = world_.tools[tool].scissors.edges;
  const double length = std::min(lengthOf(edges[0]), lengthOf(edges[1]));
  return {pointAlong(edges[0], length), pointAlong(edges[1], length)};
}

// Not longer than a stride.
std::vector<Scissors::Piece> Scissors::piecesOf(std::size_t tool) const {
  const auto& edges = world_.tools[tool].scissors.edges;
  const double length = std::min(lengthOf(edges[0]), lengthOf(edges[1]));
  const double stride = tuning::kBladeStride * world_.tissue.lattice().spacing();
  const int count = std::max(1, static_cast<int>(std::ceil(length / stride)));
  std::vector<Piece> pieces;
  for (int i = 0; i < count; ++i) {
    Piece piece;
    for (std::size_t jaw = 0; jaw < 2; ++jaw) {
      piece.from[jaw] = pointAlong(edges[jaw], length * i / count);
      piece.to[jaw] = pointAlong(edges[jaw], length * (i + 1) / count);
    }
    pieces.push_back(piece);
  }
  return pieces;
}

void Scissors::close(std::size_t tool) {
  ScissorsState& state = states_[tool];
  const Places tips = tipsOf(tool);
  const Jaws now = jawsIn(state.strides.stands);
  const double met = tuning::kEdgesMeet * world_.tissue.lattice().spacing();
  const double closer = gapAt(tool, state.path.back(), tips) - gapAt(tool, now, tips);
  if (closer < -met) return beginAt(tool, now);  // they open
  if (closer < met) return;
  state.path.push_back(now);
  const std::vector<Piece> pieces = piecesOf(tool);
  const std::size_t passed = passedAt(tool, now, pieces);
  std::vector<CutTriangle> swept;
  for (; state.passed < passed; ++state.passed) {
    const Piece& piece = pieces[state.passed];
    for (std::size_t jaw = 0; jaw < 2; ++jaw) {
      std::vector<Pose> way;
      for (const Jaws& jaws : state.path) way.push_back(state.tool() * jaws[jaw]);
      addSwept({piece.from[jaw], piece.to[jaw]}, way, swept);
    }
  }
  if (!swept.empty()) cut(tool, swept);
}

// The widest apart until now: what has passed there cuts nothing.
void Scissors::beginAt(std::size_t tool, const Jaws& jaws) {
  ScissorsState& state = states_[tool];
  state.path = {jaws};
  state.passed = passedAt(tool, jaws, piecesOf(tool));
  state.is_cutting = false;
}

void Scissors::cut(std::size_t tool, const std::vector<CutTriangle>& swept) {
  ScissorsState& state = states_[tool];
  const Stopwatch watch(world_.report.solve_ms);
  const CutReport cut =
      world_.tissue.cutAlong(swept, state.is_cutting ? Stroke::kGoesOn : Stroke::kBegins);
  if (cut.springs_cut == 0) return;
  state.is_cutting = true;
  noteCut(world_, cut);
}

}  // namespace robot_tissue
