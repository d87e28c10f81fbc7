// Whatever bytes a scene file has, it is read or refused with a message that names the file.
#include <cmath>

#include "engine/scene/scene.h"
#include "kernels/core/error.h"
#include "tests/fuzz/fuzzed_file.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sherd;
  const std::string file = fuzzed_file("toml", data, size);
  try {
    const Scene scene = load_scene(file);
    require(scene.time_step > 0 && std::isfinite(scene.time_step), "the time step is a positive number");
    const SurfaceMesh none;
    for (const SceneBody& body : scene.bodies) {
      const MaterialFields fields = scene_fields(body, none);
      require(fields.propagation_strength->lower() > 0, "strengths are positive");
      require(fields.propagation_strength->at({}) <= fields.strength->at({}), "cracks go on at most at the strength");
    }
  } catch (const InputError& error) {
    require(std::string(error.what()).find(file) != std::string::npos, "the message names the file");
  }
  return 0;
}
