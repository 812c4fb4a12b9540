#pragma once
// What the finite elements ask of a material: stress at the end of a step for a strain over it, at many points at once.

#include <span>
#include <string>

#include "base/tensor.h"

namespace densify::fem {

/// One step of one point, in the frame that turns with the material.
struct PointStep {
  Vec6 strain;                ///< logarithmic strain of the step, thermal part included, engineering shears
  double step;                ///< [s]
  double temperature_before;  ///< [K]
  double temperature;         ///< at the end [K]
  double volume = 1;          ///< of the body at the point, before the step [m^3]
};

struct PointAnswer {
  Vec6 stress;            ///< Cauchy, at the end of the step, tension positive [Pa]
  Mat6 tangent;           ///< d stress/d strain [Pa]
  double density;         ///< relative, at the end
  double stored = 0;      ///< elastic energy at the end [J/m^3]
  double dissipated = 0;  ///< work of the step on the inelastic strain [J/m^3]
  double thermal = 0;     ///< work of the step on the thermal strain [J/m^3]
};

/// A material with a state of its own at every point.  A closed form, a response table and a live volume element are
/// three of them.
class PointMaterial {
 public:
  virtual ~PointMaterial() = default;

  /// Numbers of state at a point.
  virtual std::size_t state_size() const = 0;

  /// The states of the points at the start, free of stress where the material knows no other.  `density` relative.
  virtual void begin(double density, std::span<double> states) const = 0;

  /// Relative density of a state.
  virtual double density(std::span<const double> state) const = 0;

  /// Volume of the solid of a state over that of the same solid unstressed at the start of the process.  `temperature`s
  /// [K].
  virtual double solid_volume(std::span<const double> state, double temperature_at_start, double temperature) const = 0;

  /// The step of each point from `before` to `after` (state_size() numbers a point, in order).  Does not change
  /// `before`, so that a step can be tried again.  Throws StepRefused when a point cannot take the step.
  virtual void update(std::span<const PointStep> steps, std::span<const double> before, std::span<double> after,
                      std::span<PointAnswer> answers) const = 0;

  /// Why the material does not hold for the state of a point at a temperature [K], a sentence; empty where it does.
  virtual std::string outside(std::span<const double> /*state*/, double /*temperature*/) const { return {}; }

  /// True when answers are those of affine laws that stand over a solution of the body, made by begin_step() and
  /// settle().
  virtual bool affine() const { return false; }
  /// Before the first update() of a step that is tried from the accepted state, with a guess of it.  Collective.
  /// Throws StepRefused on all ranks.
  virtual void begin_step(std::span<const PointStep> /*guess*/) {}
  /// The body balances with these steps.  False: the laws have changed, it is to be balanced again.  Collective.
  /// Throws StepRefused on all ranks.
  virtual bool settle(std::span<const PointStep>) { return true; }
  /// The step tried last stands.
  virtual void accept() {}
  /// ln(density) of a step below which differences mean nothing: what laws that stand loosely leave open.  Collective.
  virtual double resolution() const { return 0; }
};

}  // namespace densify::fem
