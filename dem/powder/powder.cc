#include "dem/powder/powder.h"

#include <cmath>
#include <numeric>

#include "dem/powder/random.h"
#include "dem/powder/refuse.h"

namespace densify::dem {
namespace {

constexpr std::size_t fine_sample = 10000;  // particles that stand for a distribution's mean volume

std::size_t count_of(const PowderComponent& c, double powder_volume) {
  if (const auto* n = std::get_if<ParticleCount>(&c.amount)) return n->value;
  if (const auto* v = std::get_if<SolidVolume>(&c.amount)) return count_for_volume(c.sizes, v->value);
  return count_for_volume(c.sizes, std::get<VolumeFraction>(c.amount).value * powder_volume);
}

/// Solid volume of the whole powder from its total, or from the components that do not have a fraction [m^3].
double volume_of(const Powder& powder) {
  double fractions = 0, volume = 0, count_per_volume = 0;
  for (const PowderComponent& c : powder.components) {
    if (const auto* f = std::get_if<VolumeFraction>(&c.amount)) {
      if (!(f->value > 0 && f->value <= 1))
        refuse("the volume fraction of a powder component must lie above 0 and not above 1; it is ", f->value);
      fractions += f->value;
      count_per_volume += f->value * fine_sample / solid_volume(draw(c.sizes, fine_sample, 0));
    } else if (powder.total) {
      refuse("with the total of the powder given, its components need volume fractions; leave one of the two out");
    } else if (const auto* n = std::get_if<ParticleCount>(&c.amount)) {
      volume += solid_volume(draw(c.sizes, n->value, 0));
    } else {
      volume += std::get<SolidVolume>(c.amount).value;
    }
  }
  if (!powder.total) {
    if (fractions > 0 && volume == 0)
      refuse("volume fractions alone do not say how much powder there is; give the total, or one component's amount");
    if (!(fractions < 1))
      refuse("the volume fractions of the powder sum to ", fractions, " and leave nothing for the other components");
    return volume / (1 - fractions);
  }
  if (std::abs(fractions - 1) > 1e-6)
    refuse("the volume fractions of the powder must sum to 1; they sum to ", fractions);
  if (const auto* v = std::get_if<SolidVolume>(&*powder.total)) return v->value;
  const std::size_t count = std::get<ParticleCount>(*powder.total).value;
  if (count == 0) refuse("the powder is empty: the number of particles is zero");
  return double(count) / count_per_volume;
}

}  // namespace

PowderSample draw(const Powder& powder) {
  if (powder.components.empty()) refuse("the powder is empty: it has no components");
  const double volume = volume_of(powder);
  PowderSample all;
  for (const PowderComponent& c : powder.components) {
    const std::vector<double> d = draw(c.sizes, count_of(c, volume), powder.seed);
    all.diameter.insert(all.diameter.end(), d.begin(), d.end());
    all.material.insert(all.material.end(), d.size(), c.material);
  }
  std::vector<std::size_t> order(all.diameter.size());
  std::iota(order.begin(), order.end(), 0);
  Random(powder.seed).shuffle(order);
  PowderSample mixed;
  for (std::size_t k : order) {
    mixed.diameter.push_back(all.diameter[k]);
    mixed.material.push_back(all.material[k]);
  }
  return mixed;
}

std::vector<double> diameters_of(const PowderSample& sample, std::uint8_t material) {
  std::vector<double> d;
  for (std::size_t k = 0; k < sample.diameter.size(); ++k) {
    if (sample.material[k] == material) d.push_back(sample.diameter[k]);
  }
  return d;
}

}  // namespace densify::dem
