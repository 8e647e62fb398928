#include "robot_tissue/scene/patch_name.h"

#include <algorithm>

#include "robot_tissue/core/name_rules.h"
#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {

std::string patchNameFault(const std::string& name) {
  const bool fits = !name.empty() && name.size() <= kLongestName && isUtf8(name) &&
                    std::all_of(name.begin(), name.end(), mayBeInName);
  if (fits) return "";
  return "must be a name of at most " + std::to_string(kLongestName) +
         " bytes without commas, quotes and control characters";
}

void requirePatchName(const std::string& name) {
  const std::string fault = patchNameFault(name);
  if (!fault.empty()) throw InputError("name = \"" + shortText(name) + "\": " + fault);
}

}  // namespace robot_tissue
