// The content of the runner's output files. Numbers with all their digits; throws
// std::runtime_error rather than write a number that is not finite.
#pragma once

#include <string>

#include "run_scene.h"

namespace robot_tissue {

std::string nodesCsv(const RunResult& result);
std::string patchesCsv(const RunResult& result);
std::string incrementsCsv(const RunResult& result);
std::string toolsCsv(const RunResult& result);
std::string piecesCsv(const RunResult& result);
std::string suturesCsv(const RunResult& result);
std::string surfaceStl(const RunResult& result);

}  // namespace robot_tissue
