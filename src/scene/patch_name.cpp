#include "robot_tissue/scene/patch_name.h"

#include <algorithm>

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kLongestName = 64;  // bytes

bool isAllowed(char c) {
  return c != ',' && c != '"' && static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
}

}  // namespace

std::string patchNameFault(const std::string& name) {
  const bool fits = !name.empty() && name.size() <= kLongestName && isUtf8(name) &&
                    std::all_of(name.begin(), name.end(), isAllowed);
  if (fits) return "";
  return "must be a name of at most " + std::to_string(kLongestName) +
         " bytes without commas, quotes and control characters";
}

void requirePatchName(const std::string& name) {
  const std::string fault = patchNameFault(name);
  if (!fault.empty()) throw InputError("name = \"" + shortText(name) + "\": " + fault);
}

}  // namespace robot_tissue
