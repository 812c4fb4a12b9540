// Any text as a scene: read, or refused with a message.

#include "dem/io/scene.h"

#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  densify::fuzz::must_read_or_refuse([&] {
    const densify::dem::Scene scene = densify::dem::read_scene_text(text, {});
    // What a scene says of itself must be readable and say the same.
    if (densify::dem::read_scene_text(scene.effective_text, {}).effective_text != scene.effective_text) std::abort();
  });
  return 0;
}
