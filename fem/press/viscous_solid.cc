#include "fem/press/viscous_solid.h"

#include <Eigen/LU>
#include <cmath>

#include "fem/press/step_refused.h"

namespace densify::fem {

namespace {

constexpr int most_iterations = 30;
constexpr double sliding = 100;              // strain for a stress that is twice what yields
constexpr int guesses = 5;                   // of how far grains slide
constexpr int most_parts = 64;               // of the strain of a step
constexpr double tolerance = 1e-13;          // of the inelastic strain
constexpr double sliding_tolerance = 1e-11;  // `sliding` times what rounding leaves of a stress
constexpr double density_increment = 1e-6;   // for derivatives of the law by the density

/// The middle of a step: of the porosity, in its logarithm, which never lets a pore close in a step.
double middle_density(double before, double after) {
  return 1 - std::sqrt(std::max(1 - before, 0.0) * std::max(1 - after, 0.0));
}

/// How the density of the middle changes with ln(density) at the end.
double middle_slope(double before, double after) {
  return before < 1 && after < 1 ? 0.5 * std::sqrt((1 - before) / (1 - after)) * after : 0;
}

/// The flow at the middle of the step, the strength at its end, and how they change with the density there.
struct LawOverStep {
  PorousFlow flow, flow_slope;
  PorousStrength strength, strength_slope;

  LawOverStep(const PorousLaw& law, double density_before, double density, double birth, const PointStep& step) {
    PorousState middle{middle_density(density_before, density), 0.5 * (step.temperature_before + step.temperature),
                       birth};
    flow = law.flow(middle);
    middle.density -= density_increment;
    const PorousFlow below = law.flow(middle);
    flow_slope = {(flow.fluidity - below.fluidity) / density_increment,
                  (flow.sintering_stress - below.sintering_stress) / density_increment};
    PorousState end{density, step.temperature, birth};
    strength = law.strength(end);
    end.density -= density_increment;
    const PorousStrength softer = law.strength(end);
    strength_slope = {(strength.stiffness - softer.stiffness) / density_increment,
                      (strength.yield - softer.yield) / density_increment};
  }
};

/// q = sqrt(stress : yield : stress), and the direction m = Y0 dq/dstress in which grains slide, Y0 the axial stress
/// that yields alone.
struct Sliding {
  double q = 0;
  Vec6 direction = Vec6::Zero(), q_by_stress = Vec6::Zero();
  Mat6 by_stress = Mat6::Zero();  // of the direction
  Vec6 by_density = Vec6::Zero();
  double q_by_density = 0;

  Sliding(const PorousStrength& at, const PorousStrength& slope, const Vec6& stress) {
    if (at.yield(2, 2) == 0) return;
    const Vec6 y = at.yield * stress, changed = slope.yield * stress;
    q = std::sqrt(stress.dot(y));
    if (!(q > 0)) return;
    const double alone = 1 / std::sqrt(at.yield(2, 2));
    q_by_stress = y / q;
    q_by_density = stress.dot(changed) / (2 * q);
    direction = alone * q_by_stress;
    by_stress = alone / q * (at.yield - q_by_stress * q_by_stress.transpose());
    by_density =
        alone / q * (changed - q_by_density * q_by_stress) - 0.5 * slope.yield(2, 2) / at.yield(2, 2) * direction;
  }
};

/// The density at which necks begin, for a step that may pass the temperature of their activation.
double birth_in(const PorousLaw& law, std::span<const double> before, const PointStep& step) {
  const bool active = 0.5 * (step.temperature_before + step.temperature) >= law.activation_temperature();
  return before[7] == 0 && active ? before[6] : before[7];
}

using Vec7 = Eigen::Matrix<double, 7, 1>;
using Mat7 = Eigen::Matrix<double, 7, 7>;

/// One step of one point: Newton's method for the inelastic strain x and the length m of what grains slide,
///   x = dt M(rho_m) (sigma - sigma_s(rho_m)) + m direction(sigma, rho), sigma = C(rho) (trial - x),
///   q(sigma, rho) - 1 = m/sliding where they slide, m = 0 where not,
/// rho = rho_0 exp(-tr x), 1 - rho_m = sqrt((1 - rho_0) (1 - rho)).
class PointUpdate {
 public:
  PointUpdate(const PorousLaw& law, const PointStep& step, std::span<const double> before)
      : law_(law), step_(step), density_before_(before[6]), birth_(birth_in(law, before, step)), start_(before.data()) {
    thermal_ = law.thermal_strain(step.temperature) - law.thermal_strain(step.temperature_before);
  }

