// Checkpoints that were tampered with.  Changed bytes: the checksum must refuse them.  Changed values in a file whose
// checksum is right (a checkpoint of something else, or an ill-willed one): refused, or a state that can be stepped and
// measured until a guard stops it.

#include "dem/io/checkpoint.h"

#include <fuzzer/FuzzedDataProvider.h>

#include <cstring>

#include "dem/io/state_image.h"
#include "dem/measure/measures.h"
#include "tests/dem/small_packings.h"
#include "tests/fuzz/input_file.h"

namespace {

using namespace densify::dem;

enum class Kind : std::uint8_t { table, real, byte, word, count };

/// Everything that state_image.cc writes.
constexpr std::pair<const char*, Kind> datasets[] = {{"/particles/body", Kind::table},
                                                     {"/particles/reference_radius", Kind::real},
                                                     {"/particles/material", Kind::byte},
                                                     {"/particles/id", Kind::word},
                                                     {"/particles/force", Kind::table},
                                                     {"/particles/angular_velocity", Kind::table},
                                                     {"/particles/torque", Kind::table},
                                                     {"/contacts/first", Kind::word},
                                                     {"/contacts/second", Kind::word},
                                                     {"/contacts/buckets", Kind::count},
                                                     {"/contacts/tangential", Kind::table},
                                                     {"/contacts/neck_radius", Kind::real},
                                                     {"/contacts/neck_elastic", Kind::real},
                                                     {"/contacts/neck_since", Kind::real},
                                                     {"/contacts/neck_phase", Kind::byte},
                                                     {"/contacts/reference_position", Kind::table},
                                                     {"/contacts/reference_h", Kind::real},
                                                     {"/contacts/reference_expansion", Kind::real},
                                                     {"/walls/contact_particle", Kind::word},
                                                     {"/walls/contact_wall", Kind::byte},
                                                     {"/walls/contact_tangential", Kind::table},
                                                     {"/state/punch", Kind::real},
                                                     {"/state/cell_periodic", Kind::byte},
                                                     {"/state/cell_h", Kind::real},
                                                     {"/state/cell_origin", Kind::real},
                                                     {"/state/cell_velocity_gradient", Kind::real},
                                                     {"/state/expansion", Kind::real},
                                                     {"/state/active_since", Kind::real},
                                                     {"/state/clock", Kind::real}};
constexpr std::size_t dataset_count = std::size(datasets);

/// A simulation after some steps, its checkpoint and the image in it.
struct Original {
  explicit Original(const Setup& given) : setup(given), simulation(setup) {
    testing::run_steps(simulation, 60);
    const auto path = densify::fuzz::file_with("");
    write_checkpoint(path, simulation, {}, {"scene", "version"});
    bytes = densify::dem::read_whole_file(path);
    image = bytes.substr(512);
  }
  Setup setup;
  Simulation simulation;
  std::string bytes, image;
};

/// One of the values that break things, or any.
template <class T>
T odd_value(FuzzedDataProvider& input) {
  constexpr double odd[] = {0, -1, 1, 1e-320, 1e300, -1e300, 1e19, 3e9};
  const auto which = input.ConsumeIntegralInRange<std::size_t>(0, std::size(odd) + 2);
  if (which < std::size(odd)) {
    if constexpr (std::is_floating_point_v<T>) return T(odd[which]);
    return T(std::int64_t(odd[which] > 1e18 || odd[which] < -1e18 ? 0 : odd[which]));
  }
  if constexpr (std::is_floating_point_v<T>) {
    if (which == std::size(odd)) return std::numeric_limits<T>::quiet_NaN();
    if (which == std::size(odd) + 1) return std::numeric_limits<T>::infinity();
  }
  T value{};
  const auto raw = input.ConsumeBytes<std::uint8_t>(sizeof value);
  if (!raw.empty()) std::memcpy(&value, raw.data(), raw.size());
  return value;
}

template <class T>
void edit(FuzzedDataProvider& input, std::vector<T>& values, bool whole_rows) {
  switch (input.ConsumeIntegralInRange(0, 3)) {
    case 0:
      if (!whole_rows) values.resize(input.ConsumeIntegralInRange<std::size_t>(0, values.size() + 3));
      break;
    case 1:
      if (values.size() > 1)
        std::swap(values[input.ConsumeIntegralInRange<std::size_t>(0, values.size() - 1)],
                  values[input.ConsumeIntegralInRange<std::size_t>(0, values.size() - 1)]);
      break;
    default:
      if (!values.empty()) {
        const auto place = input.ConsumeIntegralInRange<std::size_t>(0, values.size() - 1);
        values[place] = odd_value<T>(input);
      }
  }
}

void copy_attributes(const Hdf5Reader& from, Hdf5Writer& to, FuzzedDataProvider& input) {
  for (const char* name : {"skin", "largest_radius"})
    to.attribute("/contacts", name,
                 input.ConsumeProbability<double>() < 0.05 ? odd_value<double>(input)
                                                           : from.attribute<double>("/contacts", name));
  to.attribute("/contacts", "builds", from.attribute<std::uint64_t>("/contacts", "builds"));
  to.attribute("/state", "steps", from.attribute<std::uint64_t>("/state", "steps"));
}

/// The original's image with up to four datasets edited.
std::string edited_image(const Original& original, FuzzedDataProvider& input) {
  const Hdf5Reader from("original", original.image);
  std::uint32_t chosen = 0;
  for (int n = input.ConsumeIntegralInRange(0, 4); n > 0; --n)
    chosen |= 1u << input.ConsumeIntegralInRange<std::size_t>(0, dataset_count - 1);
  Hdf5Writer to("edited");
  for (std::size_t d = 0; d < dataset_count; ++d) {
    const char* const name = datasets[d].first;
    const Kind kind = datasets[d].second;
    const Hdf5Shape shape = from.shape(name);
    auto take = [&](auto values) {
      if (chosen >> d & 1) edit(input, values, kind == Kind::table);
      if constexpr (std::is_same_v<decltype(values), std::vector<double>>) {
        if (kind == Kind::table) return to.table(name, values, shape.columns, "");
      }
      to.list(name, values, "");
    };
    if (kind == Kind::byte)
      take(from.read<std::uint8_t>(name));
    else if (kind == Kind::word)
      take(from.read<std::uint32_t>(name));
    else if (kind == Kind::count)
      take(from.read<std::uint64_t>(name));
    else
      take(from.read<double>(name));
  }
  for (const char* walls : {"/walls/now", "/walls/reference"}) to.copy(from, walls, walls);
  copy_attributes(from, to, input);
  return to.image();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Original originals[] = {Original(testing::cylinder_packing(1)), Original(testing::periodic_packing(1))};
  FuzzedDataProvider input(data, size);
  const Original& original = originals[input.ConsumeBool()];
  if (input.ConsumeBool()) {  // changed bytes
    std::string bytes = original.bytes;
    for (int n = input.ConsumeIntegralInRange(0, 3); n > 0 && !bytes.empty(); --n)
      bytes[input.ConsumeIntegralInRange<std::size_t>(0, bytes.size() - 1)] ^= input.ConsumeIntegral<char>();
    if (input.ConsumeBool()) bytes.resize(input.ConsumeIntegralInRange<std::size_t>(0, bytes.size()));
    Simulation simulation(original.setup);
    bool accepted = false;
    densify::fuzz::must_read_or_refuse([&] {
      read_checkpoint(densify::fuzz::file_with(bytes), simulation, {"scene", "version"});
      accepted = true;
    });
    if (accepted != (bytes == original.bytes)) std::abort();
    return 0;
  }
  densify::fuzz::must_read_or_refuse([&] {
    Simulation simulation(original.setup);
    const std::string image = edited_image(original, input);
    simulation.restore(read_state(Hdf5Reader("edited", image), simulation));
    Recording recording;
    for (int n = 0; n < 3; ++n) {
      simulation.evaluate(&recording);
      simulation.require_sound();
      measure(simulation, recording);
      simulation.move();
    }
  });
  return 0;
}
