#include <algorithm>
#include <array>
#include <cmath>

#include "engine/scene/load_body.h"
#include "kernels/core/archive.h"
#include "kernels/core/error.h"
#include "kernels/core/file.h"

namespace sherd {
namespace {

// One optional table of the root: `read` gets its reader, unknown keys are found afterwards.
template <class F>
void section(TableReader& root, std::string_view key, const F& read) {
  const TomlValue* value = root.table(key);
  if (!value) return;
  TableReader reader(*value, root.path(key), root.problems());
  read(reader);
  reader.finish();
}

// "hertz" or a number.
std::optional<Real> read_hertz_or(TableReader& reader, std::string_view key, const Range& range) {
  const TomlValue* value = reader.find(key);
  if (!value || (value->kind == TomlValue::Kind::kText && value->text == "hertz")) return std::nullopt;
  if (value->kind != TomlValue::Kind::kText) return reader.number(key, range, 0);
  reader.problems().refuse(*value, reader.path(key),
                           fmt::format("values: \"hertz\" or a number, range {}", range.text()));
  return std::nullopt;
}

void read_time(TableReader& root, Scene& scene) {
  scene.gravity = root.vector("gravity", {-1000, 1000, "m/s^2"}, scene.gravity);
  scene.time_step = root.number("time_step", {1e-6, 0.1, "s"}, scene.time_step);
  scene.duration = root.number("duration", {scene.time_step, 3600, "s"}, std::max(scene.duration, scene.time_step));
  const Real most = 1 / scene.time_step;
  scene.frame_rate =
      root.number("frame_rate", {1e-3, most, "frames/s, at most one a step"}, std::min(scene.frame_rate, most));
}

void read_bodies(TableReader& root, Scene& scene) {
  Problems& problems = root.problems();
  const TomlValue* list = root.find("body");
  if (!list) {
    problems.add(1, 1, "body: missing; a scene needs at least one [[body]]");
    return;
  }
  const auto is_table = [](const TomlValue& v) { return v.kind == TomlValue::Kind::kTable; };
  if (list->kind != TomlValue::Kind::kArray || list->items.empty() ||
      !std::all_of(list->items.begin(), list->items.end(), is_table)) {
    problems.refuse(*list, "body", "type: one or more tables, each begun by [[body]]");
    return;
  }
  for (const TomlValue& item : list->items) {
    scene.bodies.push_back(read_body(item, scene.file.parent_path(), scene.duration, problems));
    const std::string& name = scene.bodies.back().name;
    const auto same = [&](const SceneBody& b) { return b.name == name; };
    if (name.empty() || std::find_if(scene.bodies.begin(), scene.bodies.end(), same) == scene.bodies.end() - 1)
      continue;
    for (const TomlEntry& entry : item.entries)
      if (entry.key == "name") problems.refuse(entry.value, "body.name", "names: one that no other body has");
  }
}

void read_world(TableReader& root, Scene& scene) {
  section(root, "ground", [&](TableReader& r) {
    SceneGround& g = scene.ground;
    g.enabled = r.flag("enabled", g.enabled);
    g.height = r.number("height", kCoordinate, g.height);
    g.restitution = r.number("restitution", {0, 1}, g.restitution);
    g.friction = r.number("friction", {0, 10}, g.friction);
  });
  scene.contact.min_duration = scene.time_step;
  section(root, "contact", [&](TableReader& r) {
    SceneContact& c = scene.contact;
    const Range seconds{1e-9, 1, "s"};
    c.duration = read_hertz_or(r, "duration", seconds);
    c.min_duration = r.number("min_duration", {0, 1, "s"}, c.min_duration);
    c.patch_radius = read_hertz_or(r, "patch_radius", kLength);
    c.min_patch_radius = r.number("min_patch_radius", {0, kLength.high, "m"}, c.min_patch_radius);
  });
  section(root, "solver", [&](TableReader& r) {
    scene.solver.tolerance = r.number("tolerance", {1e-14, 0.1}, scene.solver.tolerance);
    scene.solver.max_iterations = r.integer("max_iterations", 1, 100000, scene.solver.max_iterations);
    constexpr std::array<std::string_view, 3> kThinWalls{"auto", "off", "all"};  // in the order of ThinWalls
    scene.solver.thin_walls = static_cast<ThinWalls>(r.choice("thin_walls", kThinWalls, 0));
  });
  section(root, "fracture", [&](TableReader& r) {
    SceneFracture& f = scene.fracture;
    f.enabled = r.flag("enabled", f.enabled);
    f.max_cracks = r.integer("max_cracks", 1, 1000, f.max_cracks);
    f.max_fragments = r.integer("max_fragments", 1, 100000, f.max_fragments);
    f.min_fragment_volume = r.number("min_fragment_volume", {0, 0.5}, f.min_fragment_volume);
    f.max_generation = r.integer("max_generation", 0, 1000, f.max_generation);
    f.net_section = r.flag("net_section", f.net_section);
    f.rounds = r.integer("rounds", 1, 8, f.rounds);
    f.interior_seeds = r.flag("interior_seeds", f.interior_seeds);
    constexpr std::array<std::string_view, 2> kDust{"drop", "keep"};  // in the order of SceneDust
    f.dust = static_cast<SceneDust>(r.choice("dust", kDust, 0));
    f.speed = r.number("speed", {0.05, 1}, f.speed);
  });
  section(root, "skip", [&](TableReader& r) {
    for (const SkipSwitch& s : kSkipSwitches) scene.skip.set(s.skip, r.flag(s.key, scene.skip[s.skip]));
  });
}

// By name, since indices would silently mean another body after an edit.
void read_material_view(TableReader& reader, Scene& scene) {
  const TomlValue* value = reader.find("material_view");
  if (!value) return;
  std::vector<std::string_view> names;
  for (const SceneBody& body : scene.bodies) names.push_back(body.name);
  const std::size_t index = reader.choice("material_view", names, names.size());
  if (index < names.size()) scene.output.material_view = index;
}

void read_field(TableReader& reader, SceneOutput& output) {
  const TomlValue* given = reader.find("field");
  SceneField field;
  const std::size_t kind = reader.choice("field", kFieldNames, kFieldNames.size());
  const TomlValue* range = reader.find("field_range");
  if (const auto ends = reader.numbers("field_range", {-1e15, 1e15}, 2); range && ends) {
    if (ends->size() != 2 || !((*ends)[0] < (*ends)[1]))
      reader.problems().refuse(*range, reader.path("field_range"), "form: [low, high], low below high");
    else
      field.range = {(*ends)[0], (*ends)[1]};
  }
  field.deformation = reader.number("deformation", {0, 1e12}, 0);
  for (const char* key : {"field_range", "deformation"})
    if (const TomlValue* value = reader.find(key); value && !given)
      reader.problems().refuse(*value, reader.path(key), "use: together with output.field");
  if (kind == kFieldNames.size()) return;
  field.kind = static_cast<FieldKind>(kind);
  output.field = field;
}

void read_output(TableReader& root, Scene& scene) {
  section(root, "output", [&](TableReader& r) {
    SceneOutput& o = scene.output;
    o.width = r.integer("width", 16, 8192, o.width);
    o.height = r.integer("height", 16, 8192, o.height);
    const TomlValue* samples = r.find("samples");
    o.samples = r.integer("samples", 1, 8, o.samples);
    if (samples && (o.samples & (o.samples - 1)) != 0)
      r.problems().refuse(*samples, r.path("samples"), "values: 1, 2, 4, 8");
    o.frames = r.flag("frames", o.frames);
    o.movie = r.flag("movie", o.frames);
    if (o.movie && !o.frames)
      r.problems().refuse(*r.find("movie"), r.path("movie"), "values: false, since output.frames is false");
    o.pieces = r.flag("pieces", o.pieces);
    read_material_view(r, scene);
    read_field(r, o);
  });
}

void read_view(TableReader& root, Scene& scene) {
  section(root, "camera", [&](TableReader& r) {
    SceneCamera& c = scene.camera;
    const TomlValue* eye = r.find("eye");
    c.automatic = eye == nullptr;
    c.eye = r.vector("eye", kCoordinate, c.eye);
    const TomlValue* target = r.find("target");
    c.target = r.vector("target", kCoordinate, c.target);
    if (target && !eye) r.problems().refuse(*target, r.path("target"), "use: together with camera.eye");
    c.up = read_direction(r, "up", c.up);
    c.field_of_view = r.number("field_of_view", {1, 150, "degrees"}, c.field_of_view);
    if (eye && !(norm2(cross(c.target - c.eye, c.up)) > 0))
      r.problems().refuse(*eye, r.path("eye"), "range: a point off the line through the target along up");
  });
  section(root, "light",
          [&](TableReader& r) { scene.light.direction = read_direction(r, "direction", scene.light.direction); });
}

std::uint64_t digest_of(const TomlValue& root, const Scene& scene) {
  std::uint64_t sum = digest(full_text(root));
  const auto add_file = [&](const std::filesystem::path& file) { sum = digest(read_bytes(file), sum); };
  for (const SceneBody& body : scene.bodies) {
    if (const auto* mesh = std::get_if<MeshSpec>(&body.source)) add_file(mesh->file);
    for (const SceneCrack& crack : body.cracks)
      if (const auto* file = std::get_if<std::filesystem::path>(&crack.guide)) add_file(*file);
  }
  return sum;
}

}  // namespace

Scene load_scene(const std::filesystem::path& file, std::optional<Quality> quality) {
  const TomlValue root_table = parse_toml_file(file);
  Problems problems(file.string());
  TableReader root(root_table, "", problems);
  Scene scene;
  scene.file = file;
  read_time(root, scene);
  const auto own = static_cast<Quality>(root.choice("quality", kQualityNames, 1));
  read_bodies(root, scene);
  read_loads(root, scene);
  read_world(root, scene);
  read_view(root, scene);
  read_output(root, scene);
  root.finish();
  problems.raise();
  scene.digest = digest_of(root_table, scene);
  apply_quality(quality.value_or(own), scene);
  return scene;
}

}  // namespace sherd
