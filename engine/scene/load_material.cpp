#include <array>
#include <cmath>
#include <numeric>

#include "engine/scene/load_body.h"

namespace sherd {
namespace {

// Where each number of a material goes and what it may be.
struct MaterialKey {
  std::string_view key;
  Real Material::*member;
  Range range;
  std::optional<FieldSpec> SceneBody::*field = nullptr;  // for those that may vary from place to place
};
constexpr std::array<MaterialKey, 8> kMaterialKeys{{
    {"density", &Material::density, {10, 30000, "kg/m^3"}},
    {"young", &Material::young, {1e5, 2e12, "Pa"}},
    {"poisson", &Material::poisson, {-1, 0.5, "", true, true}},
    {"strength", &Material::strength, {1e2, 1e12, "Pa"}, &SceneBody::strength},
    {"propagation_strength", &Material::propagation_strength, {1, 1e12, "Pa"}, &SceneBody::propagation_strength},
    {"crack_thickness", &Material::crack_thickness, {0, 1, "m"}, &SceneBody::crack_thickness},
    {"restitution", &Material::restitution, {0, 1}},
    {"friction", &Material::friction, {0, 10}},
}};
constexpr Real kThinnestCrack = 1e-9;  // m; where a field gives the thickness, 0 cannot ask for a default

Material read_preset(const TomlValue& value, const std::string& path, Problems& problems) {
  if (value.kind == TomlValue::Kind::kText)
    if (const std::optional<Material> found = find_material(value.text)) return *found;
  std::vector<std::string_view> names;
  for (const MaterialPreset& preset : material_presets()) names.push_back(preset.material.name);
  problems.refuse(value, path, fmt::format("values: {}", word_list(names)));
  return {};
}

// The number that stands for a field where one number must do.
Real mean_of(const FieldSpec& spec, Real whole) {
  if (const auto* noise = std::get_if<NoiseSpec>(&spec)) return noise->mean;
  if (const auto* grains = std::get_if<GrainSpec>(&spec)) return grains->mean;
  if (const auto* layers = std::get_if<LayerSpec>(&spec))
    return std::accumulate(layers->values.begin(), layers->values.end(), 0.0) /
           static_cast<Real>(layers->values.size());
  if (const auto* attribute = std::get_if<AttributeSpec>(&spec)) return 0.5 * (attribute->low + attribute->high);
  if (const auto* share = std::get_if<ShareSpec>(&spec)) return share->factor * whole;
  return std::get<ConstantSpec>(spec).value;
}

// Returns whether the key is absent or good.
bool read_key(TableReader& reader, const MaterialKey& key, SceneBody& body) {
  const TomlValue* given = reader.find(key.key);
  if (!given) return true;
  Real& number = body.material.*key.member;
  if (given->kind != TomlValue::Kind::kTable || !key.field) {
    number = reader.number(key.key, key.range, number);
    return given->kind != TomlValue::Kind::kTable && key.range.contains(given->real);
  }
  Range range = key.range;
  range.low = std::max(range.low, kThinnestCrack);
  const bool whole = key.field == &SceneBody::propagation_strength;
  std::optional<FieldSpec>& field = body.*key.field;
  field = read_field(*given, reader.path(key.key), range, number, whole, reader.problems());
  if (field) number = mean_of(*field, body.material.strength);
  return field.has_value();
}

// A strength that varies takes the propagation strength with it, where the scene says nothing else.
void complete_propagation(TableReader& reader, SceneBody& body) {
  if (!body.strength || reader.find("propagation_strength")) return;
  body.propagation_strength = ShareSpec{std::min(body.material.propagation_strength / body.material.strength, 1.0)};
}

// Numbers are compared; of fields the bounds, the rest is met at each point (scene_fields()).
void check_strengths(TableReader& reader, const SceneBody& body) {
  const Material& m = body.material;
  const TomlValue* given = reader.find("propagation_strength");
  if (!body.strength && !body.propagation_strength) {
    if (m.propagation_strength > m.strength)
      reader.problems().refuse(
          given ? *given : *reader.find("strength"), reader.path(given ? "propagation_strength" : "strength"),
          given ? fmt::format("range 1 to {:g} Pa, the strength", m.strength)
                : fmt::format("range {:g} to 1e+12 Pa, from the propagation_strength", m.propagation_strength));
    return;
  }
  const FieldBounds s = bounds_of(body.strength.value_or(ConstantSpec{m.strength}), {});
  const FieldBounds p = bounds_of(body.propagation_strength.value_or(ConstantSpec{m.propagation_strength}), s);
  if (given && (p.lower > s.lower || p.upper > s.upper))
    reader.problems().refuse(*given, reader.path("propagation_strength"),
                             fmt::format("range at most the strength: it spans {:g} to {:g} Pa, the strength {:g} to "
                                         "{:g} Pa; lower it, or use {{kind = \"share\", factor = 0.1}}",
                                         p.lower, p.upper, s.lower, s.upper));
  else if (!given && p.lower > s.lower)
    reader.problems().refuse(*reader.find("strength"), reader.path("strength"),
                             fmt::format("range {:g} to 1e+12 Pa, from the propagation_strength", p.lower));
}

}  // namespace

void read_material(const TomlValue& value, const std::string& path, Problems& problems, SceneBody& body) {
  if (value.kind == TomlValue::Kind::kText) {
    body.material = read_preset(value, path, problems);
    return;
  }
  if (value.kind != TomlValue::Kind::kTable) {
    problems.refuse(value, path, "type: a preset's name or a table");
    return;
  }
  TableReader reader(value, path, problems);
  const TomlValue* preset = reader.find("preset");
  body.material = preset ? read_preset(*preset, reader.path("preset"), problems) : Material{};
  body.material.name = reader.text("name", body.material.name);
  bool good = true;
  for (const MaterialKey& key : kMaterialKeys) good = read_key(reader, key, body) && good;
  complete_propagation(reader, body);
  if (good) check_strengths(reader, body);
  reader.finish();
}

}  // namespace sherd
