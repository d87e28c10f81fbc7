// The parts of load_scene that read one [[body]].
#pragma once
#include "engine/scene/reader.h"
#include "engine/scene/scene.h"
#include "kernels/core/error.h"

namespace sherd {

// Mesh paths are relative to `folder`; `duration`: of the scene, s.
SceneBody read_body(const TomlValue& value, const std::filesystem::path& folder, Real duration, Problems& problems);
// A preset's name, or a table with `preset` and changes to it, numbers or fields.
void read_material(const TomlValue& value, const std::string& path, Problems& problems, SceneBody& body);
// A table with `kind`; `path` names it. `mean`: where none is given. `whole`: whether "share" is allowed. Every value
// of the field lies in `range`. Nothing after a problem.
std::optional<FieldSpec> read_field(const TomlValue& value, const std::string& path, const Range& range, Real mean,
                                    bool whole, Problems& problems);
// The arrays `crack` and `notch` of a body.
void read_cracks(TableReader& body, const std::filesystem::path& folder, Real duration, SceneBody& out);
// The array `load` of the root; bodies are read.
void read_loads(TableReader& root, Scene& scene);
// The key `mesh`, with the value given: an existing file, relative to `folder`.
std::filesystem::path read_mesh_path(TableReader& reader, const TomlValue& value, const std::filesystem::path& folder);
ShapeSpec read_shape(const TomlValue& value, const std::string& path, Problems& problems);
// A direction as it is given, never zero; absent: `fallback`.
Vec3 read_direction(TableReader& reader, std::string_view key, const Vec3& fallback);
// "#rrggbb" (sRGB) or [r, g, b] (linear, 0..1); result linear.
std::optional<Vec3> read_colour(TableReader& reader, std::string_view key);

// Limits of what makes sense; generous, but narrow enough to catch slips of unit (g/cm^3, GPa, mm).
inline constexpr Range kLength{1e-6, 1e4, "m"};
inline constexpr Range kCoordinate{-1e6, 1e6, "m"};
inline constexpr Range kSpeed{-1e4, 1e4, "m/s"};

}  // namespace sherd
