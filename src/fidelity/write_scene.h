// Writes a scene's text anew with another spacing, method and tolerance.
#pragma once

#include <string>

#include "trial.h"

namespace robot_tissue {

// The text of a scene file with the rung's values in place. What else stands in the text, comments
// and order too, stays; where that cannot be done (values shared by anchors, keys written in ways
// that are not found again), the same keys and values are written without comments.
// `from` and `to`: folders of the text and of where it will stand; relative paths of meshes follow.
std::string withRung(const std::string& text, const Rung& rung, const std::string& from,
                     const std::string& to);

}  // namespace robot_tissue
