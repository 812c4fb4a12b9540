#include "coupling/table_law.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace densify::coupling {

namespace {

constexpr double start_margin = 1e-3;  // a density below the first of the loose powder
constexpr double birth_margin = 0.02;  // between a point's birth and the nearest of the branches
constexpr double least_shear = 0.01;   // of the mean pressure, that the die holds by shear
constexpr double least_porosity = 1e-9;

}  // namespace

Mat6 yield_of(double axial, double lateral) {
  const double p = (axial + 2 * lateral) / 3, q = std::max(axial - lateral, least_shear * p);
  const double b2 = p * p + q * p / 1.5, a2 = 1.5 * q / p * b2;
  Mat6 y = Mat6::Zero();
  y.topLeftCorner<3, 3>().setConstant(1 / (9 * b2) - 0.5 / a2);
  for (int k = 0; k < 3; ++k) y(k, k) += 1.5 / a2, y(k + 3, k + 3) = 3 / a2;
  return y;
}

TableLaw::TableLaw(const ResponseTable& t, bool clamp)
    : cold_(cold_curve(t.cold)),
      youngs_modulus_(t.youngs_modulus),
      diffusion_(t.diffusion),
      reference_diffusion_(t.diffusion.effective(t.reference_temperature)),
      activation_(t.activation_temperature),
      expansion_(t.thermal_expansion),
      clamp_(clamp) {
  for (const SinteringBranch& b : t.sintering)
    if (b.path == "die") branches_.push_back({b.birth, b.nodes.back().density, sintering_curve(b.nodes, b.birth)});
  std::sort(branches_.begin(), branches_.end(), [](const Branch& a, const Branch& b) { return a.birth < b.birth; });
  if (branches_.empty()) throw InputError("the table has no branch of path \"die\"");
}

template <int N>
std::pair<Eigen::Matrix<double, N, 1>, double> TableLaw::necked(const fem::PorousState& s) const {
  const auto at = [&](const Branch& b) -> Eigen::Matrix<double, N, 1> {
    return b.curve.at<N>(std::log(s.density / s.birth) / std::log(b.end / s.birth));
  };
  if (s.birth <= branches_.front().birth) return {at(branches_.front()), branches_.front().end};
  if (s.birth >= branches_.back().birth) return {at(branches_.back()), branches_.back().end};
  const auto above =
      std::find_if(branches_.begin(), branches_.end(), [&](const Branch& b) { return b.birth > s.birth; });
  const Branch &high = *above, &low = *(above - 1);
  const double share = (s.birth - low.birth) / (high.birth - low.birth);
  return {(1 - share) * at(low) + share * at(high), std::lerp(low.end, high.end, share)};
}

fem::PorousFlow TableLaw::flow(const fem::PorousState& s) const {
  if (s.birth == 0) return {Mat6::Zero(), Vec6::Zero()};
  const auto [v, end] = necked<flow_rows>(s);
  const FlowValues n = flow_values(v);
  const double diffusion = diffusion_.effective(s.temperature) / reference_diffusion_;
  const double closing = std::min(1.0, std::max(1 - s.density, least_porosity) / (1 - end));
  fem::PorousFlow f;
  f.fluidity = diffusion * closing * inverse_tensor(n.viscosity);
  f.sintering_stress << n.sintering_stress[0], n.sintering_stress[0], n.sintering_stress[1], 0, 0, 0;
  return f;
}

fem::PorousStrength TableLaw::strength(const fem::PorousState& s) const {
  const double youngs = youngs_modulus_(s.temperature);
  if (s.birth > 0) return {youngs * full_tensor(stiffness_values(necked<strength_rows>(s).first))};
  const LooseValues n = loose_values(cold_.at<loose_rows>(std::log(s.density)));
  return {youngs * full_tensor(n.stiffness), yield_of(n.axial, n.lateral)};
}

std::pair<double, double> TableLaw::loose_pressures() const {
  const auto axial = [&](double x) { return loose_values(cold_.at<loose_rows>(x)).axial; };
  return {axial(cold_.lowest()), axial(cold_.highest())};
}

std::optional<double> TableLaw::presses_to(double pressure) const {
  const auto [least, most] = loose_pressures();
  if (!(pressure >= least && pressure <= most)) return {};
  constexpr int halvings = 60;
  double low = cold_.lowest(), high = cold_.highest();
  for (int n = 0; n < halvings; ++n) {
    const double middle = 0.5 * (low + high);
    (loose_values(cold_.at<loose_rows>(middle)).axial < pressure ? low : high) = middle;
  }
  return std::exp(low);
}

double TableLaw::thermal_strain(double temperature) const {
  return expansion_ * temperature;
}

std::string TableLaw::outside(const fem::PorousState& s) const {
  if (clamp_) return {};
  const auto sentence = [](const std::string& what, double value, double low, double high) {
    return fmt::format(
        "{} {:.4f} is outside the table, which holds from {:.4f} to {:.4f}; make a table of a wider range, or set "
        "press.table.extrapolate = \"clamp\"",
        what, value, low, high);
  };
  const double low = std::exp(cold_.lowest()), high = std::exp(cold_.highest());
  if (s.birth == 0)
    return s.density >= low - start_margin && s.density <= high
               ? ""
               : sentence("the relative density of the loose powder", s.density, low, high);
  const Branch &first = branches_.front(), &last = branches_.back();
  if (s.birth < first.birth - birth_margin || s.birth > last.birth + birth_margin)
    return sentence("the relative density at which necks begin", s.birth, first.birth - birth_margin,
                    last.birth + birth_margin);
  const double end = std::max(first.end, last.end);
  if (s.density > end) return sentence("the relative density", s.density, first.birth, end);
  return {};
}

}  // namespace densify::coupling
