// Tools whose size a mistaken unit tells.
#pragma once

#include <string>

namespace robot_tissue {

// Extents in m, the greatest along an axis. Empty: nothing is wrong with the link's.
std::string remarkOnSize(const std::string& tool, const std::string& link, double extent,
                         double tissue_extent);

}  // namespace robot_tissue
