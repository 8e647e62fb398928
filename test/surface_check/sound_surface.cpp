#include "sound_surface.h"

#include <cmath>
#include <map>
#include <sstream>
#include <vector>

#include "exact_surface.h"

namespace robot_tissue {
namespace {

constexpr double kVolumeOff = 1e-6;  // of the volume: doc/surgery.md

std::map<int, std::vector<MeshTriangle>> trianglesOfPieces(const Tissue& tissue) {
  const TissueSurface& surface = tissue.surface();
  std::map<int, std::vector<MeshTriangle>> of_pieces;
  for (const MeshTriangle& triangle : surface.triangles) {
    const int node = surface.carriers[at(triangle.front())].front().node;
    of_pieces[tissue.pieceOfNodes()[at(node)]].push_back(triangle);
  }
  return of_pieces;
}

}  // namespace

double volumeOf(const Tissue& tissue) {
  return enclosedVolume(tissue.surface(), tissue.surface().rest);
}

std::string faultOf(const Tissue& tissue, double volume, double rounding) {
  const TissueSurface& surface = tissue.surface();
  std::map<int, std::vector<MeshTriangle>> of_pieces = trianglesOfPieces(tissue);
  std::ostringstream fault;
  const std::vector<TissuePiece> pieces = tissue.pieces();
  if (of_pieces.size() != pieces.size()) {
    fault << of_pieces.size() << " pieces are shown, there are " << pieces.size() << "; ";
  }
  double inside = 0.0;
  for (const TissuePiece& piece : pieces) {
    const std::vector<MeshTriangle>& triangles = of_pieces[piece.number];
    if (isClosedAndManifold(surface.rest, triangles)) {
      inside += volumeInside(surface.rest, triangles);
    } else {
      fault << "piece " << piece.number << " is not closed and manifold; ";
    }
  }
  const double off = inside / volume - 1.0;
  if (!(std::abs(off) <= kVolumeOff)) fault << "the volume is off by " << off << "; ";
  const Crossings crossings = crossingsOf(surface.rest, surface.triangles);
  const bool is_none = rounding > 0.0 ? crossings.depth <= rounding : crossings.pairs == 0;
  if (!is_none) {
    fault << crossings.pairs << " pairs of triangles cross by up to " << crossings.depth << " m; ";
  }
  return fault.str();
}

}  // namespace robot_tissue
