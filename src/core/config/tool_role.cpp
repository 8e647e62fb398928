#include "robot_tissue/core/tool_role.h"

#include "robot_tissue/core/types.h"

namespace robot_tissue {

const std::vector<ToolRole>& toolRoles() {
  static const std::vector<ToolRole> all = {{"push", false, false, true, false},
                                            {"blade", false, true, true, false},
                                            {"grasper", true, false, false, false},
                                            {"burr", false, false, true, true}};
  return all;
}

const std::vector<std::string>& plannedToolRoles() {
  static const std::vector<std::string> planned;
  return planned;
}

const ToolRole& toolRole(const std::string& name) {
  std::string known;
  for (const ToolRole& role : toolRoles()) {
    if (role.name == name) return role;
    known += (known.empty() ? "" : ", ") + role.name;
  }
  throw InputError("role: '" + name + "' is unknown; allowed: " + known);
}

std::string toolRolesWith(bool ToolRole::*trait) {
  std::string names;
  for (const ToolRole& role : toolRoles()) {
    if (role.*trait) names += (names.empty() ? "" : ", ") + role.name;
  }
  return names;
}

}  // namespace robot_tissue
