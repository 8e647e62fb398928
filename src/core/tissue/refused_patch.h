// How a patch of a load is refused: in one line.
#pragma once

#include <string>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

[[noreturn]] inline void refusePatch(const std::string& patch, const std::string& problem,
                                     const std::string& allowed) {
  throw InputError("patch '" + patch + "': " + problem + "; allowed: " + allowed);
}

}  // namespace robot_tissue