  void solve(std::span<double> after, PointAnswer& answer) {
    // Grains that are to slide far may need a guess from a part of the strain.
    int parts = 1;
    while (!follow(parts)) {
      parts *= 8;
      if (!slides_ || parts > most_parts)
        throw StepRefused("the inelastic strain of a point is not found in " + std::to_string(most_iterations) +
                          " iterations");
    }
    answer = answer_;
    Eigen::Map<Vec6>(after.data()) = trial_ - x_.head<6>();
    after[6] = answer.density;
    after[7] = birth_;
  }

 private:
  /// Whether the solution was found with the strain in so many parts, each beginning where the one before ended.
  bool follow(int parts) {
    x_.setZero();
    slides_ = false;
    Vec6 strain = step_.strain;
    strain.head<3>().array() -= thermal_;
    for (int k = 1; k <= parts; ++k) {
      trial_ = start_ + double(k) / parts * strain;
      const Vec7 before = x_;
      x_[6] = 0;
      if (!iterate(false)) return false;
      if (!(q_ > 1)) continue;
      slides_ = true;
      if (before[6] > 0)
        x_ = before;
      else
        guess_sliding();
      if (!iterate(true)) return false;
    }
    return true;
  }

  /// Slides from the strain found without it to where q = 1 by the law as it is there: stress(l) = (I + l C Y)^-1
  /// stress, where 1/q is nearly linear in l.
  void guess_sliding() {
    const double density = density_before_ * std::exp(-x_.head<3>().sum());
    const PorousStrength at = law_.strength({density, step_.temperature, birth_});
    const Mat6 turned = at.stiffness * at.yield;
    const Vec6 first = at.stiffness * (trial_ - x_.head<6>());
    Vec6 stress = first;
    double l = 0;
    for (int k = 0; k < guesses; ++k) {
      const Eigen::PartialPivLU<Mat6> lu(Mat6::Identity() + l * turned);
      stress = lu.solve(first);
      const Vec6 y = at.yield * stress;
      const double q = std::sqrt(stress.dot(y)), slope = -y.dot(lu.solve(turned * stress)) / q;
      l = std::max(0.0, l + (1 / q - 1) * q * q / slope);
    }
    x_.head<6>() += l * (at.yield * stress);
    x_[6] = l * std::sqrt(at.yield(2, 2));
  }

  bool iterate(bool slides);

