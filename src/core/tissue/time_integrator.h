// How the tissue moves in time (doc/time.md). With h the length of a step, u, v, a displacement,
// velocity and acceleration of the nodes, f the cells' forces, a step is one of
//
// the generalized-alpha method without dissipation of its own at low frequencies and with all of it
// at high ones (Chung and Hulbert 1993; rho = 0, alpha_f = 0), which is the backward
// differentiation formula of second order in one-step form:
//
//   (2 m / h^2) (u' - u - h v) = f(u') + d + m g
//   a' = (u' - u - h v) / h^2 + a / 2,   v' = v - h a / 2 + 3 h a' / 2
//
// d damps, by damping_time times the rate of strain (material/viscosity.h), or, by methods that
// have no such damping, that of f: of the way to u' from u + h v / 3 - h^2 a / 6, times 3 / (2 h).
// The first step after a rest, or after a load came or went at once, takes
// a' = 2 (u' - u - h v) / h^2, v' = v + h a';
//
// Euler's backward method where tools or supports touch. A touch that comes or goes changes
// velocities at once; a formula of second order goes on with what was before, so that what is
// pushed runs ahead of its tool and meets it again. This one cannot: where E is convex, the energy
// never grows, whatever the lengths of the steps are.
//
//   (m / h^2) (u' - u - h v) = f(u') + d + m g + contacts,   d of the way from u, over h
//   v' = (u' - u) / h
//
// Both make an energy least (material/inertial_term.h).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "material/inertial_term.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

// Of the nodes, ghosts last, beside where they are.
struct NodeMotion {
  std::shared_ptr<const CellSet> cells;  // whose nodes they are
  std::vector<Vec3> velocity;            // m/s
  std::vector<Vec3> acceleration;        // m/s^2
  bool begins = true;                    // the acceleration is not known yet
  double next_duration = 0.0;            // longest good step from here on (s)
};

class TimeIntegrator {
 public:
  // Of a shape that is at rest.
  TimeIntegrator(double damping_time, double spacing, double tolerance)
      : damping_time_(damping_time), spacing_(spacing), tolerance_(tolerance) {}

  void setTolerance(double tolerance) { tolerance_ = tolerance; }

  using Motion = std::shared_ptr<const NodeMotion>;  // null: at rest
  bool moves() const { return motion_ != nullptr; }
  const Motion& motion() const { return motion_; }
  void take(Motion motion) { motion_ = std::move(motion); }
  void rest();
  // Something changed at once: the nodes have the velocities that they have, and new forces.
  void wake(const LatticeState& state);

  // How stiff nodes are in a step of that length (s) from the shape on.
  struct Stiffness {
    double elastic_scale = 1.0;  // of the cells' stiffness
    double per_mass = 0.0;       // 1/s^2
  };
  enum class Scheme { kGeneralizedAlpha, kBackwardEuler };
  // masses: kg, per node.
  void expect(double duration, Scheme scheme, const LatticeState& state,
              std::vector<double> masses);
  // Of the step expected last; of a node's mass alone (N/m).
  const Stiffness& stiffness() const { return stiffness_; }
  double inertia(int node) const { return stiffness_.per_mass * masses_[at(node)]; }

  // Forces of the cells in a shape (N), asked for where there is damping.
  using CellForces = std::function<std::vector<Vec3>(const LatticeState&)>;
  // What damps: the rate of strain, or that of all forces of the cells.
  enum class Damping { kOfStrain, kOfForces };
  // The term of the step that is expected, from the shape on.
  const InertialTerm& begin(const LatticeState& state, Damping damping,
                            const CellForces& cell_forces);
  // Where the step leads with the acceleration that there is: a first guess.
  Vec3 predicted(std::size_t node) const {
    return term_.free_motion[node] + 0.5 * duration_ * duration_ * motion_->acceleration[node];
  }
  // Of what nothing holds or touches, only gravity moves the center of mass (g: m/s^2): how far it
  // is off where the step would take it (m), as a solve that is not exact leaves it; and how much
  // farther the step takes it than it falls.
  Vec3 drift(const std::vector<int>& nodes, const LatticeState& state, const Vec3& gravity) const;
  Vec3 lead(const Vec3& gravity) const;
  // The step ended in that shape, and with these velocities (m/s) where the method has found them
  // itself; where nothing moves any more, the nodes are at rest.
  void end(const LatticeState& state, const std::vector<Vec3>* velocities);
  bool isRefused() const;  // it is to be made anew, shorter

  double longestStep() const;  // from here on (s)

 private:
  // Of the step, with h its length: per_mass h^2, and the factor of df/dt in f(u') - f(...), times
  // h.
  double massFactor() const { return scheme_ == Scheme::kBackwardEuler ? 1.0 : 2.0; }
  double rateFactor() const;
  std::vector<Vec3> rateFrom() const;  // displacements where the rate of f is taken from
  double leastWay() const;  // of all nodes together, below which a solve is exact enough (m)
  bool comesNowhere(const LatticeState& state);
  double negligibleWay(double displacement) const;
  double turnOf(const LatticeState& state) const;
  void judge(const LatticeState& state, NodeMotion& motion);

  double damping_time_, spacing_, tolerance_;
  Motion motion_;
  double duration_ = 0.0;                      // of the step under way, or expected (s)
  Scheme scheme_ = Scheme::kGeneralizedAlpha;  // likewise
  Stiffness stiffness_;                        // likewise
  std::vector<Vec3> before_;
  std::vector<double> masses_;
  InertialTerm term_;
  double error_ratio_ = 0.0;  // estimated error of the last step over the one allowed
  std::vector<Vec3> mark_;    // displacements some time ago
  double mark_age_ = 0.0;     // s
};

}  // namespace robot_tissue
