// The legend of the surface's color: a bar beside the tissue, its ends' numbers and what they are.
#include <string>

#include "drawn_state.h"
#include "robot_tissue/ros/conversions.h"
#include "robot_tissue/scene/value_text.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

// A column with four sides, to be seen from everywhere, in strips of a color each.
void drawColumn(const Vec3& foot, double width, double height, Marker& column) {
  const auto corner = [&](int side, int step) {
    const double x = side == 1 || side == 2 ? width : 0.0, y = side == 2 || side == 3 ? width : 0.0;
    return toPoint(foot + Vec3(x, y, height * step / tuning::kLegendSteps));
  };
  for (int step = 0; step < tuning::kLegendSteps; ++step) {
    for (int side = 0; side < 4; ++side) {
      const int next = (side + 1) % 4;
      for (const auto& point :
           {corner(side, step), corner(next, step), corner(next, step + 1), corner(side, step),
            corner(next, step + 1), corner(side, step + 1)}) {
        column.points.push_back(point);
        column.colors.push_back(colorOf((step + 0.5) / tuning::kLegendSteps));
      }
    }
  }
}

std::string numberWith(double number, const char* unit) { return numberText(number) + " " + unit; }

}  // namespace

void drawLegend(const Drawn& drawn, const Marker& blank, MarkerArray& array) {
  const bool shown = !drawn.values.empty();
  const ColorMeaning& meaning = meaningOf(drawn.style.color);
  const double diagonal = drawn.diagonal();
  const double height = tuning::kLegendHeight * diagonal, letters = tuning::kTextHeight * diagonal;
  const Vec3 foot =
      drawn.tissue().lattice().bounds().min() - Vec3(tuning::kLegendGap * diagonal, 0.0, 0.0);
  Marker column = blank;
  column.type = Marker::TRIANGLE_LIST;
  if (shown) drawColumn(foot, tuning::kLegendWidth * diagonal, height, column);
  add(std::move(column), array);

  const std::pair<std::string, double> lines[] = {
      {numberWith(0.0, meaning.unit), -letters},
      {numberWith(drawn.scale, meaning.unit), height + letters},
      {meaning.title, height + 2.5 * letters}};
  for (int i = 0; i < 3; ++i) {
    Marker line = blank;
    line.id = i + 1;
    line.scale.x = line.scale.y = 0.0;
    line.scale.z = letters;
    line.pose.position = toPoint(foot + Vec3(0.0, 0.0, lines[i].second));
    if (shown) line.text = lines[i].first;
    add(std::move(line), array);
  }
}

}  // namespace robot_tissue
