#include "base/bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace densify {

namespace {

/// Harmonic mean of modulus + shift, less the shift; zero when a phase gives way and nothing shifts.
double mean_with(std::span<const Phase> phases, double IsotropicModuli::*modulus, double shift) {
  double sum = 0;
  for (const Phase& p : phases)
    if (p.fraction > 0) sum += p.fraction / (p.moduli.*modulus + shift);
  return 1 / sum - shift;
}

IsotropicModuli with_reference(std::span<const Phase> phases, const IsotropicModuli& reference) {
  const auto [k, g] = reference;
  const double zeta = g > 0 ? g * (9 * k + 8 * g) / (6 * (k + 2 * g)) : 0;
  return {mean_with(phases, &IsotropicModuli::bulk, 4 * g / 3), mean_with(phases, &IsotropicModuli::shear, zeta)};
}

}  // namespace

YoungsBounds reuss_voigt(std::span<const Phase> phases) {
  double arithmetic = 0, compliance = 0;
  for (const Phase& p : phases) {
    if (!(p.fraction > 0)) continue;
    arithmetic += p.fraction * p.moduli.youngs();
    compliance += p.fraction / p.moduli.youngs();
  }
  return {1 / compliance, arithmetic};
}

ModuliBounds hashin_shtrikman(std::span<const Phase> phases) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  IsotropicModuli least{infinity, infinity}, most{0, 0};
  for (const Phase& p : phases) {
    DENSIFY_EXPECT(p.fraction >= 0 && p.moduli.bulk >= 0 && p.moduli.shear >= 0);
    if (!(p.fraction > 0)) continue;
    least = {std::min(least.bulk, p.moduli.bulk), std::min(least.shear, p.moduli.shear)};
    most = {std::max(most.bulk, p.moduli.bulk), std::max(most.shear, p.moduli.shear)};
  }
  return {with_reference(phases, least), with_reference(phases, most)};
}

IsotropicModuli dense_solid(std::span<const Phase> phases) {
  const ModuliBounds b = hashin_shtrikman(phases);
  return {0.5 * (b.lower.bulk + b.upper.bulk), 0.5 * (b.lower.shear + b.upper.shear)};
}

std::vector<Phase> with_pores(std::span<const Phase> phases, double relative_density) {
  std::vector<Phase> all(phases.begin(), phases.end());
  for (Phase& p : all) p.fraction *= relative_density;
  all.push_back({1 - relative_density, {0, 0}});
  return all;
}

}  // namespace densify