  const PorousLaw& law_;
  const PointStep& step_;
  const double density_before_, birth_;
  const Eigen::Map<const Vec6> start_;  // elastic strain before
  double thermal_, q_ = 0;
  bool slides_ = false;
  Vec6 trial_;
  Vec7 x_ = Vec7::Zero();
  PointAnswer answer_{};
};

bool PointUpdate::iterate(bool slides) {
  bool solved = false;
  for (int k = 0; k < most_iterations; ++k) {
    const Vec6 inelastic = x_.head<6>();
    const double density = density_before_ * std::exp(-inelastic.head<3>().sum());
    const LawOverStep at(law_, density_before_, density, birth_, step_);
    const Vec6 elastic = trial_ - inelastic;
    const Vec6 stress = at.strength.stiffness * elastic;
    const Vec6 stiffening = at.strength_slope.stiffness * elastic;
    const Mat6 flow = step_.step * at.flow.fluidity;
    const Vec6 drive = stress - at.flow.sintering_stress;
    const Sliding slide(at.strength, at.strength_slope, stress);
    q_ = slide.q;
    // By stress and by density, of the right side of x.
    const Mat6 by_stress = flow + x_[6] * slide.by_stress;
    const Vec6 by_middle = step_.step * (at.flow_slope.fluidity * drive) - flow * at.flow_slope.sintering_stress;
    const Vec6 by_density = by_stress * stiffening + x_[6] * slide.by_density;
    Mat7 jacobian = Mat7::Identity();
    Vec7 residual = x_;
    Eigen::Matrix<double, 7, 6> by_trial;
    residual.head<6>() -= flow * drive + x_[6] * slide.direction;
    jacobian.topLeftCorner<6, 6>() += by_stress * at.strength.stiffness;
    jacobian.topLeftCorner<6, 3>().colwise() +=
        middle_slope(density_before_, density) * by_middle + density * by_density;
    by_trial.topRows<6>() = by_stress * at.strength.stiffness;
    by_trial.row(6).setZero();
    if (slides) {
      jacobian.topRightCorner<6, 1>() -= slide.direction;
      const Vec6 q_by_strain = at.strength.stiffness * slide.q_by_stress;
      residual[6] = x_[6] / sliding - (slide.q - 1);
      jacobian(6, 6) = 1 / sliding;
      jacobian.bottomLeftCorner<1, 6>() = q_by_strain.transpose();
      jacobian.bottomLeftCorner<1, 3>().array() += density * (slide.q_by_density + slide.q_by_stress.dot(stiffening));
      by_trial.row(6) = q_by_strain.transpose();
    }
    if (solved) {  // one more look, for the tangent at the solution
      const Mat6 moved = slides ? Mat6(jacobian.partialPivLu().solve(by_trial).topRows<6>())
                                : Mat6(jacobian.topLeftCorner<6, 6>().partialPivLu().solve(by_trial.topRows<6>()));
      answer_.tangent = at.strength.stiffness * (Mat6::Identity() - moved);
      answer_.tangent -= density * stiffening * moved.topRows<3>().colwise().sum();
      answer_.stress = stress;
      answer_.density = density;
      answer_.stored = 0.5 * stress.dot(elastic);
      answer_.dissipated = stress.dot(inelastic);
      answer_.thermal = stress.head<3>().sum() * thermal_;
      return true;
    }
    Vec7 change = Vec7::Zero();
    if (slides)
      change = jacobian.partialPivLu().solve(residual);
    else
      change.head<6>() = jacobian.topLeftCorner<6, 6>().partialPivLu().solve(residual.head<6>());
    const double volume = std::abs(change.head<3>().sum());
    if (!std::isfinite(change.sum())) break;
    if (volume > 0.1) change *= 0.1 / volume;  // a density within reach of the slope
    // No further towards full density than to a quarter of the porosity.
    const double closing = -change.head<3>().sum(), all = -inelastic.head<3>().sum();
    if (density < 1 && -closing > 0) {
      const double most = std::log((1 - 0.25 * (1 - density)) / density_before_) - all;
      if (-closing > most) change *= most / -closing;
    }
    x_ -= change;
    solved = volume <= 0.1 && change.norm() <= (slides ? sliding_tolerance : tolerance) + 1e-12 * x_.norm();
  }
  return false;
}

}  // namespace

void ViscousSolid::begin(double density, std::span<double> states) const {
  std::fill(states.begin(), states.end(), 0.0);  // no necks: states[7] is 0
  for (std::size_t k = 6; k < states.size(); k += 8) states[k] = density;
}

double ViscousSolid::solid_volume(std::span<const double> state, double temperature_at_start,
                                  double temperature) const {
  const double thermal = law_->thermal_strain(temperature) - law_->thermal_strain(temperature_at_start);
  return std::exp(state[0] + state[1] + state[2] + 3 * thermal);
}

void ViscousSolid::update(std::span<const PointStep> steps, std::span<const double> before, std::span<double> after,
                          std::span<PointAnswer> answers) const {
  for (std::size_t k = 0; k < steps.size(); ++k)
    PointUpdate(*law_, steps[k], before.subspan(8 * k, 8)).solve(after.subspan(8 * k, 8), answers[k]);
}

std::string ViscousSolid::outside(std::span<const double> state, double temperature) const {
  return law_->outside({state[6], temperature, state[7]});
}

}  // namespace densify::fem
