// [[powder]]: materials, sizes and amounts.

#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/quantity.h"
#include "dem/io/scene_parts.h"

namespace densify::dem {
namespace {

enum class Sizes { lognormal, histogram, list };

TruncatedLognormal read_lognormal(Section& section) {
  TruncatedLognormal s{unset, unset, unset, unset};
  section.quantity("mean", s.mean, dim::length, Range::positive(), Need::required,
                   "lognormal: mean of the diameters after the cut");
  section.quantity("standard_deviation", s.standard_deviation, dim::length, Range::positive(), Need::required,
                   "lognormal: standard deviation of the diameters after the cut");
  section.quantity("minimum", s.minimum, dim::length, Range::positive(), Need::required, "lognormal: least diameter");
  section.quantity("maximum", s.maximum, dim::length, Range::positive(), Need::required, "lognormal: largest diameter");
  return s;
}

SizeHistogram read_histogram(Section& section) {
  SizeHistogram s{{}, {}, HistogramWeight::number};
  section.quantity_list("edges", s.edges, dim::length, Range::positive(), Need::required,
                        "histogram: edges of the bins of diameter, ascending");
  section.quantity_list("weights", s.weights, dim::none, Range::non_negative(), Need::required,
                        "histogram: share of each bin, one fewer than edges, on any scale");
  section.choice("weighted_by", s.weighted_by,
                 {{"number", HistogramWeight::number}, {"volume", HistogramWeight::volume}}, Need::optional,
                 "histogram: what the weights are shares of");
  return s;
}

SizeList read_list(Section& section) {
  SizeList s;
  section.quantity_list("diameters", s.diameters, dim::length, Range::positive(), Need::required,
                        "list: diameters, drawn in the proportions of the list");
  return s;
}

SizeDistribution read_sizes(Section& section) {
  Sizes kind = Sizes::lognormal;
  section.choice("sizes", kind,
                 {{"lognormal", Sizes::lognormal}, {"histogram", Sizes::histogram}, {"list", Sizes::list}},
                 Need::required, "how the diameters are given");
  SizeDistribution sizes;
  const auto read_if = [&](Sizes what, const auto& read, std::initializer_list<std::string_view> keys,
                           std::string_view name) {
    if (kind == what || section.documenting()) {
      sizes = read(section);
    } else {
      refuse_keys(section, keys, std::string("belongs to sizes = \"").append(name).append("\"; remove it"));
    }
  };
  read_if(Sizes::histogram, read_histogram, {"edges", "weights", "weighted_by"}, "histogram");
  read_if(Sizes::list, read_list, {"diameters"}, "list");
  read_if(Sizes::lognormal, read_lognormal, {"mean", "standard_deviation", "minimum", "maximum"}, "lognormal");
  if (section.documenting()) return sizes;
  try {
    draw(sizes, 1, 0);
  } catch (const InputError& e) {
    section.fail("sizes", e.what());
  }
  return sizes;
}

ParticleCount read_count(Section& section, std::string_view meaning) {
  std::uint64_t number = 1;
  section.integer("number", number, 1, 1000000000, Need::required, meaning);
  return {number};
}

SolidVolume read_solid_volume(Section& section, std::string_view meaning) {
  SolidVolume volume{unset};
  section.quantity("solid_volume", volume.value, dim::volume, Range::positive(), Need::required, meaning);
  return volume;
}

PowderComponent read_component(Section& section, const Scene& scene) {
  std::string material;
  section.text("material", material, Need::required, "one of [materials]");
  PowderComponent component{0, read_sizes(section), ParticleCount{1}};
  const bool documenting = section.documenting();
  if (!documenting) component.material = material_index(section, "material", material, scene);

  const std::string_view amount = require_one(section, {"number", "solid_volume", "volume_fraction"});
  if (documenting || amount == "number") {
    component.amount = read_count(section, "how many particles; give one of number, solid_volume, volume_fraction");
  }
  if (documenting || amount == "solid_volume") {
    component.amount = read_solid_volume(section, "volume of the particles without pores");
  }
  if (documenting || amount == "volume_fraction") {
    constexpr Range share{0.0, 1.0, Bound::exclusive, Bound::inclusive};
    VolumeFraction fraction{unset};
    section.quantity("volume_fraction", fraction.value, dim::none, share, Need::required,
                     "share of the solid volume of the whole powder");
    component.amount = fraction;
  }
  return component;
}

// The total of a powder and the fractions of its components make sense only together.
void check_amounts(const Powder& powder, const Section& root, const ScenePlaces& places) {
  double fractions = 0;
  bool others = false;
  for (std::size_t k = 0; k < powder.components.size(); ++k) {
    const auto* fraction = std::get_if<VolumeFraction>(&powder.components[k].amount);
    if (fraction) fractions += fraction->value;
    others = others || !fraction;
    if (!fraction && powder.total) {
      places.powders[k].fail("", "gives an amount of its own besides [powder_total]; give its volume_fraction instead");
    }
  }
  const std::string sum = format_quantity(fractions, dim::none);
  constexpr double rounding = 1e-6;
  if (powder.total && std::abs(fractions - 1) > rounding) {
    root.fail("powder_total", "the volume fractions of the powder sum to " + sum + " and must sum to 1");
  }
  if (powder.total) return;
  if (!others) {
    root.fail("powder",
              "volume fractions alone do not say how much powder there is; add [powder_total] with a number "
              "or a solid_volume, or give one component a number");
  }
  if (fractions >= 1) {
    root.fail("powder", "the volume fractions sum to " + sum + " and leave nothing for the other components");
  }
}

}  // namespace

void read_powder(Section& root, Scene& scene, ScenePlaces& places) {
  Powder powder{{}, {}, 1};
  root.list("powder", Need::optional, "components of the powder; or [specimen.import] instead",
            [&](Section& section, std::size_t) {
              powder.components.push_back(read_component(section, scene));
              places.powders.push_back(section);
            });
  if (powder.components.empty() && root.has("powder")) root.fail("powder", "the powder is empty; give a [[powder]]");
  root.section("powder_total", Need::optional, "amount of the whole powder, for components with volume fractions",
               [&](Section& section) {
                 const std::string_view amount = require_one(section, {"number", "solid_volume"});
                 if (amount == "number") powder.total = read_count(section, "how many particles");
                 if (section.documenting() || amount == "solid_volume") {
                   powder.total = read_solid_volume(section, "volume of the particles without pores");
                 }
               });
  if (powder.components.empty() && powder.total && !root.documenting()) {
    root.fail("powder_total", "there is no [[powder]] to which it could apply; add one, or remove this section");
  }
  if (powder.components.empty()) return;
  if (!root.documenting()) check_amounts(powder, root, places);
  scene.powder = std::move(powder);
}

}  // namespace densify::dem
