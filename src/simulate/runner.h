// The steps of a scene, one after the other, on one Pipeline.
#pragma once

#include <set>
#include <string>

#include "robot_tissue/pipeline/pipeline.h"
#include "run_scene.h"
#include "tool_places.h"

namespace robot_tissue {

class Runner {
 public:
  // `state_folder`: where states are that no step has saved.
  Runner(const Scene& scene, const OnRow& on_row, const OnStep& on_step, const Deadline& deadline,
         const std::string& state_folder);
  RunResult run();

 private:
  struct TimeIsOver {};
  // Of a step's entry: the text begins with the entry's key.
  struct EntryError : InputError {
    using InputError::InputError;
  };
  // A tool's way from pose to pose, straight and in equal load steps.
  struct Way {
    std::size_t tool = 0;
    MoveStep::Place from;
    MoveStep::Place to;
    double begin = 0.0;     // s
    double duration = 0.0;  // s; 0: no time goes by
    int steps = 1;
    int gone = 0;  // load steps that were walked
    bool is_given_up = false;
    bool ends_free = false;  // given up, but its end was reached past the tissue
  };
  // Whether there were updates of the tools since the last row, the worst status of them, and the
  // time of their solves.
  struct Updates {
    bool any = false;
    SolveStatus worst = SolveStatus::kOk;
    double solve_ms = 0.0;
  };

  // runner.cpp
  void perform(const SettleStep& step);
  void perform(const LoadStep& step);
  void perform(const ReleaseStep& step);
  void perform(const ResetStep& step);
  void layDown(const Step& next);
  void performAll();
  std::string ofStep(const std::string& text) const;
  void remark(const std::string& text);
  void remarkTorn(int before);
  void remarkImpatience();
  void keep(SolveReport report, int increment = 1, int increments = 1);
  void keepTool(std::size_t tool, int increment);
  void keepShape();

  // surgery_steps.cpp
  void perform(const CutStep& step);
  void perform(const RemoveStep& step);
  void perform(const UndoStep& step);
  void keepPieces(int increment);
  void remarkDropped(std::size_t before);
  std::set<std::string> standingLoads() const;
  void noteLost(const std::set<std::string>& before);
  std::vector<std::string> stillStanding(const std::vector<std::string>& names);

  // suture_steps.cpp
  void perform(const SutureStep& step);
  void keepSutures(int increment);

  // state_steps.cpp
  void perform(const SaveStep& step);
  void perform(const LoadStateStep& step);
  SolveReport loaded(const std::string& file);

  // tool_steps.cpp
  void perform(const MoveStep& step);
  void perform(const WaitStep& step);
  void perform(const PushStep& step);
  void perform(const GraspStep& step);
  void appear(std::size_t tool, const MoveStep::Place& place);
  void moveInTime(const Way& way, int increments);
  int loadSteps(double steps) const;
  void walkTo(Way& way, double share);
  void giveUp(Way& way, int gone);
  bool isFreeInBalance() const;
  void place(const Way& way, double share);
  void endPush(std::size_t tool);
  void follow();
  void followPushes();
  void catchUp();
  void update();
  void remarkHolds();
  void remarkCut(std::size_t tool);
  void judgePush(std::size_t tool);

  const Scene& scene_;
  const bool parts_tissue_;
  const OnRow& on_row_;
  const OnStep& on_step_;
  const Deadline& deadline_;
  const std::string& state_folder_;
  ToolPlaces tools_;
  Pipeline pipeline_;
  std::vector<std::optional<Vec3>> pushes_;  // per tool, on the tissue (N)
  // Per tool: which remark tells of its push that was not met in this step.
  std::vector<std::optional<std::size_t>> unmet_;
  Updates updates_;
  std::set<std::string> broken_sutures_;  // that a remark was made of
  std::set<std::string> lost_loads_;      // that went with their nodes
  double contact_ms_ = 0.0;               // of the tools' updates since the last row
  int springs_cut_ = 0;                   // by blades, since their move began
  double area_cut_ = 0.0;                 // likewise (m^2)
  double volume_removed_ = 0.0;           // by burrs, likewise (m^3)
  double time_ = 0.0;                     // that went by (s)
  RunResult result_;
  int step_ = 0;
  bool is_cut_short_ = false;  // the way of a tool, as the time is over
};

}  // namespace robot_tissue
