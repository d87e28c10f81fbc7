// The parts of load_scene that read one [[body]].
#pragma once
#include "engine/scene/reader.h"
#include "engine/scene/scene.h"
#include "kernels/core/error.h"

namespace sherd {

// Mesh paths are looked for in `folder` first.
SceneBody read_body(const TomlValue& value, const std::filesystem::path& folder, Problems& problems);
// A preset's name, or a table with `preset` and changes to it.
Material read_material(const TomlValue& value, const std::string& path, Problems& problems);
ShapeSpec read_shape(const TomlValue& value, const std::string& path, Problems& problems);
// "#rrggbb" (sRGB) or [r, g, b] (linear, 0..1); result linear.
std::optional<Vec3> read_colour(TableReader& reader, std::string_view key);

// Limits of what makes sense; generous, but narrow enough to catch slips of unit (g/cm^3, GPa, mm).
inline constexpr Range kLength{1e-6, 1e4, "m"};
inline constexpr Range kCoordinate{-1e6, 1e6, "m"};
inline constexpr Range kSpeed{-1e4, 1e4, "m/s"};

}  // namespace sherd
