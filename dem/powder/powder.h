#pragma once
// A powder of one or several materials, each with its own sizes and share.

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "dem/powder/size_distribution.h"

namespace densify::dem {

struct ParticleCount {
  std::size_t value;  ///< [-]
};
struct SolidVolume {
  double value;  ///< [m^3]
};
/// Share of the solid volume of the whole powder.
struct VolumeFraction {
  double value;  ///< above 0, up to 1 [-]
};

/// One material of a powder; with a VolumeFraction the rest of the powder, or its total, sets the number.
struct PowderComponent {
  std::uint8_t material;  ///< index into the scene's materials
  SizeDistribution sizes;
  std::variant<ParticleCount, SolidVolume, VolumeFraction> amount;
};

/// With a total all components have volume fractions that sum to one.
struct Powder {
  std::vector<PowderComponent> components;
  std::optional<std::variant<ParticleCount, SolidVolume>> total;
  std::uint64_t seed;
};

/// Particles without places, all materials mixed.
struct PowderSample {
  std::vector<double> diameter;        ///< [m]
  std::vector<std::uint8_t> material;  ///< index into the scene's materials
};

/// @throws InputError  when the powder is empty, or its amounts contradict or do not determine each other
PowderSample draw(const Powder& powder);

/// The diameters of one material [m].
std::vector<double> diameters_of(const PowderSample& sample, std::uint8_t material);

}  // namespace densify::dem
