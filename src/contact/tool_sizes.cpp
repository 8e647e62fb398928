#include "robot_tissue/contact/tool_sizes.h"

#include <sstream>

#include "tuning.h"

namespace robot_tissue {

std::string remarkOnSize(const std::string& tool, const std::string& link, double extent,
                         double tissue_extent) {
  if (!(extent > tuning::kLargestTool * tissue_extent)) return "";
  std::ostringstream text;
  if (!link.empty()) text << "link '" << link << "' of ";
  text << "tool '" << tool << "' is " << extent << " m across beside a tissue of " << tissue_extent
       << " m: a mesh in millimeters has scale 0.001";
  return text.str();
}

}  // namespace robot_tissue
