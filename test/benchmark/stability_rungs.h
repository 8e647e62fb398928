// The rungs of the stability ladder (doc/stability.md).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "stability_specimen.h"

namespace robot_tissue {

struct Rung {
  std::string name;
  std::string group;
  TissueConfig tissue;
  std::vector<Box> patches;
  std::vector<std::vector<Vec3>> cuts;  // made at rest
  // Puts patches, or gravity, to this share of the way.
  std::function<void(Specimen&, double share)> go;
  int increments = 1;
  // At the end of the way.
  std::function<double(const Specimen&)> measure;
  std::string unit;
  int reference_increments = 0;  // in which `newton` finds the reference; 0: it has none
  std::optional<double> known;   // the reference, by finite elements or by thought
  double bound = 0.05;           // of what was measured off the reference, over it
  bool has_no_shape = false;     // without inverted cells: what is asked is that it is said
  std::function<void(Specimen&)> afterwards;  // on the way to `measure`, after the load
};

std::vector<Rung> makeRungs();

}  // namespace robot_tissue
