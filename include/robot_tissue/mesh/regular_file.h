// Files that users name: read whole, and only where that comes to an end.
#pragma once

#include <cstddef>
#include <string>

namespace robot_tissue {

// The bytes of a regular file, or of one that a link leads to. Throws InputError whose text is a
// reason such as "is a folder": pipes and devices give bytes for ever or never, and larger files
// fill the memory.
std::string readRegularFile(const std::string& path, std::size_t most_bytes);

}  // namespace robot_tissue
