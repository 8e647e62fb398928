// How a tool's wrench follows its pose between two solves, for loops that are faster than a solve:
//
//   w(x) = w0 + K (x - x0)
//
// from the last solved pose x0 and wrench w0, with the contact's stiffness K as the last solves
// show it. Each step s teaches its change of the wrench, r beyond K s, by recursive least squares
// (a Kalman filter whose state is K, the same for each row of it; Kalman 1960):
//
//   P += q^2 |s| I,   g = P s / (s^T P s + 2 e^2),   K += r g^T,   P -= g (P s)^T
//
// e is how exact a solved wrench is, q how much the stiffness changes on its way: both in shares of
// the wrench, or of its change where that is greater. So a step far longer than the noise counts as
// it is, and what wanders with the touches is smoothed. Along ways that the tool has not gone K is
// none.
#pragma once

#include <Eigen/Core>

#include "robot_tissue/core/types.h"
#include "robot_tissue/pipeline/step_report.h"

namespace robot_tissue {

// Of the tissue on a tool, about the tool's origin, tissue frame.
struct ToolWrench {
  Vec3 force = Vec3::Zero();   // N
  Vec3 torque = Vec3::Zero();  // N m
};

class WrenchPrediction {
 public:
  // The way of a point so far from the tool's origin (m) is what a turn counts: the tool's reach.
  // A wrench whose force is greater than max_force (N; 0: any may be) is told with that force.
  explicit WrenchPrediction(double arm, double max_force = 0.0);

  // What a solve told at that pose (tissue_T_tool), in full.
  void learn(const Pose& pose, const ToolWrench& solved);
  // The same of a report, with the pose that the tool reached. A force that drives the tool took it
  // there from its own pose, and that is the one that wrenches are asked for at.
  void learnFrom(const Pose& reached, const ToolReport& report);
  // The tissue is another one, or the tool came from elsewhere.
  void forget();
  // Something else than the tool's way changes the wrench, as a cut: the next change of it teaches
  // nothing.
  void skipNextChange() { is_of_way_ = false; }

  // At a pose near the last one solved for; farther off, as at the farthest place on the way there
  // that still counts. A tool that touched nothing feels nothing, and none is pulled.
  ToolWrench at(const Pose& pose) const;
  // Whether a solve so long ago (s) still foretells that pose. Later, or farther off, the tissue
  // may have been touched, or left, since.
  bool foretells(const Pose& pose, double age_s) const;

 private:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;

  void learnStep(const Vec6& step, const Vec6& change);
  // Of the pose from another one, and of a wrench: ways in m, forces in N.
  Vec6 wayFrom(const Pose& from, const Pose& to) const;
  Vec6 stacked(const ToolWrench& wrench) const;

  double arm_, max_force_;
  bool touches_ = false;
  bool is_of_way_ = true;  // the next change of the wrench
  Pose pose_ = Pose::Identity();
  Vec6 wrench_ = Vec6::Zero();
  Mat6 stiffness_ = Mat6::Zero();   // K (N/m)
  Mat6 covariance_ = Mat6::Zero();  // P ((N/m)^2)
};

}  // namespace robot_tissue
