#include "robot_tissue/pipeline/step_remarks.h"

namespace robot_tissue {
namespace {

using Kind = StepRemark::Kind;

std::string listOf(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 < names.size() ? ", " : " and ";
    list += "'" + names[i] + "'";
  }
  return list;
}

void addOfJaws(const Pipeline& pipeline, std::vector<StepRemark>& remarks) {
  const StepReport& report = pipeline.report();
  const auto names = [&](const auto& numbers) { return namesOf(numbers, pipeline.tools()); };
  std::vector<std::size_t> jaws_meet;
  for (std::size_t tool = 0; tool < report.tools.size(); ++tool) {
    if (report.tools[tool].jaws_overlap) jaws_meet.push_back(tool);
  }
  if (!jaws_meet.empty()) {
    remarks.push_back({Kind::kJawsMeet, "the jaws of " + names(jaws_meet) + " touch or overlap"});
  }
  std::string empty_jaws;
  for (std::size_t tool = 0; tool < report.tools.size(); ++tool) {
    const std::string& why = report.tools[tool].holds_nothing;
    if (why.empty()) continue;
    empty_jaws += (empty_jaws.empty() ? "" : "; ") + names(std::vector<std::size_t>{tool}) +
                  " holds nothing: " + why;
  }
  if (!empty_jaws.empty()) remarks.push_back({Kind::kHoldsNothing, empty_jaws});
}

void addOfBurrs(const Pipeline& pipeline, std::vector<StepRemark>& remarks) {
  const StepReport& report = pipeline.report();
  for (const std::string& load : report.lost_loads) {
    remarks.push_back({Kind::kDrills, "load '" + load + "' went with all its nodes"});
  }
  if (!report.would_take_all.empty()) {
    remarks.push_back({Kind::kDrills, namesOf(report.would_take_all, pipeline.tools()) +
                                          " would remove all of the tissue that is left: drills "
                                          "no more until it comes in anew"});
  }
}

// What a list of tools did, where it is not empty.
void addOfTools(const Pipeline& pipeline, std::vector<StepRemark>& remarks) {
  const StepReport& report = pipeline.report();
  const struct {
    const std::vector<std::size_t>& tools;
    Kind kind;
    const char* did;
  } all[] = {
      {report.were_inside, Kind::kInside, "appeared inside the tissue: walked in from outside"},
      {report.hooked, Kind::kHooked, "dragged tissue away that was hooked on it: let go of it"},
      {report.jammed, Kind::kJammed,
       "let go where no shape followed, as between tools that meet: walked in anew from outside"},
      {report.left, Kind::kTooFast, "left the tissue faster than could be followed: let go of it"},
      {report.torn_off, Kind::kTornOff,
       "lost the tissue: pulled harder than it holds (grasp.max_force)"},
      {report.torn_out, Kind::kTornOff,
       "tore out the tissue that it holds: pulled harder than that bears (grasp.max_force)"},
      {report.jumped, Kind::kTooFast, "jumped, farther than is followed: came in anew"},
  };
  for (const auto& some : all) {
    if (some.tools.empty()) continue;
    remarks.push_back({some.kind, namesOf(some.tools, pipeline.tools()) + " " + some.did});
  }
}

// Those behind; where all are at their poses, as on tissue that a load moved, those that touch it.
std::vector<std::size_t> unfollowed(const StepReport& report) {
  if (!report.behind.empty()) return report.behind;
  std::vector<std::size_t> touching;
  for (std::size_t tool = 0; tool < report.tools.size(); ++tool) {
    if (report.tools[tool].contacts > 0) touching.push_back(tool);
  }
  return touching;
}

void addOfFollowing(const Pipeline& pipeline, std::vector<StepRemark>& remarks) {
  const StepReport& report = pipeline.report();
  const std::vector<ToolGeometry>& tools = pipeline.tools();
  if (report.too_fast && (report.jumped.empty() || !report.behind.empty())) {
    remarks.push_back(
        {Kind::kTooFast, namesOf(report.behind, tools) +
                             " moved further than could be followed in time: catching up"});
  }
  if (report.lost) {
    remarks.push_back({Kind::kLost, "no shape follows " + namesOf(unfollowed(report), tools) +
                                        ", as between tools that meet: the last good one stays"});
  }
}

}  // namespace

std::string namesOf(const std::vector<std::size_t>& numbers,
                    const std::vector<ToolGeometry>& tools) {
  if (numbers.empty()) return "a tool";
  std::vector<std::string> names;
  for (const std::size_t number : numbers) names.push_back(tools[number].name);
  return listOf(names);
}

std::string remarkOnLaw(const Tissue& tissue) {
  if (tissue.cellsBeyondLaw() == 0) return "";
  return "cells are strained so far that law fung would overflow: there it goes on as a polynomial "
         "(doc/model.md); give less stiffening or strain";
}

std::string remarkOnAdrift(const Tissue& tissue) {
  const std::vector<std::string> names = tissue.adriftLoads();
  if (names.empty()) return "";
  return "the force of load " + listOf(names) +
         " moves tissue that nothing holds: it stays where it is; release the load, or hold the "
         "tissue";
}

std::vector<StepRemark> remarksOn(const Pipeline& pipeline) {
  std::vector<StepRemark> remarks;
  addOfTools(pipeline, remarks);
  addOfFollowing(pipeline, remarks);
  const std::string of_law = remarkOnLaw(pipeline.tissue());
  if (!of_law.empty()) remarks.push_back({Kind::kBeyondLaw, of_law});
  const std::string of_adrift = remarkOnAdrift(pipeline.tissue());
  if (!of_adrift.empty()) remarks.push_back({Kind::kAdrift, of_adrift});
  addOfJaws(pipeline, remarks);
  addOfBurrs(pipeline, remarks);
  return remarks;
}

}  // namespace robot_tissue
