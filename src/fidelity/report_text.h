// What `fidelity` tells: the table, the choice, the progress bar.
#pragma once

#include <string>

#include "assessment.h"

namespace robot_tissue {

std::string tableText(const Assessment& assessment);
std::string tableCsv(const Assessment& assessment);

// Which lattices the estimate is from, and how regularly their answers approach a limit.
std::string limitText(const Assessment& assessment);

// "elastic, layered, spacing 5 mm, tolerance 0.03: error 3.1 %, 1.2 ms an update (830 a second)"
std::string rungText(const Assessed& row);

// The choice, or that none meets both and what can be met.
std::string choiceText(const Assessment& assessment, const Choice& choice, double error,
                       double rate);

// One line, "[####......] 3 of 20: 5 mm, tolerance 0.001, update 2 of 10".
std::string progressText(std::size_t done, std::size_t all, const Rung& rung, int update,
                         int updates);

}  // namespace robot_tissue
