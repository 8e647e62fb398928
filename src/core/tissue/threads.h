// The threads of the tissue's sutures, and the ties of its cuts' fronts. To a solve they are one
// loading patch without nodes, whose contacts they are.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "loads/suture_thread.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/surface.h"

namespace robot_tissue {

class Threads {
 public:
  const std::vector<SutureThread>& all() const { return threads_; }
  bool anyWhole() const;
  bool has(const std::string& name) const;
  void add(SutureThread thread) { threads_.push_back(std::move(thread)); }
  void take(std::vector<SutureThread> threads) { threads_ = std::move(threads); }
  void clear() { threads_.clear(); }
  // Those that are not broken, by name; and makes threads of these names whole again.
  std::vector<std::string> whole() const;
  void mend(const std::vector<std::string>& names);

  // What holds the fronts of cuts together acts as threads without length do.
  void tie(std::vector<ContactSpring> fronts) { fronts_ = std::move(fronts); }
  // The whole threads and the ties of fronts; of the latter none where no thread is and no cut
  // ends.
  LoadingPatch patch() const;
  bool act() const { return !fronts_.empty() || anyWhole(); }
  Vec3 forceOn(int node, const std::vector<Vec3>& displacement) const;  // of all of these (N)
  std::vector<int> nodes() const;                                       // of whole threads
  // Whole threads act with their present length where that is more than their rest length; then
  // go a share of the way to that. How much is left of the longest way (m).
  void loosen(const std::vector<Vec3>& displacement);
  void drawIn(double share);
  double wayLeft() const;
  // Threads stiffer than that (N/m) act with it, as hard as they pull now, until `harden`: then all
  // have their own stiffness and their rest length, and it tells whether one that was soft pulls.
  // In between, `correct` adds to the way of each what its pull would stretch it by less with
  // these, so that it comes to pull as hard, and tells the greatest change of one (m).
  void soften(const std::function<double(int node)>& stiffness,
              const std::vector<Vec3>& displacement);
  bool harden(const std::vector<Vec3>& displacement);
  double correct(const std::vector<Vec3>& displacement);
  // A thread is over its break force.
  bool isOneOver(const std::vector<Vec3>& displacement) const;
  // Breaks the thread that is farthest over its break force. The nodes that it was on; none: no
  // thread is over.
  std::vector<int> breakOne(const std::vector<Vec3>& displacement);
  // On another surface of the same tissue: ends stay at their material points. A thread with an end
  // whose tissue is gone is dropped; the nodes of the lattice that it was on.
  std::vector<int> rebind(const TissueSurface& surface, double spacing);

 private:
  std::optional<std::size_t> weakest(const std::vector<Vec3>& displacement) const;

  std::vector<SutureThread> threads_;
  std::vector<ContactSpring> fronts_;
};

// Binds the end to what carries its place on the surface at rest. False: the surface is too far
// from there.
bool bindEnd(const TissueSurface& surface, double spacing, double bite, SutureThread::End& end);

}  // namespace robot_tissue
