#include "tissue/method_pair.h"

#include <utility>

#include "tissue/registry.h"

namespace robot_tissue {

MethodPair::MethodPair(const SolverConfig& config, const Body& body) : body_(body) { make(config); }

void MethodPair::switchAside() {
  is_aside_ = !is_aside_;
  if (!now_->remembers()) return;
  if (!other_) other_ = makeMethod(config_, body_.lattice(), body_.model());
  std::swap(now_, other_);
}

void MethodPair::forget() {
  other_.reset();
  now_->forget();
}

void MethodPair::drop() {
  other_.reset();
  now_.reset();
}

void MethodPair::make(const SolverConfig& config) {
  config_ = config;
  now_ = makeMethod(config, body_.lattice(), body_.model());
}

}  // namespace robot_tissue
