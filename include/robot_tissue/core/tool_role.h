// What a tool may do to the tissue beside pushing it. A role is a line of the table in
// src/core/config/tool_role.cpp and nowhere else.
#pragma once

#include <string>
#include <vector>

namespace robot_tissue {

struct ToolRole {
  std::string name = "push";
  bool has_jaws = false;  // its last two links
  bool holds = false;     // when its jaws are close, they hold what is between them
  bool shears = false;    // it cuts where the edges of its jaws have passed, and touches nothing
  bool has_edge = false;  // it cuts where its edge goes; its shapes are its sides
  bool fits_hard_patches = true;  // a method that moves tissue in hard pieces only can follow it
  bool drills = false;            // what its shapes cover goes, and it touches nothing

  // Whether it does nothing but push, and hold.
  bool touches() const { return !parts(); }
  bool parts() const { return has_edge || shears || drills; }
  std::string deed() const { return drills ? "drills" : parts() ? "cuts" : "touches"; }
};

const std::vector<ToolRole>& toolRoles();
// Throws InputError: no role of this name.
const ToolRole& toolRole(const std::string& name);

// Of the roles that have what is asked for, e.g. &ToolRole::holds: "a, b".
std::string toolRolesWith(bool ToolRole::*trait);

}  // namespace robot_tissue
