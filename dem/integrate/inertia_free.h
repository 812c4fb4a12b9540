#pragma once
// Time steps without inertia: the velocities of a step are those for which every particle's forces at its end balance.
// Sintering contacts are dashpots or Maxwell elements, loose contacts and bonds springs, which over a step h answer
// like a dashpot k h: backward Euler through the laws' own `update`.

#include "dem/boundary/walls.h"
#include "dem/integrate/cell_step.h"
#include "dem/network/network_operator.h"

namespace densify::dem {

struct Setup;
struct State;

enum class IntegrationMethod : std::uint8_t { leapfrog, inertia_free };
enum class InertiaFreeFrom : std::uint8_t {
  start,      ///< the whole process
  activation  ///< leap-frog until the first necks, then without inertia to the end
};

struct InertiaFreeSettings {
  InertiaFreeFrom from = InertiaFreeFrom::activation;
  double tangential_share = 0.003;  ///< f, resistance of a contact across its normal over that along it
  double mass_share = 1e-4;         ///< of mass_scaling, at least the real mass, that holds what no contact holds
  double step_tolerance = 2e-4;     ///< error of a contact's approach in one step over the mean radius
  double force_tolerance = 3e-3;  ///< unbalanced over contact force (Euclidean norms) at which a step counts as solved
  double fixed_step = unset;      ///< replaces the error control [s]
};

/// What it took since the simulation was made.
struct InertiaFreeCount {
  std::uint64_t steps = 0;
  std::uint64_t rejected = 0;    ///< trials that were too long
  std::uint64_t solutions = 0;   ///< linear systems
  std::uint64_t iterations = 0;  ///< of conjugate gradients, in all
};

class InertiaFree {
 public:
  /// From forces just evaluated at time t to positions at t + h: finds h <= `longest` [s] and the velocities, moves
  /// particles, walls and cell, and leaves the next proposal in State::stable_step.  The laws' histories follow in the
  /// next force pass.  `guided` is the load-controlled wall.  Returns h [s].
  ///
  /// Solved are sum_c (F_c n + f c_n v_t) + F_ext = M (v - e v_before)/h for each particle and sum F - p A likewise for
  /// the guided wall, and V (goal - stress) = 0 for each component of a cell that a stress drives, all at the end of
  /// the step, with F_c(v) what the law's `update` will give; by Newton's method with difference quotients of `update`
  /// and conjugate gradients.  M is a small share of the scaled mass: nothing in steps of ordinary length, it keeps a
  /// particle whose necks let go from being thrown as far as one likes in a short one, and forgets it within the
  /// time of its own swing.  h keeps (h/2) mean |v -
  /// v_before| of the contacts below step_tolerance x mean radius, which estimates backward Euler's error; a mean,
  /// because a contact that snaps moves at once however short the step is. Throws RunError when no step balances the
  /// forces.
  /// A `stretch` gives the rate of the cell and ends the step at the latest.
  double move(State&, const Setup&, const PairTable&, const PoreClosure&, std::optional<std::size_t> guided,
              double longest, const CellStretch* stretch);

  /// What the cell of a stretch answered in the step just moved.
  CellAnswer answer() const {
    return cell_answer(network_, forces_, cell_.gradient(), velocity_, cell_ahead_.volume());
  }
  /// How that changes with the rate of all the steps that ended with it, `whole` in all [s].  Once a step.
  CellTangent tangent(const State&, const Setup&, double whole);
  /// Of the particles against the cell in the last step [m/s].
  const Eigen::VectorXd& velocity() const { return velocity_; }
  /// Estimate of the last step's error: approach of a contact over the mean radius.
  double error() const { return error_; }
  const InertiaFreeCount& count() const { return count_; }
  std::size_t bytes() const;

 private:
  struct Trial;

  Trial prepare(const State&, const Setup&, const PairTable&, std::optional<std::size_t> guided, double step,
                const CellStretch*);
  double memory(const State&, const Setup&, double scaling) const;
  void look_ahead(const State&, const Trial&);
  /// `young`: share of a young neck's least resistance, falls from iterate to iterate.
  void respond(const State&, const Setup&, const Trial&, double young);
  bool balance(const State&, const Setup&, const Trial&);
  double error_estimate(const State&, const Trial&) const;
  void respond_over(const State&, const Setup&, double whole, double last);
  void apply(State&, const Trial&) const;

  NetworkOperator network_{0, std::nullopt};
  Particles ahead_;  // at the end of the step: bodies and materials
  Cell cell_ahead_;
  CellStep cell_;
  std::vector<LinkForce> forces_;  // of the links, at the end of the step
  Walls walls_ahead_;
  std::optional<PairTable> table_;  // at the end of the step
  PoreClosure pores_;               // at its end
  std::vector<double> growth_;      // relative, of each material over the step
  Eigen::VectorXd external_;        // forces from outside at the end of the step [N]
  Eigen::VectorXd inertia_;         // M/h of every row [N s/m]
  Eigen::VectorXd velocity_, before_, resultant_, change_;
  Eigen::VectorXd carried_;  // what is left of `before_` by the end of the step
  double force_scale_ = 0;   // norm of all contact forces [N]
  double error_ = 0;
  int crawling_ = 0;  // steps in a row that lead nowhere
  InertiaFreeCount count_;
};

}  // namespace densify::dem
