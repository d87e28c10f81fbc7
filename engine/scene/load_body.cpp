#include "engine/scene/load_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sherd {
namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;
// An edge below this part of the body's size would ask for tens of millions of triangles.
constexpr Real kFinestEdge = 1e-3;

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string read_name(TableReader& reader) {
  constexpr std::string_view kAllowed = "names: 1 to 64 of letters, digits, '_' and '-'";
  const TomlValue* value = reader.require("name", kAllowed);
  if (!value) return {};
  if (value->kind == TomlValue::Kind::kText && is_name(value->text)) return value->text;
  reader.problems().refuse(*value, reader.path("name"), kAllowed);
  return {};
}

// Unit quaternion (w, v) to the vector along its axis as long as its angle, the shorter way round.
Vec3 rotation_vector(Real w, Vec3 v) {
  if (w < 0) w = -w, v = -v;
  const Real s = norm(v);
  return s > 0 ? v * (2 * std::atan2(s, w) / s) : Vec3{};
}

// Intrinsic turns about x, then y, then z (degrees), the same as the matrix Rx Ry Rz.
Vec3 from_euler(const Vec3& degrees) {
  struct Quaternion {
    Real w;
    Vec3 v;
  };
  const auto product = [](const Quaternion& a, const Quaternion& b) {
    return Quaternion{a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
  };
  const auto turn = [](const Vec3& axis, Real angle) {
    const Real half = 0.5 * angle * kPi / 180;
    return Quaternion{std::cos(half), std::sin(half) * axis};
  };
  const Quaternion q =
      product(product(turn({1, 0, 0}, degrees.x), turn({0, 1, 0}, degrees.y)), turn({0, 0, 1}, degrees.z));
  return rotation_vector(q.w, q.v);
}

Vec3 read_quaternion(const TomlValue& value, const std::string& path, Problems& problems) {
  const Range range{-1, 1};
  bool good = value.kind == TomlValue::Kind::kArray && value.items.size() == 4;
  std::array<Real, 4> q{};
  for (std::size_t i = 0; good && i < 4; ++i)
    if (const TomlValue& item = value.items[i];
        item.kind == TomlValue::Kind::kReal || item.kind == TomlValue::Kind::kInteger)
      q[i] = item.real, good = range.contains(q[i]);
    else
      good = false;
  const Vec3 v{q[1], q[2], q[3]};
  const Real length = std::sqrt(q[0] * q[0] + norm2(v));
  // Written by hand with three or more digits, a unit quaternion is this near to length 1.
  if (good && std::abs(length - 1) < 0.01) return rotation_vector(q[0] / length, v / length);
  problems.refuse(value, path, "type: four numbers [w, x, y, z] of length 1");
  return {};
}

Vec3 read_axis_angle(TableReader& reader) {
  const Range degrees{-36000, 36000, "degrees"};
  const TomlValue* axis_value = reader.find("axis");
  const Vec3 axis = reader.vector("axis", {-1e6, 1e6}, {0, 1, 0});
  if (axis_value && !(norm(axis) > 0))
    reader.problems().refuse(*axis_value, reader.path("axis"), "range: a direction, not zero");
  if (!reader.require("angle", fmt::format("range {}", degrees.text()))) return {};
  return normalized(axis) * (reader.number("angle", degrees, 0) * kPi / 180);
}

Vec3 read_rotation(TableReader& body) {
  const TomlValue* value = body.table("rotation");
  if (!value) return {};
  TableReader reader(*value, body.path("rotation"), body.problems());
  const TomlValue* axis = reader.find("axis");
  const TomlValue* euler = reader.find("euler");
  const TomlValue* quaternion = reader.find("quaternion");
  Vec3 rotation;
  if ((axis != nullptr) + (euler != nullptr) + (quaternion != nullptr) != 1)
    body.problems().refuse(*value, body.path("rotation"), "forms: axis with angle, euler, or quaternion");
  else if (axis)
    rotation = read_axis_angle(reader);
  else if (euler)
    rotation = from_euler(reader.vector("euler", {-36000, 36000, "degrees"}, {}));
  else
    rotation = read_quaternion(*quaternion, reader.path("quaternion"), body.problems());
  reader.find("angle");
  reader.finish();
  return rotation;
}

MeshSpec read_mesh(TableReader& body, const TomlValue& value, const std::filesystem::path& folder) {
  MeshSpec mesh;
  mesh.file = read_mesh_path(body, value, folder);
  int fits = 0;
  const auto fit = [&](std::string_view key, MeshFit kind, const Range& range) {
    const TomlValue* given = body.find(key);
    if (!given) return;
    if (++fits > 1) body.problems().refuse(*given, body.path(key), "count: one of scale, fit_height and fit_size");
    mesh.fit = kind;
    mesh.amount = body.number(key, range, 1);
  };
  fit("scale", MeshFit::kScale, {1e-9, 1e9});
  fit("fit_height", MeshFit::kHeight, kLength);
  fit("fit_size", MeshFit::kSize, kLength);
  constexpr std::array<std::string_view, 2> kUp{"y", "z"};
  mesh.up = body.choice("up", kUp, 0) == 0 ? UpAxis::kY : UpAxis::kZ;
  mesh.max_hole = body.number("max_hole", {0, 1e4, "m"}, 0);
  return mesh;
}

}  // namespace

