// What the surface's color tells (~color): a value at each vertex, and the color of a value. rviz
// does not light what has colors of its own, so light from above is part of them.
#pragma once

#include <std_msgs/ColorRGBA.h>

#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

enum class ColorBy { kNone, kDisplacement, kStrain, kPressure };

struct ColorMeaning {
  const char* name;   // as ~color says it
  const char* title;  // of the legend
  const char* unit;   // of values and legend
};
const ColorMeaning& meaningOf(ColorBy color);
std::optional<ColorBy> colorByName(const std::string& name);
std::vector<std::string> colorNames();

// One a vertex of the surface, in the unit of the legend; empty for kNone.
//   displacement: length of the way from rest
//   strain: surfaceStrains; pressure: touchPressures
std::vector<double> surfaceValues(ColorBy color, const Pipeline& pipeline);

// The upper end of a scale that holds all values: 1, 2 or 5 times a power of ten. `present`: that
// of before, which stays while enough of it is in use; 0: there is none.
double scaleFor(const std::vector<double>& values, double present);

// Of a share of the scale, 0 to 1.
std_msgs::ColorRGBA colorOf(double share);
// As it looks where the surface has the unit normal.
std_msgs::ColorRGBA litColorOf(double share, const Vec3& normal);

}  // namespace robot_tissue
