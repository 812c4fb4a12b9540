// Any bytes as a LAMMPS data file.

#include "dem/io/particle_import.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  densify::fuzz::must_read_or_refuse([&] {
    const auto particles = densify::dem::read_lammps_data(densify::fuzz::file_with(bytes), 1e-6);
    densify::dem::reject_overlaps(particles, particles.box.value_or(densify::dem::Cell{}), 0.05);
  });
  return 0;
}