Vec3 read_direction(TableReader& reader, std::string_view key, const Vec3& fallback) {
  const TomlValue* given = reader.find(key);
  if (!given) return fallback;
  const Vec3 v = reader.vector(key, {-1e6, 1e6}, {0, 1, 0});
  if (norm2(v) > 0) return v;
  reader.problems().refuse(*given, reader.path(key), "range: a direction, not zero");
  return {0, 1, 0};
}

std::filesystem::path read_mesh_path(TableReader& body, const TomlValue& value, const std::filesystem::path& folder) {
  const std::string path = body.path("mesh");
  if (value.kind != TomlValue::Kind::kText || value.text.empty()) {
    body.problems().refuse(value, path, "type: the path of a mesh file, in quotes");
    return {};
  }
  const std::filesystem::path file = (folder / value.text).lexically_normal();
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    body.problems().refuse(value, path, fmt::format("files: one that exists ({} does not)", file.string()));
  else if (std::filesystem::is_directory(file, error))
    body.problems().refuse(value, path, fmt::format("files: a mesh file ({} is a folder)", file.string()));
  return file;
}

std::optional<Vec3> read_colour(TableReader& reader, std::string_view key) {
  const TomlValue* value = reader.find(key);
  if (!value) return std::nullopt;
  if (value->kind == TomlValue::Kind::kArray) return to_vector(*value, reader.path(key), {0, 1}, reader.problems());
  const std::string& text = value->text;
  const bool hex = value->kind == TomlValue::Kind::kText && text.size() == 7 && text[0] == '#' &&
                   text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!hex) {
    reader.problems().refuse(*value, reader.path(key), "forms: \"#rrggbb\" or [r, g, b] from 0 to 1");
    return std::nullopt;
  }
  Vec3 colour;
  for (int i = 0; i < 3; ++i) {
    const Real c = std::stoi(text.substr(1 + 2 * static_cast<std::size_t>(i), 2), nullptr, 16) / 255.0;
    colour[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);  // IEC 61966-2-1
  }
  return colour;
}

SceneBody read_body(const TomlValue& value, const std::filesystem::path& folder, Real duration, Problems& problems) {
  TableReader reader(value, "body", problems);
  SceneBody body;
  body.name = read_name(reader);
  const TomlValue* mesh = reader.find("mesh");
  const TomlValue* shape = reader.find("shape");
  if ((mesh != nullptr) == (shape != nullptr))
    problems.add(value.line, value.column, "body: needs one of mesh (a file) and shape (a generated solid)");
  Real size = 0;  // metres, where known before loading
  if (mesh) {
    const MeshSpec spec = read_mesh(reader, *mesh, folder);
    if (spec.fit != MeshFit::kScale) size = spec.amount;
    body.source = spec;
  } else if (shape) {
    const ShapeSpec spec = read_shape(*shape, reader.path("shape"), problems);
    size = shape_diagonal(spec);
    body.source = spec;
  }
  Range edge = kLength;
  if (size > 0) edge.low = kFinestEdge * size, edge.high = size;
  body.edge_length = reader.number("edge_length", edge, 0);
  body.edge_per_thickness = reader.number("edge_per_thickness", {0, 20}, 0);
  body.merge_features = reader.number("merge_features", {0, 0.5}, body.merge_features);
  constexpr std::array<std::string_view, 2> kAnchors{"centre", "base"};
  body.anchor = reader.choice("anchor", kAnchors, 0) == 0 ? Anchor::kCentreOfMass : Anchor::kBase;
  body.position = reader.vector("position", kCoordinate, {});
  body.rotation = read_rotation(reader);
  body.velocity = reader.vector("velocity", kSpeed, {});
  body.angular_velocity = reader.vector("angular_velocity", {-1e5, 1e5, "rad/s"}, {});
  const TomlValue* material = reader.find("material");
  body.material = *find_material("ceramic");
  if (material) read_material(*material, reader.path("material"), problems, body);
  body.fixed = reader.flag("fixed", false);
  body.breakable = reader.flag("breakable", !body.fixed);
  for (const auto& [key, speed] : {std::pair{"velocity", body.velocity}, {"angular_velocity", body.angular_velocity}})
    if (body.fixed && norm2(speed) > 0)
      problems.refuse(*reader.find(key), reader.path(key), "values: [0, 0, 0], since the body is fixed");
  if (body.fixed && body.breakable)
    problems.refuse(*reader.find("breakable"), reader.path("breakable"), "values: false, since the body is fixed");
  read_cracks(reader, folder, duration, body);
  body.colour = read_colour(reader, "colour");
  body.crack_colour = read_colour(reader, "crack_colour");
  reader.finish();
  return body;
}

}  // namespace sherd
