// The models and methods that there are. A new one is added in the registry.
#pragma once

#include <string>
#include <vector>

namespace robot_tissue {

const std::vector<std::string>& modelNames();
const std::vector<std::string>& methodNames();

// The methods that fit the model; the first is the default.
std::vector<std::string> methodsFor(const std::string& model);

}  // namespace robot_tissue
