// Files of saved states (doc/state_file.md): by plain name in one folder, whole or not at all.
#pragma once

#include <string>

namespace robot_tissue {

// Why a text is no such name ("must be ..."), empty when it is one.
std::string stateFileFault(const std::string& name);

// Makes the folder where it is missing. Who reads the file, or comes back after a loss of power,
// finds the old content or the new. True: it took the place of an earlier one. Throws InputError:
// "file = 'a b': must be ...", a full disk.
bool writeStateFile(const std::string& folder, const std::string& name, const std::string& bytes);

// Throws InputError, e.g. where there is none.
std::string readStateFile(const std::string& folder, const std::string& name);

}  // namespace robot_tissue
