// The method that solves, and another of its kind that solves aside, so that trials teach the first
// one nothing.
#pragma once

#include <memory>

#include "robot_tissue/core/scene.h"
#include "solvers/solver_method.h"
#include "tissue/body.h"

namespace robot_tissue {

class MethodPair {
 public:
  // Throws InputError: unknown, or not for the body's model.
  MethodPair(const SolverConfig& config, const Body& body);

  SolverMethod& now() const { return *now_; }
  bool isAside() const { return is_aside_; }
  void switchAside();  // to the other one, or back
  void forget();       // what both learned
  // Both refer to the body's model: they are dropped before that goes, and made anew after it.
  void drop();
  void make(const SolverConfig& config);
  void setConfig(const SolverConfig& config) { config_ = config; }  // of those made from here on

 private:
  SolverConfig config_;
  const Body& body_;
  std::unique_ptr<SolverMethod> now_;
  std::unique_ptr<SolverMethod> other_;  // null: not needed so far
  bool is_aside_ = false;
};

}  // namespace robot_tissue
