#include "robot_tissue/core/tool_role.h"

#include "robot_tissue/core/types.h"

namespace robot_tissue {

namespace {

std::vector<ToolRole> table() {
  ToolRole push, blade, grasper, burr, scissors;
  blade.name = "blade";
  blade.has_edge = true;
  grasper.name = "grasper";
  grasper.has_jaws = grasper.holds = true;
  grasper.fits_hard_patches = false;
  burr.name = "burr";
  burr.drills = true;
  scissors.name = "scissors";
  scissors.has_jaws = scissors.shears = true;
  return {push, blade, grasper, burr, scissors};
}

}  // namespace

const std::vector<ToolRole>& toolRoles() {
  static const std::vector<ToolRole> all = table();
  return all;
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
