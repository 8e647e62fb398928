// What a loading patch may be called, in a scene as in a service's request.
#pragma once

#include <string>

namespace robot_tissue {

// Names become fields of CSV files, namespaces of markers and words of messages. Throws InputError:
// "name = "a,b": must be ...".
void requirePatchName(const std::string& name);

// Why a text is no such name ("must be ..."), empty when it is one.
std::string patchNameFault(const std::string& name);

}  // namespace robot_tissue
