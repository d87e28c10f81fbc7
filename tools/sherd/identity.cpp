#include "tools/sherd/identity.h"

#include <fmt/format.h>

#include "kernels/core/archive.h"
#include "kernels/core/file.h"
#include "kernels/fmm/pairs.h"

namespace sherd {

std::string program_identity() {
  const char* instructions = "";
  switch (fmm::best_instructions()) {
    case fmm::Instructions::kPortable:
      instructions = "portable instructions";
      break;
    case fmm::Instructions::kAvx2:
      instructions = "AVX2";
      break;
    case fmm::Instructions::kAvx512:
      instructions = "AVX-512";
      break;
  }
  return fmt::format("sherd {} (build {:016x}, {})", SHERD_VERSION, digest(read_bytes("/proc/self/exe")), instructions);
}

std::string options_identity(const RunOptions& options) {
  std::string text;
  if (!options.render) text += "--no-render ";
  if (options.wireframe) text += "--wireframe ";
  if (options.quality) text += fmt::format("--quality {} ", kQualityNames[static_cast<std::size_t>(*options.quality)]);
  if (options.field) text += fmt::format("--field {} ", kFieldNames[static_cast<std::size_t>(*options.field)]);
  if (!options.no_skip.empty()) text += fmt::format("--no-skip {} ", fmt::join(options.no_skip, ","));
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace sherd
