#pragma once
// The rate of a driven periodic cell among the unknowns of a step without inertia: components that a stress drives are
// found with the velocities of the particles, so that the stress at the end of the step is its goal.  An owner may
// strain the whole cell instead.

#include "dem/integrate/cell_answer.h"
#include "dem/state/cell.h"

namespace densify::dem {

struct Setup;
struct State;

class CellStep {
 public:
  /// For a step [s] to a process time `end` before or at the next breakpoint, from the present rates.  `mass` of the
  /// particles that resists a change of the rate [kg].
  void begin(const State&, const Setup&, double step, double end, double mass);
  /// For a step [s] of a cell that its owner strains.
  void begin(const State&, const CellStretch&, double step);

  const Mat3& gradient() const { return gradient_; }  ///< L over the step [1/s]
  void set_gradient(const Mat3& l) { gradient_ = l; }
  /// True when a stress drives a component.
  bool balances() const { return !free_.empty(); }
  /// True when the cell is another thing to the contacts than its present rate carried on.
  bool changes() const { return balances() || stretched_; }

  /// Begins the sums over the contacts at the end of a trial step; adds one with its force on i; ends them with the
  /// volume there [m^3].
  void clear(Eigen::Index rows);
  void add(const NetworkOperator&, const NetworkLink&, const Vec3& branch, const Vec3& force);
  void close(double volume);
  /// Largest |goal - stress| over the largest goal, or the mean stress that the contacts carry, all forces counted as
  /// positive, where that is larger.
  double off() const;

  /// Newton's step of the cell's rate and of the particles, given K^-1 r in `change` for r the forces on the particles;
  /// completes it.  Returns the number of iterations of conjugate gradients.
  int solve(const NetworkOperator&, Eigen::VectorXd& change);
  void advance(double factor) { gradient_ += factor * gradient_change_; }

  /// By how much the motion along each contact differs from that with the rate of before [m/s].
  double change_along(const LinkForce& link, const Vec3& normal) const {
    return normal.dot((gradient_ - before_) * link.branch);
  }

 private:
  bool stretched_ = false;
  Mat3 gradient_ = Mat3::Zero(), before_ = Mat3::Zero(), gradient_change_ = Mat3::Zero();
  std::vector<std::size_t> free_;       // components that a stress drives, by tensor_places
  std::vector<double> goal_;            // of these [Pa]
  double inertia_ = 0;                  // resists a change of their rates [J s]
  std::vector<Eigen::VectorXd> pull_;   // forces on the particles by a unit rate of each [N s]
  std::vector<Eigen::VectorXd> drawn_;  // the velocities that balance them [m]
  Eigen::MatrixXd own_;                 // power by unit rates of the cell alone [J s]
  Eigen::VectorXd resultant_;           // V (goal - stress) [J]
  double scale_ = 0;                    // sum |F.b|/3, or V |goal| [J]
};

}  // namespace densify::dem
