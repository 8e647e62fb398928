// The files that a scene is read from, so that no result is written over one of them.
#pragma once

#include <string>
#include <vector>

#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// The scene's own and those of its meshes, but for meshes of ROS packages. `scene`: what was read
// from the file at `path`.
std::vector<std::string> inputFiles(const Scene& scene, const std::string& path);

// The one of `inputs` that is the file at `output`, also under another name; empty: none is.
std::string inputAt(const std::string& output, const std::vector<std::string>& inputs);

}  // namespace robot_tissue
