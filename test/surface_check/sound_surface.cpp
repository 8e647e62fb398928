#include "sound_surface.h"

#include <algorithm>
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

// Of pieces without a triangle (cells): the greatest volume.
double greatestUnshown(const Tissue& tissue, const std::vector<TissuePiece>& pieces,
                       const std::map<int, std::vector<MeshTriangle>>& of_pieces) {
  double greatest = 0.0;
  for (const TissuePiece& piece : pieces) {
    if (of_pieces.count(piece.number) == 0) greatest = std::max(greatest, piece.volume);
  }
  return greatest / std::pow(tissue.lattice().spacing(), 3);
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
    fault << of_pieces.size() << " pieces are shown, there are " << pieces.size()
          << ", the others have up to " << greatestUnshown(tissue, pieces, of_pieces)
          << " of a cell; ";
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
