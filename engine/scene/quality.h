// How exact a run is: one word that turns every accuracy setting of a scene together.
#pragma once
#include <array>
#include <string_view>

namespace sherd {

struct Scene;

enum class Quality {
  kPreview,  // minutes become seconds: where things break, not how in detail
  kDefault,  // the scene as it is written
  kFine,     // for final pieces and for judging the errors of the other two
};
inline constexpr std::array<std::string_view, 3> kQualityNames{"preview", "default",
                                                               "fine"};  // in the order of Quality

// Turns the scene's accuracy settings; what the scene describes (bodies, materials, forces, contact times) stays. Call
// once, on a scene as its file says.
void apply_quality(Quality quality, Scene& scene);

}  // namespace sherd
