// Whatever bytes a mesh file has, load_mesh() and repair_mesh() give a valid solid or a message that names the file.
#include "engine/mesh/load.h"
#include "engine/mesh/repair.h"
#include "engine/mesh/validate.h"
#include "kernels/core/error.h"
#include "tests/fuzz/fuzzed_file.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sherd;
  const std::string file = fuzzed_file(SHERD_FORMAT, data, size);
  try {
    LoadLog log;
    SurfaceMesh mesh = load_mesh(file, {}, log);
    repair_mesh(mesh, {.name = file, .max_hole_diameter = 10}, log.messages);
    require(is_valid(report_mesh(mesh)), "a repaired mesh is valid");
  } catch (const InputError& error) {
    require(std::string(error.what()).find(file) != std::string::npos, "the message names the file");
  }
  return 0;
}
