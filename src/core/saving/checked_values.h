// Values of a saved state that no scene could have made throw InputError.
#pragma once

#include <string>

#include "robot_tissue/core/types.h"
#include "saving/bytes.h"

namespace robot_tissue {

[[noreturn]] void failAsDamaged(const std::string& what);

double takeNumber(ByteReader& in);  // finite, and of a size that is met
Vec3 takeVector(ByteReader& in);
bool takeTruth(ByteReader& in);
std::string takeName(ByteReader& in);  // of a load or a suture, as a scene allows
int takeNode(int node_count, ByteReader& in);

}  // namespace robot_tissue
