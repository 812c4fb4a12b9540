#include "fem/press/viscous_solid.h"

#include <Eigen/LU>
#include <cmath>

#include "fem/press/step_refused.h"

namespace densify::fem {

namespace {

constexpr int most_iterations = 30;
constexpr double tolerance = 1e-13;         // of the inelastic strain
constexpr double density_increment = 1e-6;  // for derivatives of the law by the density

/// The middle of a step: of the porosity, in its logarithm, which never lets a pore close in a step.
double middle_density(double before, double after) {
  return 1 - std::sqrt(std::max(1 - before, 0.0) * std::max(1 - after, 0.0));
}

/// How the density of the middle changes with ln(density) at the end.
double middle_slope(double before, double after) {
  return before < 1 && after < 1 ? 0.5 * std::sqrt((1 - before) / (1 - after)) * after : 0;
}

/// The law at the middle of the step, how it changes with the density there, and the stiffness at the end.
struct LawOverStep {
  PorousResponse middle, slope;
  Mat6 stiffness, stiffness_slope;

  LawOverStep(const PorousLaw& law, double density_before, double density, const PointStep& step) {
    const double density_middle = middle_density(density_before, density);
    const double temperature = 0.5 * (step.temperature_before + step.temperature);
    middle = law.response(density_middle, temperature);
    const PorousResponse below = law.response(density_middle - density_increment, temperature);
    slope.fluidity = (middle.fluidity - below.fluidity) / density_increment;
    slope.sintering_stress = (middle.sintering_stress - below.sintering_stress) / density_increment;
    stiffness = law.response(density, step.temperature).stiffness;
    stiffness_slope =
        (stiffness - law.response(density - density_increment, step.temperature).stiffness) / density_increment;
  }
};

void one_point(const PorousLaw& law, const PointStep& step, std::span<const double> before, std::span<double> after,
               PointAnswer& answer) {
  const Eigen::Map<const Vec6> elastic_before(before.data());
  const double density_before = before[6];
  const double thermal = law.thermal_strain(step.temperature) - law.thermal_strain(step.temperature_before);
  Vec6 trial = elastic_before + step.strain;
  trial.head<3>().array() -= thermal;

  Vec6 inelastic = Vec6::Zero();
  bool solved = false;
  // r(x) = x - dt M(rho_m) (C(rho) (trial - x) - sigma_s(rho_m)), rho = rho_0 exp(-tr x),
  // 1 - rho_m = sqrt((1 - rho_0) (1 - rho))
  for (int k = 0; k < most_iterations; ++k) {
    const double density = density_before * std::exp(-inelastic.head<3>().sum());
    const LawOverStep at(law, density_before, density, step);
    const Vec6 elastic = trial - inelastic;
    const Vec6 stress = at.stiffness * elastic;
    const Mat6 flow = step.step * at.middle.fluidity;
    const Vec6 drive = stress - at.middle.sintering_stress;
    const Vec6 stiffening = at.stiffness_slope * elastic;
    const Vec6 by_middle = step.step * (at.slope.fluidity * drive) - flow * at.slope.sintering_stress;
    Mat6 jacobian = Mat6::Identity() + flow * at.stiffness;
    jacobian.leftCols<3>().colwise() +=
        middle_slope(density_before, density) * by_middle + density * (flow * stiffening);
    if (solved) {  // one more look, for the tangent at the solution
      const Mat6 moved = jacobian.partialPivLu().solve(flow * at.stiffness);
      answer.tangent = at.stiffness * (Mat6::Identity() - moved);
      answer.tangent -= density * stiffening * moved.topRows<3>().colwise().sum();
      answer.stress = stress;
      answer.density = density;
      answer.stored = 0.5 * stress.dot(elastic);
      answer.dissipated = stress.dot(inelastic);
      answer.thermal = stress.head<3>().sum() * thermal;
      Eigen::Map<Vec6>(after.data()) = elastic;
      after[6] = density;
      return;
    }
    Vec6 change = jacobian.partialPivLu().solve(inelastic - flow * drive);
    const double volume = std::abs(change.head<3>().sum());
    if (!std::isfinite(change.sum())) break;
    if (volume > 0.1) change *= 0.1 / volume;  // a density within reach of the slope
    // No further towards full density than to a quarter of the porosity.
    const double closing = -change.head<3>().sum(), all = -inelastic.head<3>().sum();
    if (density < 1 && -closing > 0) {
      const double most = std::log((1 - 0.25 * (1 - density)) / density_before) - all;
      if (-closing > most) change *= most / -closing;
    }
    inelastic -= change;
    solved = volume <= 0.1 && change.norm() <= tolerance + 1e-12 * inelastic.norm();
  }
  throw StepRefused("the inelastic strain of a point is not found in " + std::to_string(most_iterations) +
                    " iterations");
}

}  // namespace

void ViscousSolid::begin(double density, std::span<double> state) const {
  std::fill(state.begin(), state.end(), 0.0);
  state[6] = density;
}

double ViscousSolid::solid_volume(std::span<const double> state, double temperature_at_start,
                                  double temperature) const {
  const double thermal = law_->thermal_strain(temperature) - law_->thermal_strain(temperature_at_start);
  return std::exp(state[0] + state[1] + state[2] + 3 * thermal);
}

void ViscousSolid::update(std::span<const PointStep> steps, std::span<const double> before, std::span<double> after,
                          std::span<PointAnswer> answers) const {
  for (std::size_t k = 0; k < steps.size(); ++k)
    one_point(*law_, steps[k], before.subspan(7 * k, 7), after.subspan(7 * k, 7), answers[k]);
}

}  // namespace densify::fem
